"""The gap of every sensor over time, as a map."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path as Outline

from rga.arrays import FloatArray
from rga.drawing.figure_style import FAINT, INK, inline, style
from rga.drawing.label import label
from rga.drawing.time_axis import TimeAxis, time_axis
from rga.report.figures.gap_colours import HATCH, LEVELS, GapColours, gap_colours
from rga.report.figures.of_run.run_gap import row_of, standardised
from rga.report.figures.of_run.timeline import LEFT, LOOKS, MOST_MARKS, RIGHT, WIDTH
from rga.twin.history import History

MOST_CELLS, MOST_STRETCHES, LEAST_STRETCHES = 8000, 120, 20
LINE, TALLEST = 0.115, 9.0  # inches


def draw_gap_map(history: History) -> Markup | None:
    """Sensors by time, coloured by the gap; None where no gap is known."""
    gaps = standardised(history)
    if not np.isfinite(gaps).any():
        return None
    time = time_axis(history.record)
    sensors = history.record.sensors
    edges, cells = stretches(gaps, time)
    colours = gap_colours(gaps)
    tall = min(max(LINE * len(sensors), 0.5), TALLEST)
    top, bottom = 0.22, 1.05
    high = top + tall + bottom
    with style():
        figure = Figure(figsize=(WIDTH, high))
        axes = figure.add_axes((LEFT, bottom / high, RIGHT - LEFT, tall / high))
        _paint(axes, edges, cells, colours)
        _events(axes, history, time)
        time.dress(axes)
        axes.set_ylim(len(sensors) - 0.5, -0.5)
        every = -(-len(sensors) // round(TALLEST / 0.1))
        shown = range(0, len(sensors), every)
        axes.set_yticks(shown, [label(sensors[place], 16) for place in shown], fontsize=6.2)
        axes.tick_params(axis="y", length=0, pad=2)
        colours.key(figure.add_axes((LEFT, 0.46 / high, 0.46, 0.12 / high)))
        return inline(figure, "gap-map", _words(history, gaps))


def stretches(gaps: FloatArray, time: TimeAxis) -> tuple[FloatArray, FloatArray]:
    """Equal stretches of time and the mean gap of each sensor in them.

    Args:
        gaps: float[rows, sensors], NaN where there is none.
        time: where the rows stand.

    Returns:
        Edges, float[stretches + 1] on the axis, and means, float[stretches, sensors].
    """
    rows, sensors = gaps.shape
    most = int(np.clip(MOST_CELLS // max(sensors, 1), LEAST_STRETCHES, MOST_STRETCHES))
    steps = np.diff(time.at)
    even = np.allclose(steps, time.step, rtol=0.01)
    # Where rows come unevenly, as many stretches as rows would leave some of them empty.
    count = min(most, rows if even else max(rows // 4, 1))
    first, last = time.ends
    edges = np.linspace(first, last, count + 1)
    place = np.clip(((time.at - first) / (last - first) * count).astype(int), 0, count - 1)
    finite = np.isfinite(gaps)
    total, number = np.zeros((count, sensors)), np.zeros((count, sensors))
    np.add.at(total, place, np.where(finite, gaps, 0.0))
    np.add.at(number, place, finite)
    return edges, np.where(number > 0, total / np.maximum(number, 1), np.nan)


def _paint(axes: Axes, edges: FloatArray, cells: FloatArray, colours: GapColours) -> None:
    count, sensors = cells.shape
    wide = edges[-1] - edges[0]
    axes.add_patch(
        Rectangle((edges[0], -0.5), wide, sensors, fc="white", ec=FAINT, lw=0, hatch=HATCH)
    )
    levels = colours.level(cells)
    for level in range(LEVELS):
        # Neighbours of one colour are one outline, and all outlines of a colour one path.
        boxes = []
        for sensor in range(sensors):
            turns = np.flatnonzero(np.diff(np.pad((levels[:, sensor] == level).astype(int), 1)))
            boxes += [(edges[a], edges[b], sensor) for a, b in turns.reshape(-1, 2)]
        if boxes:
            seam = 0.02 * wide / count
            corners = np.array(
                [
                    [(a, s - 0.5), (b + seam, s - 0.5), (b + seam, s + 0.5), (a, s + 0.5), (a, 0)]
                    for a, b, s in boxes
                ]
            )
            codes = [Outline.MOVETO, *[Outline.LINETO] * 3, Outline.CLOSEPOLY] * len(boxes)
            outline = Outline(corners.reshape(-1, 2), codes)
            axes.add_patch(PathPatch(outline, fc=colours.colours[level], lw=0))


def _events(axes: Axes, history: History, time: TimeAxis) -> None:
    for kind, look in LOOKS.items():
        rows = sorted({row_of(history, event) for event in history.events if event.kind == kind})
        if not look.across or len(rows) > MOST_MARKS:
            continue
        for row in rows:
            axes.axvline(time.at[row], color=look.colour, lw=0.8, zorder=3)
        axes.plot(
            time.at[rows], [1.0] * len(rows), look.shape, color=look.colour, markersize=5,
            mec="white" if look.shape != "|" else INK, mew=0.4, clip_on=False, zorder=4,
            transform=axes.get_xaxis_transform(),
        )  # fmt: skip


def _words(history: History, gaps: FloatArray) -> str:
    sensors = history.record.sensors
    most = np.nanmax(np.where(np.isfinite(gaps), gaps, -1.0), axis=0)
    worst = [label(sensors[column]) for column in np.argsort(-most, kind="stable")[:3]]
    return f"Gap of {len(sensors)} sensors over time; largest at {', '.join(worst)}."
