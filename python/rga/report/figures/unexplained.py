"""What no kind explains, drawn: where it shows, when, and with which context it goes."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from rga.arrays import FloatArray
from rga.diagnosis.residuals.patterns import Leftover, known_contexts, leftovers
from rga.diagnosis.residuals.slopes import Bend, bends
from rga.diagnosis.search.linearised import Problem
from rga.drawing.figure_style import INK, MEASURED, grid, inline, style
from rga.drawing.label import label
from rga.findings.arrays import DiagnosisArrays
from rga.model.effect import Values
from rga.quantities import DASH, duration, fixed, scale
from rga.report.drawing.bridge_drawing import Shades, draw_at_sensors
from rga.report.drawing.places import Named
from rga.report.figures.bridge import EITHER_WAY
from rga.report.pages.cards import moment

CONTEXTS, STRONGEST = 2, 5
#: ends of the scale of colours
STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
#: correlation from row to row from which on a context runs on, and its points are joined
RUNS_ON = 0.7
EARLY_TO_LATE = LinearSegmentedColormap.from_list("time", ["#9ec9e6", "#0072b2", "#0b2a4a"])


def draw_pattern(
    account: DiagnosisArrays, found: list[Leftover], sensors: tuple[str, ...]
) -> Markup:
    """Every pattern on the bridge: how far each sensor is off, in units of its noise.

    Args:
        account: gives the model and the sensors.
        found: the patterns.
        sensors: those that the patterns are over.
    """
    panels = []
    for number, one in enumerate(found, start=1):
        by_name = dict(zip(sensors, one.pattern, strict=True))
        values = np.array([by_name.get(name, np.nan) for name in account.record.sensors])
        panels.append((f"Pattern {number}" if len(found) > 1 else "", values))
    most = max(float(np.nanmax(np.abs(values))) for _, values in panels)
    top = next((step for step in STEPS if most <= step), STEPS[-1])
    decimals = 1 if top > 1 else 2
    shades = Shades(
        norm=Normalize(-top, top),
        colours=EITHER_WAY,
        text=lambda value: fixed(value, decimals, sign=True) if np.isfinite(value) else DASH,
        longest="+10.0",
        words="root mean square over the noise; signs alike: they move together",
    )
    nothing = Named(frozenset(), frozenset())
    words = "Where sensors move together for reasons unknown."
    return draw_at_sensors(account, nothing, panels, shades, "pattern", words)


def draw_amplitudes(
    found: list[Leftover], time: FloatArray, contexts: Values, follows: float
) -> Markup:
    """The amplitude of every pattern over time, and over the contexts that it goes with most.

    Args:
        found: the patterns.
        time: of the rows [s], float[rows].
        contexts: by name, float[rows] each.
        follows: rank correlation from which on points over a context are joined [-].
    """
    drivers = [list(one.drivers.items())[:CONTEXTS] for one in found]
    return _panels(
        [
            (one.amplitude, {by: correlation > follows for by, correlation in strongest})
            for one, strongest in zip(found, drivers, strict=True)
        ],
        [f"amplitude {number}" if len(found) > 1 else "amplitude" for number in _numbers(found)],
        time,
        contexts,
        "amplitudes",
    )


def draw_bends(found: list[Bend], problem: Problem, units: dict[str, str]) -> Markup:
    """The error that each nonlinear context would need, over time and over what it bends with."""
    contexts = {one.by: problem.data.belief.table[one.by] for one in found}
    return _panels(
        [(one.error, {one.by: True}) for one in found],
        [f"error of {label(one.context)} [{scale(units[one.context], 1)[1]}]" for one in found],
        problem.data.time,
        contexts,
        "bends",
    )


def strongest_rows(one: Leftover, account: DiagnosisArrays, time: FloatArray) -> list[str]:
    """When a pattern is strongest: rows to look up in a log book."""
    order = np.argsort(-np.abs(one.amplitude), kind="stable")[:STRONGEST]
    label_of = account.record.time_label
    return [moment(label_of(float(time[row]) - account.record.origin)) for row in sorted(order)]


def unexplained(account: DiagnosisArrays) -> dict[str, object]:
    """Variables of the template: figures of what is left, and when it is strongest."""
    shown: dict[str, object] = {"pattern": None, "amplitudes": None, "bends": None, "rows": []}
    if account.found is None:
        return shown
    problem = account.found.problem
    contexts = known_contexts(problem, set(account.record.contexts))
    found, bending = leftovers(problem, contexts), bends(account.found.at_fit)
    units = {name: one.unit for name, one in account.model.context.items()}
    if found:
        time = problem.data.time
        shown["pattern"] = draw_pattern(account, found, problem.data.sensors)
        follows = problem.criteria.structure.follows
        shown["amplitudes"] = draw_amplitudes(found, time, contexts, follows)
        shown["rows"] = [
            (number, one.follows, ", ".join(strongest_rows(one, account, time)))
            for number, one in zip(_numbers(found), found, strict=True)
        ]
    if bending:
        shown["bends"] = draw_bends(bending, problem, units)
    return shown


def _numbers(found: list[Leftover]) -> range:
    return range(1, len(found) + 1)


def _panels(
    shown: list[tuple[FloatArray, dict[str, bool]]],
    titles: list[str],
    time: FloatArray,
    contexts: Values,
    name: str,
) -> Markup:
    with style():
        lines, high = len(shown), 1.95 * len(shown) + 0.1
        figure = Figure(figsize=(10.0, high))
        cells = figure.add_gridspec(
            lines, 2 + CONTEXTS, left=0.065, right=0.985, top=1 - 0.15 / high,
            bottom=0.45 / high, hspace=0.55, wspace=0.35,
        )  # fmt: skip
        clock = time - time[0]
        length, unit = duration(float(clock[-1]))
        at = clock * (length / max(float(clock[-1]), 1e-300))
        for line, ((values, drivers), title) in enumerate(zip(shown, titles, strict=True)):
            wide = 2 + CONTEXTS - len(drivers)
            axes = figure.add_subplot(cells[line, :wide])
            axes.plot(at, values, color=MEASURED, lw=0.5, alpha=0.5)
            _dots(axes, at, values, at)
            axes.set_xlabel(f"time since the first row [{unit}]", labelpad=1.5)
            axes.set_ylabel(title, labelpad=1.5)
            for place, (by, joined) in enumerate(drivers.items()):
                axes = figure.add_subplot(cells[line, wide + place])
                column = contexts[by]
                if joined and _runs_on(column):
                    axes.plot(column, values, color=MEASURED, lw=0.4, alpha=0.5)
                _dots(axes, column, values, at)
                axes.set_xlabel(label(by), labelpad=1.5)
        said = "The amplitude over time and over contexts; darker points are later."
        return inline(figure, name, said)


def _dots(axes: Axes, x: FloatArray, y: FloatArray, at: FloatArray) -> None:
    late = (at - at[0]) / max(float(np.ptp(at)), 1e-300)
    # In a few steps: a colour a point would make a large file.
    for step in range(6):
        rows = (late >= step / 6) & ((late < (step + 1) / 6) | (step == 5))
        axes.plot(x[rows], y[rows], ".", color=EARLY_TO_LATE(step / 5), markersize=3.0)
    axes.axhline(0.0, color=INK, lw=0.5)
    grid(axes)


def _runs_on(column: FloatArray) -> bool:
    centred = column - column.mean()
    energy = float((centred**2).sum())
    return energy > 0 and float((centred[1:] * centred[:-1]).sum()) > RUNS_ON * energy
