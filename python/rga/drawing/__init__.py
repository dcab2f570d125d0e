"""Drawings of models, and the look that all figures share."""

from rga.drawing.content import Shown
from rga.drawing.drawings import draw, plot_model

__all__ = ["Shown", "draw", "plot_model"]
