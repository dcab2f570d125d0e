"""The bridge drawn, with what each sensor measures against what was simulated."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.diagnosis.account import Account
from rga.diagnosis.findings import Findings
from rga.model.parameter import FloatArray
from rga.report.deviation import percent_off
from rga.report.places import Named, Spot, named_parts, spots
from rga.report.projection import View, views
from rga.report.quantities import percent
from rga.report.svg import INK, MARKED, STEEL, inline, label, style

WIDTH = 10.0  # inches; the page shows it about as wide as its text
COLOURS = LinearSegmentedColormap.from_list(
    "off", ["#08519c", "#4a90c9", "#c4c9ce", "#e8853a", "#a63603"]
)
MARKERS = {"displacement": "o", "rotation": "D", "strain": "s", "force": "s", "reaction": "^"}


def draw_bridge(findings: Findings) -> Markup:
    """Every view of the bridge before and after the extension."""
    account = findings.account
    model = account.model
    marked = named_parts((c.effect for c in findings.causes), model)
    drawn = views(model, set(marked.members))
    off = {
        "before": percent_off(account, account.before),
        "after": percent_off(account, account.after),
    }
    norm = Normalize(-_range(off), _range(off))
    with style():
        shape = max(_ratio(account, view) for view in drawn)
        beside = shape > 0.4
        columns = 2 if beside else 1
        rows = len(drawn) * (1 if beside else 2)
        room = (WIDTH - 0.4 - 0.3 * (columns - 1)) / columns
        heights = [room * min(_ratio(account, view), 1.2) + 1.05 for view in drawn]
        heights = heights if beside else [h for h in heights for _ in range(2)]
        foot = 0.75
        figure = Figure(figsize=(WIDTH, sum(heights) + foot))
        cells = figure.add_gridspec(
            rows + 1, columns, height_ratios=[*heights, foot], left=0.02, right=0.98, top=0.995,
            bottom=0.005, hspace=0.0, wspace=0.04,
        )  # fmt: skip
        taken: set[int] = set()
        for number, view in enumerate(drawn):
            here = {
                column: name
                for column, name in enumerate(account.record.sensors)
                if column not in taken and name in model.sensors and view.holds(model.sensors[name])
            }
            taken |= set(here)
            for turn, when in enumerate(("before", "after")):
                cell = cells[number, turn] if beside else cells[2 * number + turn, 0]
                axes = figure.add_subplot(cell)
                _view(axes, view, account, marked, here, off[when], norm, room)
                axes.set_title(f"{when.capitalize()} · {view.title}", fontsize=9, pad=2)
        _key(figure, cells[rows, :], norm, marked, bool(account.rejected.any()))
        return inline(figure, "bridge", _words(findings, off))


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
    axes: Axes, view: View, account: Account, marked: Named, sensors: dict[int, str],
    off: FloatArray, norm: Normalize, room: float,
) -> None:  # fmt: skip
    model = account.model
    points = _points(account, view)
    low, high = points.min(axis=0), points.max(axis=0)
    unit = max(high[0] - low[0], 0.5 * (high[1] - low[1]), 1e-9) / (room - 0.9)  # metres in an inch
    axes.set_axis_off()
    axes.set_aspect("equal", adjustable="box", anchor="N")
    axes.set_xlim(low[0] - 0.45 * unit, high[0] + 0.45 * unit)
    axes.set_ylim(low[1] - 0.62 * unit, high[1] + 0.32 * unit)
    here = spots(model, view, sensors)
    values = {spot.member: _mean(off[spot.sensors]) for spot in here if spot.member is not None}
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
    say = _saying(here, account, off, unit)
    for spot in here:
        _spot(axes, spot, account, off, norm, unit, say)


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


def _saying(here: list[Spot], account: Account, off: FloatArray, unit: float) -> str:
    """How much a label may say: "all", "percent" or "" where labels would overlap."""
    for say in ("all", "percent"):
        wide = [
            max(len(line) for line in _lines(spot, account, off, say)) * 0.066 * unit
            for spot in here
        ]
        clash = any(
            abs(a.x - b.x) < (wide[i] + wide[j]) / 2 and abs(a.y - b.y) < 0.3 * unit
            for i, a in enumerate(here)
            for j, b in enumerate(here[:i])
            if (a.side, a.tier) == (b.side, b.tier)
        )
        if not clash:
            return say
    return ""


def _lines(spot: Spot, account: Account, off: FloatArray, say: str) -> list[str]:
    lines = []
    for column in spot.sensors:
        name = label(account.record.sensors[column], 14)
        value = "rejected" if account.rejected[column] else percent(float(off[column]))
        short = len(spot.sensors) == 1 and spot.side != "right"
        lines += ([name, value] if short else [f"{name} {value}"]) if say == "all" else [value]
    return lines


def _spot(
    axes: Axes,
    spot: Spot,
    account: Account,
    off: FloatArray,
    norm: Normalize,
    unit: float,
    say: str,
) -> None:
    down = {"below": -1.0, "above": 1.0, "right": 0.0}[spot.side]
    y = spot.y + down * (0.0 if spot.tier == 1 else 0.2) * unit
    step = 0.11 * unit
    first = spot.x - step * (len(spot.sensors) - 1) / 2
    for place, column in enumerate(spot.sensors):
        kind = account.model.sensors[account.record.sensors[column]].kind
        x = first + step * place
        if account.rejected[column]:
            axes.plot(x, y, "x", color=INK, markersize=6.5, mew=1.6, zorder=6)
            continue
        value = off[column]
        face = COLOURS(norm(value)) if np.isfinite(value) else "white"
        axes.plot(x, y, MARKERS[kind], mfc=face, mec=INK, mew=0.6, markersize=6.2, zorder=5)
    if say:
        text = "\n".join(_lines(spot, account, off, say))
        side = {
            "below": ("center", "top"),
            "above": ("center", "bottom"),
            "right": ("left", "center"),
        }
        horizontal, vertical = side[spot.side]
        last = first + step * (len(spot.sensors) - 1) + 0.08 * unit
        axes.text(
            last if spot.side == "right" else spot.x,
            y + down * 0.08 * unit,
            text,
            fontsize=6.6,
            ha=horizontal,
            va=vertical,
            zorder=7,
            linespacing=1.05,
            bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.4},
        )


def _key(figure: Figure, cell: object, norm: Normalize, marked: Named, rejected: bool) -> None:
    holder = figure.add_subplot(cell)  # type: ignore[call-overload]
    holder.set_axis_off()
    bar = holder.inset_axes((0.02, 0.55, 0.34, 0.16))
    figure.colorbar(ScalarMappable(norm, COLOURS), cax=bar, orientation="horizontal", extend="both")
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


def _words(findings: Findings, off: dict[str, FloatArray]) -> str:
    parts = []
    for when, values in off.items():
        seen = np.abs(values[np.isfinite(values)])
        if len(seen):
            parts.append(f"{when} the extension by {percent(float(np.median(seen)), sign=False)}")
    said = " and ".join(parts) or "by an amount that cannot be told"
    return f"The bridge with its sensors; the median sensor is off {said}."
