"""Independent physics that makes blind cases: what is hidden in them is known.

Nothing here imports the simulator, the model or the core that the cases are to test; plain
NumPy and the standard library only.
"""

from .bridges import BRIDGES
from .case import Case, draw_case
from .hidden import KINDS

__all__ = ["BRIDGES", "KINDS", "Case", "draw_case"]
