"""Drawings of models, and the look that all figures share."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.drawing.content import Selection
    from rga.drawing.drawings import draw, plot_model, plot_results

__all__ = [
    "Selection",
    "draw",
    "plot_model",
    "plot_results",
]

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "Selection": "rga.drawing.content",
    "draw": "rga.drawing.drawings",
    "plot_model": "rga.drawing.drawings",
    "plot_results": "rga.drawing.drawings",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
