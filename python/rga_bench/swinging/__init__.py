"""A generator of blind cases with measured modes: structures that swing.

Reality is that of the second generator (`rga_bench.field`) with mass of its own: a frame with
gussets and scatter where the model is a truss, dense in plain NumPy.
"""

from rga_bench.swinging.campaign import Campaign
from rga_bench.swinging.case import ModalCase, draw_modal, fits
from rga_bench.swinging.hidden import OF_GAUGES, OF_MODES

__all__ = ["OF_GAUGES", "OF_MODES", "Campaign", "ModalCase", "draw_modal", "fits"]
