"""Drawings of models, and the look that all figures share."""

from rga.drawing.content import Selection
from rga.drawing.drawings import draw, plot_model, plot_results

__all__ = ["Selection", "draw", "plot_model", "plot_results"]
