"""Two values of each of several things, one under the other."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter
from numpy.typing import ArrayLike

from rga.drawing.charts.axes import axes_or_new
from rga.drawing.figure_style import AFTER, BEFORE, STEEL, style
from rga.drawing.label import label
from rga.quantities import short

#: names of things, and how many are drawn
LONGEST, MOST = 60, 60


def plot_pairs(
    names: Sequence[str],
    first: ArrayLike,
    second: ArrayLike,
    words: tuple[str, str],
    axis: str,
    ax: Axes | None = None,
    log: bool = False,
) -> Axes:
    """A line for each thing with a dot for each of its values.

    Args:
        names: of the things.
        first, second: their values, float[things].
        words: what the first and the second value are.
        axis: what both are, with the unit.
        ax: axes; None: those of a new figure.
        log: on a logarithmic scale; values of zero and less are left out.
    """
    one, two = (np.asarray(values, dtype=float)[:MOST] for values in (first, second))
    if log:
        one, two = (np.where(values > 0, values, np.nan) for values in (one, two))
    shown = names[:MOST]
    with style():
        ax = axes_or_new(ax, 0.9 + 0.22 * max(len(shown), 3))
        rows = np.arange(len(shown))
        ax.hlines(rows, np.fmin(one, two), np.fmax(one, two), color=STEEL, lw=1.0)
        for values, colour, word in zip((one, two), (BEFORE, AFTER), words, strict=True):
            ax.plot(values, rows, "o", color=colour, markersize=4.5, label=word)
        if log:
            ax.set_xscale("log")
            ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            ax.xaxis.set_major_formatter(lambda value, _: short(value))
            ax.xaxis.set_minor_formatter(NullFormatter())
        ax.set_yticks(rows, [label(name, LONGEST) for name in shown])
        ax.set_ylim(len(shown) - 0.5, -0.5)
        ax.set_xlabel(axis)
        ax.grid(True, axis="x", lw=0.4)
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
        if len(shown) < len(names):
            ax.set_title(f"the first {len(shown)} of {len(names)}")
    return ax
