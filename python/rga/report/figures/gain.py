"""The gain: the gap before and after, block by block and sensor by sensor."""

from itertools import pairwise
from typing import TypeVar

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from rga.arrays import FloatArray
from rga.drawing.figure_style import AFTER, BEFORE, FAINT, INK, STEEL, grid, inline, style
from rga.drawing.label import label
from rga.findings import Findings
from rga.findings.arrays import DiagnosisArrays
from rga.quantities import DASH, duration, number, short
from rga.report.figures.deviation import runs, squares

T = TypeVar("T")
MOST_BLOCKS, FEWEST_BLOCKS, MOST_SENSORS = 12, 6, 40


def draw_gain(findings: Findings) -> Markup | None:
    """Gap per held-out block and per sensor; None where there is nothing to draw."""
    account = findings.account
    split = blocks(account)
    gaps = sorted(findings.gap.by_sensor.items(), key=lambda item: -item[1].before)[:MOST_SENSORS]
    if not split and not gaps:
        return None
    with style():
        high = max(0.165 * max(len(gaps), len(split)) + 1.2, 1.9)
        figure = Figure(figsize=(10.0, high))
        cells = figure.add_gridspec(
            1, 2, left=0.13, right=0.985, top=1 - 0.62 / high, bottom=0.47 / high, wspace=0.3
        )
        if split:
            axes = figure.add_subplot(cells[0])
            _blocks(axes, account, split, findings.gap.noise_floor)
            axes.set_title("By block of rows that no step saw")
        if gaps:
            axes = figure.add_subplot(cells[1])
            values = np.array([[gap.before, gap.after] for _, gap in gaps])
            names = [label(name, 18) for name, _ in gaps]
            dumbbells(axes, values, names, findings.gap.noise_floor)
            axes.set_title("By sensor, all rows")
        figure.legend(
            handles=[
                Line2D([], [], ls="", marker="^", markersize=5, color=BEFORE, label="before"),
                Line2D([], [], ls="", marker="o", markersize=5, color=AFTER, label="after"),
            ],
            loc="upper center",
            ncols=2,
        )
        held = findings.gap.held_out
        words = f"Gap by held-out rows: {number(held.before)} before, {number(held.after)} after."
        return inline(figure, "gain", words)


def blocks(account: DiagnosisArrays) -> list[tuple[int, int]]:
    """Stretches of held-out rows, long ones split and many ones joined."""
    found = runs(account.held_out)
    if not found:
        return []
    if len(found) > MOST_BLOCKS:
        return [(part[0][0], part[-1][1]) for part in _parts(found, MOST_BLOCKS)]
    pieces = -(-FEWEST_BLOCKS // len(found))
    return [
        (part[0], part[-1])
        for a, b in found
        for part in _parts(list(range(a, b + 1)), pieces)
        if part
    ]


def _parts(items: list[T], count: int) -> list[list[T]]:
    edges = np.linspace(0, len(items), min(count, len(items)) + 1).round().astype(int)
    return [items[a:b] for a, b in pairwise(edges)]


def _blocks(
    axes: Axes, account: DiagnosisArrays, split: list[tuple[int, int]], floor: float
) -> None:
    both = [squares(account, simulated) for simulated in (account.before, account.after)]
    held = account.held_out
    values = np.array([[_mean(s[a : b + 1][held[a : b + 1]]) for s in both] for a, b in split])
    time = account.record.time - account.record.time[0]
    length, unit = duration(float(time[-1]))
    factor = length / float(time[-1]) if time[-1] > 0 else 1.0
    names = [f"{short(factor * time[a])} {DASH} {short(factor * time[b])} {unit}" for a, b in split]
    dumbbells(axes, values, names, floor)


def dumbbells(
    axes: Axes,
    values: FloatArray,
    names: list[str],
    floor: float,
    colours: tuple[str, str] = (BEFORE, AFTER),
) -> None:
    """Pairs of values, float[rows, 2], on a logarithmic axis; the first row on top."""
    place = np.arange(len(names))[::-1]
    bottom = _least(values, floor)
    shown = np.maximum(values, bottom)
    axes.set_xscale("log")
    axes.hlines(place, shown[:, 0], shown[:, 1], color=FAINT, lw=2.2)
    axes.plot(shown[:, 0], place, "^", color=colours[0], markersize=4.6)
    axes.plot(shown[:, 1], place, "o", color=colours[1], markersize=4.6)
    axes.axvline(floor, color=INK, lw=0.8, dashes=(3, 2), zorder=0)
    axes.set_yticks(place, names, fontsize=7)
    axes.set_ylim(-0.7, len(names) - 0.3)
    axes.tick_params(axis="y", length=0, colors=STEEL, labelcolor=INK)
    axes.set_xlabel("gap [-]   (dashed: noise alone)")
    _logarithmic(axes, bottom, values)
    grid(axes, "x")


def _mean(values: FloatArray) -> float:
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else float("nan")


def _least(values: FloatArray, floor: float) -> float:
    """Where a logarithmic axis begins: a little below the least value or the noise."""
    seen = values[np.isfinite(values) & (values > 0)]
    return 0.6 * float(min([floor or 1.0, *np.maximum(seen, 1e-3 * (floor or 1.0))]))


def _logarithmic(axes: Axes, bottom: float, values: FloatArray) -> None:
    # The usual labels of a logarithmic axis are mathtext, which is off for the sake of odd names.
    top = 1.5 * max([4 * bottom, *values[np.isfinite(values)]])
    axes.set_xlim(bottom, top)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))
    # Less than two decades have too few powers of ten to read from.
    few = top / bottom < 100
    axes.xaxis.set_minor_formatter(FuncFormatter(_minor) if few else NullFormatter())
    axes.xaxis.set_tick_params(which="minor", labelsize=7)


def _minor(value: float, _: object) -> str:
    return short(value) if f"{value:.0e}"[0] in "25" else ""
