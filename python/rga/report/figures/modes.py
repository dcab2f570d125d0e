"""Modes drawn on the structure, computed lines and measured dots, and their frequencies.

These stand over time, and over what the weather is.
"""

from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rga.arrays import FloatArray, IntArray
from rga.drawing.figure_style import AFTER, BEFORE, FAINT, MEASURED, grid, inline, style
from rga.drawing.scene.scene import Scene, make_scene
from rga.drawing.views import View, axonometry
from rga.findings.modal_arrays import ModalArrays, ModeReading
from rga.quantities import percent

#: modes that are drawn, and the largest motion over the size of the structure
MOST, LARGEST = 10, 0.09
#: windows from which on frequencies are drawn over time
SOME = 3
COLUMNS = 2
#: windows from which on they are drawn as a picture: a report must open
MANY = 5000


def draw_shapes(account: ModalArrays) -> Markup:
    """Every mode before and after, with what was measured at the points."""
    scene = make_scene(account.model)
    view = axonometry(scene)
    modes = account.modes[:MOST]
    wide, high = np.ptp(view.flat(scene.points), axis=0)
    each = float(np.clip(4.8 * high / max(wide, 1e-9), 1.0, 3.4)) + 0.35
    top = 0.4
    with style():
        tall = each * len(modes) + top
        figure = Figure(figsize=(10.0, tall))
        cells = figure.add_gridspec(
            len(modes), COLUMNS, left=0.01, right=0.99, top=1 - top / tall, bottom=0.01,
            hspace=0.08, wspace=0.03,
        )  # fmt: skip
        for row, mode in enumerate(modes):
            for column, colour in enumerate((BEFORE, AFTER)):
                axes = figure.add_subplot(cells[row, column])
                _mode(axes, (account, scene, view), mode, column, colour)
        handles = [
            Line2D([], [], color=FAINT, label="at rest"),
            Line2D([], [], color=BEFORE, label="simulated before"),
            Line2D([], [], color=AFTER, label="simulated after"),
            Line2D([], [], color=MEASURED, marker="o", ls="", ms=4, label="measured"),
        ]
        figure.legend(handles=handles, loc="upper center", ncols=4)
        names = ", ".join(mode.name for mode in modes)
        return inline(figure, "shapes", f"Shapes of the modes {names}, before and after.")


def _mode(
    axes: Axes,
    drawn: tuple[ModalArrays, Scene, View],
    mode: ModeReading,
    column: int,
    colour: str,
) -> None:
    account, scene, view = drawn
    model = account.model
    shape = mode.shapes[column]
    at = np.array([scene.nodes[model.points[name].node] for name in mode.points], dtype=np.int64)
    axis = np.array([model.points[name].direction for name in mode.points], dtype=float)
    axis = axis.reshape(-1, 3) / np.linalg.norm(axis.reshape(-1, 3), axis=1, keepdims=True)
    size = float(np.ptp(scene.points, axis=0).max()) * LARGEST
    size /= max(float(np.abs(shape).max()), 1e-300)
    moved = scene.points[: len(shape)] + shape * size
    for places, shade, width in ((scene.points, FAINT, 0.5), (moved, colour, 0.9)):
        axes.plot(*_lines(view.flat(places), scene.ends), color=shade, lw=width)
    if len(at):
        computed = (shape[at] * axis).sum(1)
        # To the scale of the computed shape: by what both have in common (least squares).
        length = float(mode.shape @ mode.shape)
        factor = float(mode.shape @ computed) / length if length > 0 else 0.0
        # Along axes that nobody measured a node is where it is computed.
        measured = shape.copy()
        np.add.at(measured, at, axis * (mode.shape * factor - computed)[:, None])
        own = np.unique(at)
        axes.plot(*view.flat(scene.points[own] + measured[own] * size).T, ".", color=MEASURED, ms=3)
    ends_of = ("before", "after")
    off = np.expm1(np.nanmean(mode.log_f - (mode.before, mode.after)[column]))
    alike = mode.mac[column]
    words = (
        f"{mode.name} {ends_of[column]}: computed mode {mode.number[column]}, {percent(100 * off)}"
    )
    words += f", MAC {alike:.2f}" if np.isfinite(alike) else ", by frequency only"
    axes.set_title(words, fontsize=8.5, loc="left", pad=2)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.02)
    axes.axis("off")


