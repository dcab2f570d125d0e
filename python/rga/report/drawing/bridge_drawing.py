"""A drawing of the bridge with a value at every sensor, in one panel or several."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.arrays import FloatArray
from rga.drawing.figure_style import INK, MARKED, STEEL, inline, style
from rga.drawing.label import label
from rga.drawing.projection import Projection, views
from rga.findings.arrays import DiagnosisArrays
from rga.model.schema import Model
from rga.report.drawing.labels import Label, marker_offset, marker_row, place_labels
from rga.report.drawing.places import Named, Spot, spots

WIDTH = 10.0  # inches; the page shows it about as wide as its text
TITLE, KEY = 0.4, 0.75
MARKERS = {"displacement": "o", "rotation": "D", "strain": "s", "force": "s", "reaction": "^"}


@dataclass(frozen=True)
class Shades:
    """How values become colours and text.

    Attributes:
        norm, colours: from a value to a colour.
        text: from a value to what stands at the sensor.
        longest: a text as long as any.
        words: what the colours mean.
    """

    norm: Normalize
    colours: Colormap
    text: Callable[[float], str]
    longest: str
    words: str

    def colour(self, value: float) -> tuple[float, float, float, float]:
        """The colour of a value."""
        return self.colours(float(self.norm(value)))


@dataclass(frozen=True)
class Layout:
    """A view made ready: what stands where, at which scale.

    Attributes:
        unit: metres in an inch.
        box: left, bottom, right, top of the drawing with its labels [inch].
    """

    view: Projection
    here: list[Spot]
    labels: list[Label | None]
    unit: float
    box: tuple[float, float, float, float]


def draw_at_sensors(
    account: DiagnosisArrays,
    marked: Named,
    panels: Sequence[tuple[str, FloatArray]],
    shades: Shades,
    name: str,
    words: str,
) -> Markup:
    """Every view of the bridge, once for each panel.

    Args:
        account: gives the model and the sensors.
        marked: parts to be marked.
        panels: title and values, float[sensors of the record]; NaN where there is none.
        shades: of the values.
        name, words: as for `inline`.
    """
    drawn = views(account.model, set(marked.members))
    beside = len(panels) > 1 and max(height_over_width(account.model, one) for one in drawn) > 0.28
    columns = 2 if beside else 1
    room = (WIDTH - 0.5 * columns) / columns
    cells = [
        (one, *panel) for one in _layouts(account, drawn, room, shades.longest) for panel in panels
    ]
    if beside and len(panels) % 2:
        cells = [cell for title, _ in panels for cell in cells if cell[1] == title]
    lines = [cells[first : first + columns] for first in range(0, len(cells), columns)]
    heights = [max(one.box[3] - one.box[1] for one, *_ in line) + TITLE for line in lines]
    high = sum(heights) + KEY
    with style():
        figure = Figure(figsize=(WIDTH, high))
        top = high
        for line, height in zip(lines, heights, strict=True):
            for side, (one, title, values) in enumerate(line):
                left = 0.25 + side * (room + 0.5)
                tall, wide = one.box[3] - one.box[1], one.box[2] - one.box[0]
                rest = (room - wide) / 2
                frame = (
                    (left + rest) / WIDTH,
                    (top - TITLE - tall) / high,
                    wide / WIDTH,
                    tall / high,
                )
                axes = figure.add_axes(frame)
                _view(axes, one, account, marked, values, shades)
                said = f"{title} \N{MIDDLE DOT} {one.view.title}" if title else one.view.title
                where = (left / WIDTH, (top - 0.12) / high)
                figure.text(*where, said, fontsize=9, va="top", weight="bold")
            top -= height
        _key(figure, KEY / high, shades, marked, bool(account.rejected.any()))
        return inline(figure, name, words)


def _layouts(
    account: DiagnosisArrays, drawn: list[Projection], room: float, longest: str
) -> list[Layout]:
    model, record = account.model, account.record
    taken: set[int] = set()
    found = []
    for view in drawn:
        sensors = {
            column: name
            for column, name in enumerate(record.sensors)
            if column not in taken and name in model.sensors and view.holds(model.sensors[name])
        }
        taken |= set(sensors)
        points = _points(model, view)
        low, high = points.min(axis=0), points.max(axis=0)
        unit = max(high[0] - low[0], (high[1] - low[1]) / 1.2, 1e-9) / (room - 0.9)
        here = spots(model, view, sensors)

        def text(spot: Spot, names: bool) -> list[str]:
            return _lines(spot, account, [longest] * len(account.record.sensors), names)

        right, up = view.axes
        feet = [model.nodes[s.node] for s in model.supports.values() if s.node in view.nodes]
        labels = place_labels(here, unit, text, [(foot[right], foot[up]) for foot in feet])
        boxes = np.array(
            [label.box for label in labels if label is not None]
            + [
                (
                    low[0] / unit - 0.3,
                    low[1] / unit - 0.3,
                    high[0] / unit + 0.3,
                    high[1] / unit + 0.15,
                )
            ]
        )
        edges = (*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0))
        box = (float(edges[0]), float(edges[1]) - 0.05, float(edges[2]), float(edges[3]) + 0.05)
        found.append(Layout(view, here, labels, unit, box))
    return found


def _points(model: Model, view: Projection) -> FloatArray:
    return np.array([model.nodes[node] for node in sorted(view.nodes)])[:, list(view.axes)]


def height_over_width(model: Model, view: Projection) -> float:
    """Of what a view shows."""
    width, height = np.ptp(_points(model, view), axis=0)
    return float(height / width) if width > 0 else 1.2


def _view(
    axes: Axes,
    one: Layout,
    account: DiagnosisArrays,
    marked: Named,
    shown: FloatArray,
    shades: Shades,
) -> None:
    model, view, unit = account.model, one.view, one.unit
    axes.set_axis_off()
    axes.set_xlim(one.box[0] * unit, one.box[2] * unit)
    axes.set_ylim(one.box[1] * unit, one.box[3] * unit)
    values = {
        spot.member: _mean(shown[spot.sensors]) for spot in one.here if spot.member is not None
    }
    for name in view.members:
        ends = [model.nodes[node] for node in model.members[name].nodes]
        x, y = ([end[axis] for end in ends] for axis in view.axes)
        if name in marked.members:
            axes.plot(x, y, color=MARKED, linewidth=9, alpha=0.55, zorder=1)
        value = values.get(name, np.nan)
        gauge = np.isfinite(value)
        look = (shades.colour(value), 3.4, 3) if gauge else (STEEL, 0.9, 2)
        axes.plot(x, y, color=look[0], linewidth=look[1], zorder=look[2])
    draw_supports(axes, view, model, marked, unit)
    for spot, label_ in zip(one.here, one.labels, strict=True):
        _spot(axes, one, spot, label_, account, shown, shades)


def _mean(values: FloatArray) -> float:
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else float("nan")


def draw_supports(axes: Axes, view: Projection, model: Model, marked: Named, unit: float) -> None:
    """Supports of a view drawn at so many metres an inch, those marked on a patch of colour."""
    for support in model.supports.values():
        if support.node not in view.nodes:
            continue
        x, y = (model.nodes[support.node][axis] for axis in view.axes)
        if support.node in marked.nodes:
            axes.plot(
                x, y - 0.07 * unit, "o", markersize=19, color=MARKED, alpha=0.55, mew=0, zorder=1
            )
        along = "uxuyuz"[2 * view.axes[0] :][:2]
        shape = "^" if along in support.fixed else "o"
        axes.plot(x, y - 0.075 * unit, shape, markersize=7, mfc="white", mec=INK, mew=0.9, zorder=4)


def _lines(spot: Spot, account: DiagnosisArrays, texts: Sequence[str], names: bool) -> list[str]:
    """Text of a label, from the texts of all sensors."""
    lines = []
    for column in spot.sensors:
        name = label(account.record.sensors[column], 14)
        value = "rejected" if account.rejected[column] else texts[column]
        one_line = len(spot.sensors) > 1 or spot.side == "right"
        lines += ([f"{name} {value}"] if one_line else [name, value]) if names else [value]
    return lines


def _spot(
    axes: Axes, one: Layout, spot: Spot, place: Label | None, account: DiagnosisArrays,
    shown: FloatArray, shades: Shades,
) -> None:  # fmt: skip
    unit = one.unit
    y = spot.y + marker_offset(spot) * unit
    for number, column in enumerate(spot.sensors):
        sensor = account.model.sensors[account.record.sensors[column]]
        x = spot.x + (0.11 * number - marker_row(spot)) * unit
        if account.rejected[column]:
            axes.plot(x, y, "x", color=INK, markersize=6.5, mew=1.6, zorder=6)
            continue
        if sensor.direction is not None and sensor.kind != "rotation":
            towards = np.array(sensor.direction)[list(one.view.axes)] / np.linalg.norm(
                sensor.direction
            )
            dx, dy = 0.11 * unit * towards
            axes.plot([x - dx, x + dx], [y - dy, y + dy], color=INK, lw=0.9, zorder=4)
        face = shades.colour(shown[column]) if np.isfinite(shown[column]) else "white"
        axes.plot(x, y, MARKERS[sensor.kind], mfc=face, mec=INK, mew=0.6, markersize=6.2, zorder=5)
    if place is None:
        return
    sides = {"below": ("center", "top"), "above": ("center", "bottom"), "right": ("left", "center")}
    horizontal, vertical = sides[spot.side]
    to = spot.x + place.x * unit, spot.y + place.y * unit
    if place.far:
        axes.plot([spot.x, to[0]], [y, to[1]], color=STEEL, lw=0.5, zorder=3)
    axes.text(
        *to,
        "\n".join(_lines(spot, account, [shades.text(one) for one in shown], place.names)),
        fontsize=6.6,
        ha=horizontal,
        va=vertical,
        zorder=7,
        linespacing=1.05,
        bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.4},
    )


def _key(figure: Figure, share: float, shades: Shades, marked: Named, rejected: bool) -> None:
    holder = figure.add_axes((0.02, 0.0, 0.96, share))
    holder.set_axis_off()
    paint_scale(holder.inset_axes((0.02, 0.55, 0.34, 0.16)), shades)
    shapes = [
        Line2D([], [], ls="", marker="o", mfc="white", mec=INK, label="displacement"),
        Line2D(
            [], [], color=STEEL, lw=3.4, marker="s", mfc="white", mec=INK, label="strain or force"
        ),
    ]
    if rejected:
        shapes.append(
            Line2D([], [], ls="", marker="x", color=INK, mew=1.6, label="rejected channel")
        )
    if marked.members or marked.nodes:
        shapes.append(Line2D([], [], color=MARKED, lw=8, alpha=0.55, label="named by a cause"))
    holder.legend(handles=shapes, loc="center right", ncols=len(shapes), handlelength=1.6)


def paint_scale(bar: Axes, shades: Shades) -> None:
    """The scale of colours, painted step by step: matplotlib's own would be a bitmap."""
    low, high = (float(end) for end in (shades.norm.vmin or 0.0, shades.norm.vmax or 1.0))
    steps = np.linspace(low, high, 41)
    middle = (steps[:-1] + steps[1:]) / 2
    colours = [shades.colour(one) for one in middle]
    bar.bar(middle, 1.0, np.diff(steps) * 1.02, color=colours, linewidth=0)
    bar.set(xlim=(low, high), ylim=(0, 1), yticks=[])
    bar.spines["left"].set_visible(False)
    bar.set_xlabel(shades.words, fontsize=7.5)
