"""The bridge drawn, with what each sensor measures against what was simulated."""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.diagnosis.account import Account
from rga.diagnosis.findings import Findings
from rga.model.parameter import FloatArray
from rga.report.deviation import percent_off
from rga.report.labels import Label, marker_offset, marker_row, place_labels
from rga.report.places import Named, Spot, named_parts, spots
from rga.report.projection import View, views
from rga.report.quantities import percent
from rga.report.svg import INK, MARKED, STEEL, inline, label, style

WIDTH = 10.0  # inches; the page shows it about as wide as its text
TITLE, KEY = 0.4, 0.75
COLOURS = LinearSegmentedColormap.from_list(
    "off", ["#08519c", "#4a90c9", "#c4c9ce", "#e8853a", "#a63603"]
)
MARKERS = {"displacement": "o", "rotation": "D", "strain": "s", "force": "s", "reaction": "^"}


@dataclass(frozen=True)
class Layout:
    """A view made ready: what stands where, at which scale.

    Attributes:
        unit: metres in an inch.
        box: left, bottom, right, top of the drawing with its labels [inch].
    """

    view: View
    here: list[Spot]
    labels: list[Label | None]
    unit: float
    box: tuple[float, float, float, float]


def draw_bridge(findings: Findings) -> Markup:
    """Every view of the bridge before and after the extension."""
    account = findings.account
    marked = named_parts((c.effect for c in findings.causes), account.model)
    drawn = views(account.model, set(marked.members))
    off = {
        "before": percent_off(account, account.before),
        "after": percent_off(account, account.after),
    }
    norm = Normalize(-_range(off), _range(off))
    beside = max(_ratio(account, view) for view in drawn) > 0.28
    columns = 2 if beside else 1
    room = (WIDTH - 0.5 * columns) / columns
    layouts = _layouts(account, drawn, room)
    heights = [one.box[3] - one.box[1] + TITLE for one in layouts for _ in range(3 - columns)]
    high = sum(heights) + KEY
    with style():
        figure = Figure(figsize=(WIDTH, high))
        top, turn = high, 0
        for one in layouts:
            for side, when in enumerate(("before", "after")):
                left = 0.25 + side * beside * (room + 0.5)
                tall = heights[turn] - TITLE
                wide = one.box[2] - one.box[0]
                rest = (room - wide) / 2
                frame = (
                    (left + rest) / WIDTH,
                    (top - TITLE - tall) / high,
                    wide / WIDTH,
                    tall / high,
                )
                axes = figure.add_axes(frame)
                _view(axes, one, account, marked, off[when], norm)
                where = (left / WIDTH, (top - 0.12) / high)
                said = f"{when.capitalize()} \N{MIDDLE DOT} {one.view.title}"
                figure.text(*where, said, fontsize=9, va="top", weight="bold")
                if not beside or side:
                    top -= heights[turn]
                    turn += 1
        _key(figure, KEY / high, norm, marked, bool(account.rejected.any()))
        return inline(figure, "bridge", _words(off))


def _layouts(account: Account, drawn: list[View], room: float) -> list[Layout]:
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
        points = _points(account, view)
        low, high = points.min(axis=0), points.max(axis=0)
        unit = max(high[0] - low[0], (high[1] - low[1]) / 1.2, 1e-9) / (room - 0.9)
        here = spots(model, view, sensors)

        def text(spot: Spot, names: bool) -> list[str]:
            return _lines(spot, account, None, names)

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


def _range(off: dict[str, FloatArray]) -> float:
    values = np.abs(np.concatenate(list(off.values())))
    values = values[np.isfinite(values)]
    most = float(np.quantile(values, 0.95)) if len(values) else 10.0
    return next((step for step in (5.0, 10.0, 20.0, 30.0, 50.0) if most <= step), 100.0)


def _points(account: Account, view: View) -> FloatArray:
    return np.array([account.model.nodes[node] for node in sorted(view.nodes)])[:, list(view.axes)]


def _ratio(account: Account, view: View) -> float:
    width, height = np.ptp(_points(account, view), axis=0)
    return float(height / width) if width > 0 else 1.2


