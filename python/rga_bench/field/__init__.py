"""A second generator of blind cases, which shares neither families nor spreads with the analyser.

Structures that are no bridge of two trusses, as an engineer models them; reality is a welded
frame with gussets, gauges at the faces of sections, and a logger with the errors of makers' data.
Plain NumPy and SciPy; what solves it shares no code with the simulator.
"""

from rga_bench.field.case import draw_field, fits
from rga_bench.field.healthy_case import Options
from rga_bench.field.hidden import INSIDE, KINDS, OUTSIDE
from rga_bench.field.structures import STRUCTURES

__all__ = ["INSIDE", "KINDS", "OUTSIDE", "STRUCTURES", "Options", "draw_field", "fits"]