def _lines(points: FloatArray, ends: IntArray) -> tuple[FloatArray, FloatArray]:
    """Coordinates of lines between points, one path with gaps."""
    both = points[ends]
    gaps = np.full((len(ends), 1, 2), np.nan)
    x, y = np.concatenate([both, gaps], axis=1).reshape(-1, 2).T
    return x, y


def draw_frequencies(account: ModalArrays) -> Markup | None:
    """Frequencies over time: measured, and simulated before and after; None of few windows."""
    if len(account.time) < SOME:
        return None
    factor, unit = _time_scale(account.time)
    time = (account.time - account.time[0]) / factor
    return _frequencies_over(account, time, f"time [{unit}]", "frequencies")


def draw_over_weather(account: ModalArrays) -> dict[str, Markup]:
    """The same over contexts that may move modes and were not the same in all windows, by name."""
    found = {}
    for number, (name, column) in enumerate(account.weather.items()):
        if len(account.time) >= SOME and np.ptp(column) > 0:
            label = f"{name} [{account.model.context[name].unit}]"
            figure = f"frequencies-{number}"
            found[name] = _frequencies_over(account, column, label, figure, dots=True)
    return found


def _frequencies_over(
    account: ModalArrays, along: FloatArray, label: str, name: str, *, dots: bool = False
) -> Markup:
    """Frequencies over what is the same for all modes, float[windows]; simulated as line or dots.

    Over a context there may be several: others move the modes as well, and some causes begin late.
    """
    modes = account.modes[:MOST]
    rows = -(-len(modes) // COLUMNS)
    simulated: dict[str, Any] = {"ls": "", "marker": ".", "ms": 2.5} if dots else {"lw": 1.2}
    many = len(along) > MANY
    simulated |= {"rasterized": many}
    with style():
        tall = 1.9 * rows + 0.6
        figure = Figure(figsize=(10.0, tall))
        cells = figure.add_gridspec(
            rows, COLUMNS, left=0.07, right=0.985, top=1 - 0.65 / tall, bottom=0.5 / tall,
            hspace=0.5, wspace=0.2,
        )  # fmt: skip
        for place, mode in enumerate(modes):
            axes = figure.add_subplot(cells[place // COLUMNS, place % COLUMNS])
            axes.plot(along, _hertz(mode.log_f), ".", color=MEASURED, ms=3, rasterized=many)
            axes.plot(along, _hertz(mode.before), color=BEFORE, **simulated)
            axes.plot(along, _hertz(mode.after), color=AFTER, **simulated)
            axes.set_title(f"{mode.name} [Hz]", fontsize=8.5, loc="left", pad=2)
            grid(axes)
            if place + COLUMNS >= len(modes):
                axes.set_xlabel(label)
        handles = [
            Line2D([], [], color=MEASURED, marker=".", ls="", label="measured"),
            Line2D([], [], color=BEFORE, label="simulated before", **simulated),
            Line2D([], [], color=AFTER, label="simulated after", **simulated),
        ]
        figure.legend(handles=handles, loc="upper center", ncols=3)
        over = label.partition(" [")[0]
        return inline(figure, name, f"Natural frequencies over {over}.")


def _hertz(log_f: FloatArray) -> FloatArray:
    return np.asarray(np.exp(log_f))


def _time_scale(time: FloatArray) -> tuple[float, str]:
    span = float(np.ptp(time))
    for factor, unit in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if span >= 2 * factor:
            return factor, unit
    return 1.0, "s"
