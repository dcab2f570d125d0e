"""How the repository of simulations grew."""

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from rga.drawing.figure_style import AFTER, STEEL, grid, inline, style
from rga.drawing.time_axis import time_axis
from rga.quantities import fixed
from rga.report.figures.of_run.timeline import LEFT, RIGHT, WIDTH
from rga.twin.history import History

HIGH, BOTTOM, TOP = 1.2, 0.5, 0.3  # inches
MOST_STEPS = 600


def draw_growth(history: History) -> Markup | None:
    """Stored simulations over time, and those of novel contexts; None where none are known."""
    if not history.growth or not len(history.record):
        return None
    time = time_axis(history.record)
    every = -(-len(history.growth) // MOST_STEPS)
    steps = [*history.growth[:-1:every], history.growth[-1]]
    rows, stored, novel = np.array(steps).T
    at = time.at[np.clip(rows, 0, len(time.at) - 1)]
    at = np.append(at, time.ends[1])
    high = TOP + HIGH + BOTTOM
    with style():
        figure = Figure(figsize=(WIDTH, high))
        axes = figure.add_axes((LEFT, BOTTOM / high, RIGHT - LEFT, HIGH / high))
        for values, colour, words in (
            (stored, STEEL, "all stored simulations"),
            (novel, AFTER, "of these from novel contexts"),
        ):
            level = np.append(values, values[-1])
            axes.step(at, level, where="post", color=colour, lw=1.6, label=words)
        axes.set_ylim(0, max(1.0, 1.12 * float(stored.max())))
        axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: fixed(value, 0)))
        grid(axes, "y")
        time.dress(axes)
        figure.legend(loc="upper right", ncols=2)
        words = f"Stored simulations over time: {stored[0]} at first, {stored[-1]} at the end."
        return inline(figure, "growth", words)
