"""The contexts that the twin inferred, over time."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.drawing.figure_style import AFTER, BEFORE, FAINT, grid, inline, style
from rga.drawing.label import label
from rga.drawing.time_axis import TimeAxis, spaced, thinned, time_axis
from rga.quantities import scale
from rga.twin.history import History

#: standard deviations from the middle to the ends of a 90 % interval of a normal distribution
Z90 = 1.645
WIDTH, HIGH = 10.0, 1.25
ONE_COLUMN = 3
MOST_POINTS, MOST_BARS = 500, 240


def drawn_contexts(history: History) -> list[int]:
    """Columns of the contexts to draw: those that were not measured, where any row has a value."""
    return [
        column
        for column, name in enumerate(history.contexts)
        if name not in history.record.contexts and np.isfinite(history.inferred[:, column]).any()
    ]


def out_of_range(history: History, column: int) -> NDArray[np.bool_]:
    """Rows on which a context leaves its range by more than its 90 % interval, bool[rows]."""
    known = history.model.context.get(history.contexts[column])
    values = history.inferred[:, column]
    if known is None:
        return np.zeros(len(values), dtype=bool)
    margin = Z90 * np.nan_to_num(history.spread[:, column])
    with np.errstate(invalid="ignore"):
        return (values < known.range[0] - margin) | (values > known.range[1] + margin)


def draw_contexts(history: History) -> Markup | None:
    """One panel a context; None where none was inferred."""
    columns = drawn_contexts(history)
    if not columns:
        return None
    time = time_axis(history.record)
    wide = 1 if len(columns) <= ONE_COLUMN else 2
    rows = -(-len(columns) // wide)
    top, bottom = 0.55, 0.5
    high = top + rows * HIGH + (rows - 1) * 0.28 + bottom
    with style():
        figure = Figure(figsize=(WIDTH, high))
        cells = figure.add_gridspec(
            rows, wide, left=0.07, right=0.985, top=1 - top / high, bottom=bottom / high,
            hspace=0.28 / HIGH * 1.3, wspace=0.14,
        )  # fmt: skip
        for place, column in enumerate(columns):
            axes = figure.add_subplot(cells[place // wide, place % wide])
            _panel(axes, history, column, time)
            time.dress(axes, labelled=place + wide >= len(columns))
        figure.legend(handles=_key(), loc="upper center", ncols=4)
        names = ", ".join(label(history.contexts[column]) for column in columns)
        return inline(figure, "contexts", f"Contexts inferred over time: {names}.")


def _panel(axes: Axes, history: History, column: int, time: TimeAxis) -> None:
    name = history.contexts[column]
    known = history.model.context.get(name)
    stated = None if known is None else known.range
    largest = np.nanmax(np.abs(np.append(history.inferred[:, column], stated or ())))
    factor, unit = scale("" if known is None else known.unit, float(largest))
    values, spread = history.inferred[:, column] * factor, history.spread[:, column] * factor
    ends = None if stated is None else (stated[0] * factor, stated[1] * factor)
    outside = out_of_range(history, column)
    if ends is not None:
        axes.axhspan(*ends, color=FAINT, alpha=0.4, lw=0, zorder=0)
    low, high = values - Z90 * spread, values + Z90 * spread
    if ends is not None:
        # What the range rules out is no part of an interval, unless the value itself is outside.
        low, high = (
            np.maximum(low, np.minimum(ends[0], values)),
            np.minimum(high, np.maximum(ends[1], values)),
        )
    if _smooth(values):
        rows = thinned(values, MOST_POINTS)
        axes.fill_between(
            time.at[rows], low[rows], high[rows], color=AFTER, alpha=0.25, lw=0, zorder=1
        )
        axes.plot(time.at[rows], values[rows], color=AFTER, lw=1.0, zorder=2)
        alone = _alone(values)
        axes.plot(time.at[alone], values[alone], ".", color=AFTER, markersize=3, zorder=2)
    else:
        rows = spaced(len(values), MOST_BARS)
        known_spread = rows[np.isfinite(low[rows] + high[rows])]
        axes.vlines(
            time.at[known_spread], low[known_spread], high[known_spread],
            color=AFTER, alpha=0.35, lw=0.8, zorder=1,
        )  # fmt: skip
        axes.plot(time.at[rows], values[rows], ".", color=AFTER, markersize=3, zorder=2)
    marked = np.flatnonzero(outside)
    marked = marked[spaced(len(marked), MOST_BARS)]
    axes.plot(time.at[marked], values[marked], ".", color=BEFORE, markersize=4, zorder=3)
    axes.set_ylim(*_limits(values, low, high, ends))
    grid(axes, "y")
    axes.set_title(label(name) + (f" [{unit}]" if unit else ""))


def _alone(values: FloatArray) -> NDArray[np.bool_]:
    """Values between two missing ones, which a line does not show."""
    finite = np.pad(np.isfinite(values), 1)
    return np.asarray(finite[1:-1] & ~finite[:-2] & ~finite[2:])


def _smooth(values: FloatArray) -> bool:
    """Whether values run on from row to row, so that a line through them says something."""
    seen = values[np.isfinite(values)]
    seen = seen - seen.mean()
    energy = float((seen**2).sum())
    return len(seen) > 1 and (energy == 0 or float((seen[1:] * seen[:-1]).sum()) > 0.7 * energy)


def _limits(
    values: FloatArray, low: FloatArray, high: FloatArray, stated: tuple[float, float] | None
) -> tuple[float, float]:
    """What the values need, with their intervals as far as these are no wider than the rest."""
    ends = [float(np.nanmin(values)), float(np.nanmax(values)), *(stated or ())]
    reach = max(ends) - min(ends) or 1.0
    least = np.nanmin(np.append(low[np.isfinite(low)], min(ends)))
    most = np.nanmax(np.append(high[np.isfinite(high)], max(ends)))
    bottom, top = max(least, min(ends) - 0.3 * reach), min(most, max(ends) + 0.3 * reach)
    return float(bottom - 0.05 * reach), float(top + 0.05 * reach)


def _key() -> list[Line2D | Patch]:
    return [
        Line2D([], [], color=AFTER, marker=".", lw=1.0, label="inferred"),
        Patch(color=AFTER, alpha=0.3, label="90 % interval"),
        Patch(color=FAINT, alpha=0.6, label="range that the model states"),
        Line2D([], [], ls="", marker=".", color=BEFORE, label="out of this range"),
    ]
