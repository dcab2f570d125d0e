"""The bridge in the phases of a run, every sensor coloured by its gap."""

from collections.abc import Sequence

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rga.arrays import FloatArray
from rga.drawing.figure_style import INK, STEEL, inline, style
from rga.drawing.label import label
from rga.drawing.projection import Projection, views
from rga.quantities import number
from rga.report.drawing.bridge_drawing import MARKERS
from rga.report.drawing.labels import marker_offset, marker_row, place_labels
from rga.report.drawing.places import Spot, spots
from rga.report.figures.gap_colours import GapColours, gap_colours
from rga.report.figures.of_run.run_gap import Phase, mean, phases, standardised, usual
from rga.twin.history import History

WIDTH, COLUMNS = 10.0, 2
TITLE, BELOW, ABOVE, KEY = 0.24, 0.6, 0.55, 0.7  # inches
#: sensors that are named in each phase, if their gap is worth it
NAMED, WORTH_NAMING = 3, 3.0


def draw_phases(history: History) -> Markup | None:
    """Every view of the bridge in every phase; None where no gap is known."""
    gaps = standardised(history)
    if not np.isfinite(gaps).any():
        return None
    drawn = _with_sensors(history, views(history.model, set()))
    looked_at = phases(history)
    values = np.array([mean(gaps[phase.first : phase.last], axis=0) for phase in looked_at])
    colours = gap_colours(gaps)
    room = WIDTH / COLUMNS - 0.3
    cells = [(p, v) for p in range(len(looked_at)) for v in range(len(drawn))]
    units = [_unit(history, view, room) for view, _ in drawn]
    tall = [_extent(history, view)[1] / unit for (view, _), unit in zip(drawn, units, strict=True)]
    # A phase begins a line of its own, unless it fills half a line only.
    lines = [cells[i : i + COLUMNS] for i in range(0, len(cells), COLUMNS)]
    if len(drawn) % COLUMNS and len(drawn) > 1:
        each = [[cell for cell in cells if cell[0] == p] for p in range(len(looked_at))]
        lines = [one[i : i + COLUMNS] for one in each for i in range(0, len(one), COLUMNS)]
    heights = [TITLE + ABOVE + BELOW + max(tall[view] for _, view in line) for line in lines]
    high = sum(heights) + KEY
    with style():
        figure = Figure(figsize=(WIDTH, high))
        top = high
        for line, height in zip(lines, heights, strict=True):
            for column, (p, v) in enumerate(line):
                (view, here), unit = drawn[v], units[v]
                left = 0.15 + column * WIDTH / COLUMNS
                body = ABOVE + BELOW + tall[v]
                axes = figure.add_axes(
                    (left / WIDTH, (top - TITLE - body) / high, room / WIDTH, body / high)
                )
                low, _ = _corner(history, view)
                axes.set_axis_off()
                axes.set_xlim(low[0] - 0.3 * unit, low[0] + (room - 0.3) * unit)
                axes.set_ylim(low[1] - BELOW * unit, low[1] + (tall[v] + ABOVE) * unit)
                _bridge(axes, history, view, here, values[p], colours, unit)
                said = _title(looked_at[p], gaps) if v == 0 else ""
                title = view.title if len(drawn) > 1 else ""
                where = (left / WIDTH, (top - 0.06) / high)
                figure.text(*where, said, fontsize=8.5, va="top", weight="bold")
                if title:
                    where = (left / WIDTH, (top - 0.06 - 0.15) / high)
                    figure.text(*where, title, fontsize=7, va="top", color="#57606a")
            top -= height
        colours.key(figure.add_axes((0.02, 0.44 / high, 0.46, 0.12 / high)))
        worst = number(float(np.nanmax(values)), 2) if np.isfinite(values).any() else "not known"
        words = ", ".join(phase.title for phase in looked_at)
        return inline(
            figure,
            "phases",
            f"The structure and the gap of its sensors: {words}; at most {worst}.",
        )


