"""Groups of channels predicted by what was fitted to the other channels."""

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.arrays import FloatArray
from rga.diagnosis.checks.leave_one_out import Unseen
from rga.drawing.figure_style import AFTER, BEFORE, MEASURED, grid, inline, style
from rga.drawing.label import label
from rga.model.parameter import NORMAL_90
from rga.model.schema import Model
from rga.quantities import scale

COLUMNS, MOST_DOTS = 3, 240


def draw_unseen(groups: list[Unseen], model: Model) -> Markup | None:
    """For every group that the causes touch, its channel on which they show most.

    None where the causes touch no group.
    """
    shown = [(one, column) for one in groups if (column := _telling(one)) is not None]
    if not shown:
        return None
    lines = -(-len(shown) // COLUMNS)
    with style():
        high = 2.7 * lines + 0.3
        figure = Figure(figsize=(10.0, high))
        cells = figure.add_gridspec(
            lines, COLUMNS, left=0.065, right=0.985, top=1 - 0.6 / high, bottom=0.47 / high,
            hspace=0.5, wspace=0.3,
        )  # fmt: skip
        for place, (one, column) in enumerate(shown):
            axes = figure.add_subplot(cells[place // COLUMNS, place % COLUMNS])
            shown_as = (one.without, one.with_causes, one.measured, NORMAL_90 * one.left_open)
            values = [each[:, column] for each in shown_as]
            largest = float(np.nanmax(np.abs(values[:3])))
            factor, unit = scale(model.sensors[one.channels[column]].unit, largest)
            without, with_causes, measured, either_way = (factor * _thin(a) for a in values)
            finite = np.concatenate([without, with_causes, measured[np.isfinite(measured)]])
            ends = [float(finite.min()), float(finite.max())]
            axes.plot(ends, ends, color=MEASURED, lw=0.7, zorder=1)
            axes.plot(without, measured, "^", color=BEFORE, markersize=2.7, alpha=0.6, mew=0)
            beside = (with_causes - either_way, with_causes + either_way)
            axes.hlines(measured, *beside, color=AFTER, lw=0.5, alpha=0.25, zorder=1)
            axes.plot(with_causes, measured, "o", color=AFTER, markersize=2.7, alpha=0.8, mew=0)
            axes.set_title(f"{label(one.group)}: {label(one.channels[column], 18)}")
            axes.set_xlabel(f"predicted [{unit}]", labelpad=1.5)
            axes.set_ylabel(f"measured [{unit}]", labelpad=1.5)
            grid(axes)
        figure.legend(
            handles=[
                Line2D([], [], ls="", color=BEFORE, marker="^", markersize=4, label="without"),
                Line2D([], [], ls="", color=AFTER, marker="o", markersize=4, label="with causes"),
                Line2D([], [], color=MEASURED, lw=0.8, label="measured = predicted"),
                Line2D([], [], color=AFTER, lw=0.8, alpha=0.5, label="90 % of what is left open"),
            ],
            loc="upper center",
            ncols=4,
        )
        names = ", ".join(label(one.group) for one, _ in shown)
        return inline(figure, "unseen", f"Channels predicted without being fitted: {names}.")


def _telling(one: Unseen) -> int | None:
    """The channel that the causes change most, over how it moves; None where they change none."""
    seen = np.isfinite(one.measured)
    change = np.where(seen, one.with_causes - one.without, 0.0)
    moves = np.sqrt((np.where(seen, one.without, 0.0) ** 2).mean(0))
    size = np.sqrt((change**2).mean(0))
    share = size / np.maximum(moves, 1e-300)
    return int(np.argmax(size)) if float(share.max(initial=0.0)) > 1e-3 else None


def _thin(values: FloatArray) -> FloatArray:
    rows = np.linspace(0, len(values) - 1, min(len(values), MOST_DOTS)).round().astype(int)
    return np.asarray(values[rows])