def _view(
    axes: Axes, one: Layout, account: Account, marked: Named, off: FloatArray, norm: Normalize
) -> None:
    model, view, unit = account.model, one.view, one.unit
    axes.set_axis_off()
    axes.set_xlim(one.box[0] * unit, one.box[2] * unit)
    axes.set_ylim(one.box[1] * unit, one.box[3] * unit)
    values = {spot.member: _mean(off[spot.sensors]) for spot in one.here if spot.member is not None}
    for name in view.members:
        ends = [model.nodes[node] for node in model.members[name].nodes]
        x, y = ([end[axis] for end in ends] for axis in view.axes)
        if name in marked.members:
            axes.plot(x, y, color=MARKED, linewidth=9, alpha=0.55, zorder=1)
        value = values.get(name, np.nan)
        gauge = np.isfinite(value)
        look = (COLOURS(norm(value)), 3.4, 3) if gauge else (STEEL, 0.9, 2)
        axes.plot(x, y, color=look[0], linewidth=look[1], zorder=look[2])
    _supports(axes, view, account, marked, unit)
    for spot, label_ in zip(one.here, one.labels, strict=True):
        _spot(axes, one, spot, label_, account, off, norm)


def _mean(values: FloatArray) -> float:
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else float("nan")


def _supports(axes: Axes, view: View, account: Account, marked: Named, unit: float) -> None:
    for support in account.model.supports.values():
        if support.node not in view.nodes:
            continue
        x, y = (account.model.nodes[support.node][axis] for axis in view.axes)
        if support.node in marked.nodes:
            axes.plot(
                x, y - 0.07 * unit, "o", markersize=19, color=MARKED, alpha=0.55, mew=0, zorder=1
            )
        along = "uxuyuz"[2 * view.axes[0] :][:2]
        shape = "^" if along in support.fixed else "o"
        axes.plot(x, y - 0.075 * unit, shape, markersize=7, mfc="white", mec=INK, mew=0.9, zorder=4)


def _lines(spot: Spot, account: Account, off: FloatArray | None, names: bool) -> list[str]:
    """Text of a label; without values, so much text as it takes at most."""
    lines = []
    for column in spot.sensors:
        name = label(account.record.sensors[column], 14)
        value = "+100 %" if off is None else percent(float(off[column]))
        if account.rejected[column]:
            value = "rejected"
        one_line = len(spot.sensors) > 1 or spot.side == "right"
        lines += ([f"{name} {value}"] if one_line else [name, value]) if names else [value]
    return lines


def _spot(
    axes: Axes, one: Layout, spot: Spot, place: Label | None, account: Account, off: FloatArray,
    norm: Normalize,
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
        face = COLOURS(norm(off[column])) if np.isfinite(off[column]) else "white"
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
        "\n".join(_lines(spot, account, off, place.names)),
        fontsize=6.6,
        ha=horizontal,
        va=vertical,
        zorder=7,
        linespacing=1.05,
        bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.4},
    )


def _key(figure: Figure, share: float, norm: Normalize, marked: Named, rejected: bool) -> None:
    holder = figure.add_axes((0.02, 0.0, 0.96, share))
    holder.set_axis_off()
    bar = holder.inset_axes((0.02, 0.55, 0.34, 0.16))
    # Painted step by step: matplotlib's own colour bar would be a bitmap.
    steps = np.linspace(-1, 1, 41) * float(norm.vmax or 1.0)
    middle = (steps[:-1] + steps[1:]) / 2
    bar.bar(middle, 1.0, np.diff(steps) * 1.02, color=COLOURS(norm(middle)), linewidth=0)
    bar.set(xlim=(steps[0], steps[-1]), ylim=(0, 1), yticks=[])
    bar.spines["left"].set_visible(False)
    bar.set_xlabel("measured over simulated, percent off  (grey: they agree)", fontsize=7.5)
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


def _words(off: dict[str, FloatArray]) -> str:
    parts = []
    for when, values in off.items():
        seen = np.abs(values[np.isfinite(values)])
        if len(seen):
            parts.append(f"{when} the extension by {percent(float(np.median(seen)), sign=False)}")
    said = " and ".join(parts) or "by an amount that cannot be told"
    return f"The bridge with its sensors; the median sensor is off {said}."
