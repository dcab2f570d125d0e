"""The gain: the gap before and after, block by block and sensor by sensor."""

from itertools import pairwise
from typing import TypeVar

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from rga.diagnosis.account import Account
from rga.diagnosis.findings import Findings
from rga.model.parameter import FloatArray
from rga.report.deviation import runs, squares
from rga.report.quantities import DASH, duration, number
from rga.report.svg import AFTER, BEFORE, FAINT, INK, STEEL, grid, inline, label, style

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
        figure = Figure(figsize=(10.0, max(2.9, 0.165 * len(gaps) + 1.1)))
        high = figure.get_figheight()
        cells = figure.add_gridspec(
            1, 2, left=0.07, right=0.985, top=1 - 0.35 / high, bottom=0.5 / high, wspace=0.33
        )
        if split:
            _blocks(figure.add_subplot(cells[0]), account, split, findings.gap.noise_floor)
        if gaps:
            axes = figure.add_subplot(cells[1])
            values = np.array([[gap.before, gap.after] for _, gap in gaps])
            dumbbells(axes, values, [label(name, 18) for name, _ in gaps], findings.gap.noise_floor)
            axes.set_title("By sensor, all rows")
            axes.set_xlabel("gap [-]")
        held = findings.gap.held_out
        words = f"Gap on held-out rows: {number(held.before)} before, {number(held.after)} after."
        return inline(figure, "gain", words)


def blocks(account: Account) -> list[tuple[int, int]]:
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


def _blocks(axes: Axes, account: Account, split: list[tuple[int, int]], floor: float) -> None:
    both = [squares(account, simulated) for simulated in (account.before, account.after)]
    values = np.array(
        [[_mean(s[a : b + 1][account.held_out[a : b + 1]]) for s in both] for a, b in split]
    )
    time = account.record.time - account.record.time[0]
    length, unit = duration(float(time[-1]))
    factor = length / float(time[-1]) if time[-1] > 0 else 1.0
    place = np.arange(len(split))
    bottom = _least(values, floor)
    axes.set_yscale("log")
    for turn, (colour, name) in enumerate(((BEFORE, "before"), (AFTER, "after"))):
        high = np.maximum(values[:, turn], bottom) - bottom
        axes.bar(place + 0.38 * (turn - 0.5), high, 0.34, bottom=bottom, color=colour, label=name)
    axes.axhline(floor, color=INK, lw=0.8, dashes=(3, 2))
    axes.text(len(split) - 0.45, floor, " noise", fontsize=7, va="bottom", ha="right", color=INK)
    axes.set_xticks(place, [_tick(factor * time[a], factor * time[b]) for a, b in split])
    if len(split) > 4:
        for text in axes.get_xticklabels():
            text.set(rotation=30, ha="right", rotation_mode="anchor")
    axes.tick_params(axis="x", labelsize=6.8, length=0)
    _plain(axes, "y", bottom, values)
    grid(axes, "y")
    axes.set_title("By block of rows that no step saw")
    axes.set_ylabel("gap [-]")
    axes.set_xlabel(f"rows, from {DASH} to [{unit}]")
    axes.legend(loc="upper right", ncols=2, bbox_to_anchor=(1.0, 1.16), handlelength=1.0)


def dumbbells(axes: Axes, values: FloatArray, names: list[str], floor: float) -> None:
    """Pairs of values [rows, before/after] on a logarithmic axis, the first on top."""
    place = np.arange(len(names))[::-1]
    bottom = _least(values, floor)
    shown = np.maximum(values, bottom)
    axes.set_xscale("log")
    axes.hlines(place, shown[:, 0], shown[:, 1], color=FAINT, lw=2.2)
    axes.plot(shown[:, 0], place, "^", color=BEFORE, markersize=4.6)
    axes.plot(shown[:, 1], place, "o", color=AFTER, markersize=4.6)
    axes.axvline(floor, color=INK, lw=0.8, dashes=(3, 2), zorder=0)
    axes.set_yticks(place, names, fontsize=7)
    axes.set_ylim(-0.7, len(names) - 0.3)
    axes.tick_params(axis="y", length=0, colors=STEEL, labelcolor=INK)
    _plain(axes, "x", bottom, values)
    grid(axes, "x")


def _tick(first: float, last: float) -> str:
    return f"{number(first)}{DASH}{number(last)}"


def _mean(values: FloatArray) -> float:
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else float("nan")


def _least(values: FloatArray, floor: float) -> float:
    """Where a logarithmic axis begins: a little below the least value or the noise."""
    seen = values[np.isfinite(values) & (values > 0)]
    return 0.6 * float(min([floor or 1.0, *np.maximum(seen, 1e-3 * (floor or 1.0))]))


def _plain(axes: Axes, which: str, bottom: float, values: FloatArray) -> None:
    # The usual labels of a logarithmic axis are mathtext, which is off for the sake of odd names.
    seen = values[np.isfinite(values)]
    top = 1.5 * max([4 * bottom, *seen])
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xlim if which == "x" else axes.set_ylim)(bottom, top)
    axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
    # Less than two decades have too few powers of ten to read from.
    few = top / bottom < 100
    axis.set_minor_formatter(FuncFormatter(_minor) if few else NullFormatter())
    axis.set_tick_params(which="minor", labelsize=7)


def _minor(value: float, _: object) -> str:
    return number(value) if f"{value:.0e}"[0] in "25" else ""
