"""A cause against its nearest rival, on the channels that separate them best."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.arrays import FloatArray
from rga.diagnosis.checks.leave_one_out import Contrast
from rga.drawing.figure_style import AFTER, BEFORE, MEASURED, STEEL, grid, inline, style
from rga.drawing.label import label
from rga.model.schema import Model
from rga.quantities import duration, scale, short

COLUMNS, MEANS = 3, 8
#: letters of a name above a panel
TITLE = 10


def draw_contrast(one: Contrast, model: Model, smooth: bool, name: str) -> Markup:
    """What was measured beyond the rival's prediction, beside what the cause predicts beyond it.

    Args:
        one: the contrast.
        model: gives the units of the channels.
        smooth: the rows follow each other in time; else one is drawn against the other.
        name: as for `inline`.
    """
    with style():
        high = 2.3 if smooth else 2.9
        figure = Figure(figsize=(10.0, high))
        cells = figure.add_gridspec(
            1, COLUMNS, left=0.065, right=0.985, top=1 - 0.55 / high, bottom=0.45 / high, wspace=0.3
        )
        for place, channel in enumerate(one.channels):
            axes = figure.add_subplot(cells[place])
            measured, predicted = one.measured[:, place], one.predicted[:, place]
            largest = float(np.nanmax(np.abs([*measured, *predicted, 0.0])))
            factor, unit = scale(model.sensors[channel].unit, largest)
            axes.set_title(
                f"{label(channel, TITLE)}: {short(one.size[place], 2)} times its noise apart"
            )
            if smooth:
                _over_time(axes, one.time, measured * factor, predicted * factor, unit)
            else:
                _against(axes, measured * factor, predicted * factor, unit)
        figure.legend(handles=_key(smooth), loc="upper center", ncols=3)
        names = ", ".join(label(channel) for channel in one.channels)
        return inline(
            figure, name, f"Measured beyond the prediction of the nearest rival: {names}."
        )


def _over_time(
    axes: Axes, time: FloatArray, measured: FloatArray, predicted: FloatArray, unit: str
) -> None:
    clock = time - time[0]
    length, time_unit = duration(float(clock[-1]))
    at = clock * (length / max(float(clock[-1]), 1e-300))
    axes.plot(at, measured, ".", color=MEASURED, markersize=2.6)
    axes.plot(at, predicted, color=AFTER, lw=1.2)
    axes.axhline(0.0, color=BEFORE, lw=1.0, dashes=(4, 1.6))
    axes.set_xlabel(f"time since the first row [{time_unit}]", labelpad=1.5)
    axes.set_ylabel(f"beyond the rival [{unit}]", labelpad=1.5)
    grid(axes, "y")


def _against(axes: Axes, measured: FloatArray, predicted: FloatArray, unit: str) -> None:
    reach = 1.08 * float(np.nanmax(np.abs([*predicted, 0.0])))
    axes.plot(predicted, measured, ".", color=STEEL, markersize=2.6)
    if reach > 0:
        axes.plot([-reach, reach], [-reach, reach], color=AFTER, lw=1.2)
        axes.plot([-reach, reach], [0.0, 0.0], color=BEFORE, lw=1.0, dashes=(4, 1.6))
    x, y, error = _means(predicted, measured)
    axes.errorbar(x, y, error, fmt="o", color=MEASURED, markersize=3.4, lw=1.0, zorder=4)
    axes.set_xlabel(f"cause less rival [{unit}]", labelpad=1.5)
    axes.set_ylabel(f"measured less rival [{unit}]", labelpad=1.5)
    axes.locator_params(axis="x", nbins=5)
    grid(axes)


def _means(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Means of as many points each, along x, with the standard error of that of y."""
    seen = np.isfinite(x) & np.isfinite(y)
    order = np.argsort(x[seen], kind="stable")
    parts = [part for part in np.array_split(order, MEANS) if len(part) > 1]
    points = [
        (x[seen][part].mean(), y[seen][part].mean(), y[seen][part].std() / np.sqrt(len(part)))
        for part in parts
    ]
    return tuple(np.array(points).reshape(-1, 3).T)  # type: ignore[return-value]


def _key(smooth: bool) -> list[Line2D]:
    look = "as the cause predicts" if smooth else "where they lie if the cause is right"
    other = "as the rival predicts" if smooth else "where they lie if the rival is right"
    points = "measured" if smooth else "measured, means with their error"
    return [
        Line2D([], [], ls="", marker="." if smooth else "o", color=MEASURED, label=points),
        Line2D([], [], color=AFTER, lw=1.2, label=look),
        Line2D([], [], color=BEFORE, lw=1.0, dashes=(4, 1.6), label=other),
    ]
