"""Independent physics that makes blind cases: what is hidden in them is known.

Nothing here imports the simulator, the model or the core that the cases are to test; plain
NumPy (its threads held to one by threadpoolctl) and the standard library only.
"""

from rga_bench.synthetic.bridges.catalogue import BRIDGES
from rga_bench.synthetic.case import Beyond, Case, draw_case
from rga_bench.synthetic.conditions import Conditions
from rga_bench.synthetic.hidden.catalogue import KINDS
from rga_bench.synthetic.stream import STREAM_KINDS, draw_stream

__all__ = [
    "BRIDGES",
    "KINDS",
    "STREAM_KINDS",
    "Beyond",
    "Case",
    "Conditions",
    "draw_case",
    "draw_stream",
]
