"""The gap over the time of a record."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from rga.arrays import FloatArray
from rga.drawing.charts.axes import axes_or_new
from rga.drawing.figure_style import AFTER, BEFORE, MEASURED, grid, style
from rga.drawing.time_axis import time_axis
from rga.records import Record

MARKS = {"alarm": BEFORE, "version": AFTER, "recalibration": MEASURED}


def plot_gap(
    record: Record, gap: FloatArray, events: Mapping[str, list[int]], ax: Axes | None = None
) -> Axes:
    """The gap of every row, and lines where something happened.

    Args:
        record: gives the time.
        gap: float[rows] [-], NaN where there is none.
        events: rows by the kind of the event.
        ax: axes; None: those of a new figure.
    """
    with style():
        ax = axes_or_new(ax, 3.2)
        time = time_axis(record)
        ax.plot(time.at, np.where(gap > 0, gap, np.nan), ".", color=MEASURED, markersize=2.5)
        if np.isfinite(gap).any() and np.nanmax(gap) > 0:
            ax.set_yscale("log")
        for kind, colour in MARKS.items():
            for number, row in enumerate(events.get(kind, [])):
                name = None if number else kind
                ax.axvline(time.at[row], color=colour, lw=0.8, dashes=(4, 2), label=name)
        ax.set_ylabel("gap: squared difference over noise variance")
        time.dress(ax)
        grid(ax, "y")
        if any(events.get(kind) for kind in MARKS):
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(MARKS))
    return ax