def _title(phase: Phase, gaps: FloatArray) -> str:
    rows = phase.last - phase.first
    gap = number(usual(mean(gaps[phase.first : phase.last], axis=1)), 2)
    return f"{phase.title}: gap {gap} over {rows} row{'s' if rows > 1 else ''}"


def _with_sensors(
    history: History, drawn: Sequence[Projection]
) -> list[tuple[Projection, list[Spot]]]:
    """Views with the spots of their sensors; each sensor in the first view that holds it."""
    model = history.model
    taken: set[int] = set()
    found = []
    for view in drawn:
        sensors = {
            column: name
            for column, name in enumerate(history.record.sensors)
            if column not in taken and name in model.sensors and view.holds(model.sensors[name])
        }
        taken |= set(sensors)
        if sensors:
            found.append((view, spots(model, view, sensors)))
    return found


def _corner(history: History, view: Projection) -> tuple[FloatArray, FloatArray]:
    points = np.array([history.model.nodes[node] for node in sorted(view.nodes)])
    points = points[:, list(view.axes)]
    return points.min(axis=0), points.max(axis=0)


def _extent(history: History, view: Projection) -> FloatArray:
    low, high = _corner(history, view)
    return high - low


def _unit(history: History, view: Projection, room: float) -> float:
    wide, tall = _extent(history, view)
    return float(max(wide, tall / 0.5, 1e-9)) / (room - 0.7)


def _bridge(
    axes: Axes, history: History, view: Projection, here: list[Spot], gaps: FloatArray,
    colours: GapColours, unit: float,
) -> None:  # fmt: skip
    model, sensors = history.model, history.record.sensors
    gauges = {spot.member: mean(gaps[spot.sensors]) for spot in here if spot.member is not None}
    for name in view.members:
        ends = [model.nodes[node] for node in model.members[name].nodes]
        x, y = ([end[axis] for end in ends] for axis in view.axes)
        gap = float(gauges.get(name, np.nan))
        look = (colours.colour(gap), 2.6, 3) if np.isfinite(gap) else (STEEL, 0.7, 2)
        axes.plot(x, y, color=look[0], linewidth=look[1], zorder=look[2])
    for spot in here:
        height = spot.y + marker_offset(spot) * unit
        for place, column in enumerate(spot.sensors):
            along = spot.x + (0.11 * place - marker_row(spot)) * unit
            shape = MARKERS[model.sensors[sensors[column]].kind]
            face = colours.colour(float(gaps[column]))
            axes.plot(along, height, shape, mfc=face, mec=INK, mew=0.5, markersize=5, zorder=5)
    _name_worst(axes, sensors, here, gaps, unit)


def _name_worst(
    axes: Axes, sensors: Sequence[str], here: list[Spot], gaps: FloatArray, unit: float
) -> None:
    columns = [column for spot in here for column in spot.sensors if gaps[column] > WORTH_NAMING]
    worst = sorted(columns, key=lambda column: -gaps[column])[:NAMED]

    def text(spot: Spot, names: bool) -> list[str]:
        values = {column: number(float(gaps[column]), 2) for column in spot.sensors}
        return [
            f"{label(sensors[column], 14)} {values[column]}" if names else values[column]
            for column in spot.sensors
            if column in worst
        ]

    marked = [spot for spot in here if set(spot.sensors) & set(worst)]
    sides = {"below": ("center", "top"), "above": ("center", "bottom"), "right": ("left", "center")}
    others = [spot for spot in here if spot not in marked]
    marks = [(spot.x, spot.y + (marker_offset(spot) + 0.07) * unit) for spot in others]
    for spot, place in zip(marked, place_labels(marked, unit, text, marks), strict=True):
        if place is None:
            continue
        horizontal, vertical = sides[spot.side]
        x, y = spot.x + place.x * unit, spot.y + place.y * unit
        if place.far:
            height = spot.y + marker_offset(spot) * unit
            axes.plot([spot.x, x], [height, y], color=STEEL, lw=0.5, zorder=4)
        axes.text(
            x, y, "\n".join(text(spot, place.names)),
            fontsize=6.6, ha=horizontal, va=vertical, zorder=7, linespacing=1.05,
            bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.4},
        )  # fmt: skip
