"""Channels of a record over time."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from rga.arrays import FloatArray
from rga.drawing.charts.axes import axes_or_new
from rga.drawing.figure_style import AFTER, FAINT, MEASURED, style
from rga.drawing.label import label
from rga.drawing.time_axis import thinned, time_axis
from rga.errors import InputError
from rga.quantities import short
from rga.records import Record

#: strips in one chart, and points drawn of each
MOST_STRIPS, MOST_POINTS = 40, 2000
#: height of a strip [inch]
HIGH = 0.34


def plot_record(
    record: Record, ax: Axes | None = None, channels: Sequence[str] | None = None
) -> Axes:
    """Channels and measured contexts over time, one strip each with its own scale.

    One channel alone has its values on the axis; of several the name says from where to where.

    Args:
        record: the record.
        ax: axes; None: those of a new figure.
        channels: names of sensors or contexts; None: all, the first 40.

    Raises:
        InputError: the record has no row, or no such channel.
    """
    columns = dict(zip(record.sensors, record.readings.T, strict=True)) | record.contexts
    if not len(record) or not columns:
        raise InputError("there is nothing to draw", "record", "give one with rows and channels")
    for name in channels or ():
        if name not in columns:
            raise InputError(
                f"there is no channel {name!r}", "record", "it has " + ", ".join(columns)
            )
    names = list(columns)[:MOST_STRIPS] if channels is None else list(channels)
    with style():
        ax = axes_or_new(ax, 0.9 + HIGH * max(len(names), 4))
        time = time_axis(record)
        if len(names) == 1:
            values = columns[names[0]]
            rows = thinned(values, MOST_POINTS)
            ax.plot(time.at[rows], values[rows], color=MEASURED, lw=0.9)
            ax.set_ylabel(label(names[0]))
        else:
            ticks = []
            for place, name in enumerate(names):
                values = columns[name]
                rows = thinned(values, MOST_POINTS)
                ticks.append(_strip(ax, time.at[rows], values[rows], place, name, record))
            ax.set_yticks(range(len(names)), ticks)
            ax.set_ylim(len(names) - 0.45, -0.55)
        time.dress(ax)
        if len(names) < len(columns) and channels is None:
            ax.set_title(f"the first {len(names)} of {len(columns)} channels")
    return ax


def _strip(
    ax: Axes, time: FloatArray, values: FloatArray, place: int, name: str, record: Record
) -> str:
    """Draw a channel into its strip; its name with its range."""
    ax.axhline(place + 0.5, color=FAINT, lw=0.5)
    finite = values[np.isfinite(values)]
    if not len(finite):
        return f"{label(name, 20)}  no value"
    low, high = float(finite.min()), float(finite.max())
    share = (
        (values - low) / (high - low) if high > low else np.where(np.isfinite(values), 0.5, np.nan)
    )
    colour = MEASURED if name in record.sensors else AFTER
    ax.plot(time, place + 0.4 - 0.8 * share, color=colour, lw=0.8)
    return f"{label(name, 20)}  {short(low)} to {short(high)}"
