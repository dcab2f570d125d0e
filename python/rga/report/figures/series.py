"""Measured against simulated readings: small multiples over time, or one against the other."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rga.arrays import FloatArray
from rga.drawing.figure_style import AFTER, BEFORE, FAINT, MEASURED, grid, inline, style
from rga.drawing.label import label
from rga.findings import Findings
from rga.findings.arrays import DiagnosisArrays
from rga.quantities import duration, scale
from rga.report.figures.deviation import runs

COLUMNS = 3
MOST_IMPROVED, WORST_LEFT = 8, 4
MOST_POINTS, MOST_DOTS = 500, 240


def draw_series(findings: Findings) -> tuple[Markup, bool] | None:
    """Small multiples of chosen sensors, and whether they run over time; None without sensors."""
    account = findings.account
    columns = chosen(findings)
    if not columns or not len(account.record):
        return None
    smooth = runs_on(account)
    with style():
        wide = min(COLUMNS, len(columns))
        rows = -(-len(columns) // wide)
        high = 1.75 if smooth else 2.6
        top = 0.45
        figure = Figure(figsize=(10.0, rows * high + top))
        cells = figure.add_gridspec(
            rows, wide, left=0.065, right=0.985, top=1 - (top + 0.25) / (rows * high + top),
            bottom=0.47 / (rows * high + top), hspace=0.42, wspace=0.27,
        )  # fmt: skip
        for place, column in enumerate(columns):
            axes = figure.add_subplot(cells[place // wide, place % wide])
            if smooth:
                _over_time(axes, account, column)
                if place + wide >= len(columns):
                    axes.set_xlabel(_time(account)[1])
            else:
                _against(axes, account, column)
        figure.legend(handles=_key(account, smooth), loc="upper center", ncols=4)
        names = ", ".join(label(account.record.sensors[column]) for column in columns)
        how = "over time" if smooth else "against each other"
        return inline(figure, "series", f"Measured and simulated readings {how}: {names}."), smooth


def chosen(findings: Findings) -> list[int]:
    """Sensors to show: those that improve most, and of the others those that stay worst."""
    account = findings.account
    working = [c for c in range(len(account.record.sensors)) if not account.rejected[c]]
    working = [c for c in working if np.isfinite(account.record.readings[:, c]).any()]
    gaps = {c: findings.gap.by_sensor.get(account.record.sensors[c]) for c in working}
    gain = {c: gap.before - gap.after if gap else 0.0 for c, gap in gaps.items()}
    left = {c: gap.after if gap else 0.0 for c, gap in gaps.items()}
    most = sorted(working, key=lambda c: -gain[c])
    best = most[:MOST_IMPROVED]
    worst = sorted((c for c in working if c not in best), key=lambda c: -left[c])[:WORST_LEFT]
    return sorted(best + worst)


def runs_on(account: DiagnosisArrays) -> bool:
    """Whether the simulation is smooth from row to row (lag-one correlation, median of sensors)."""
    if len(account.record) < 8:
        return False
    found = []
    for series in account.after.T[~account.rejected]:
        now = series[np.isfinite(series)]
        now = now - now.mean() if len(now) else now
        energy = (now**2).sum()
        if energy > 0:
            found.append(float((now[1:] * now[:-1]).sum() / energy))
    return bool(found) and float(np.median(found)) > 0.7


def _unit(account: DiagnosisArrays, column: int) -> tuple[float, str]:
    name = account.record.sensors[column]
    unit = account.model.sensors[name].unit if name in account.model.sensors else ""
    readings = np.abs(account.record.readings[:, column])
    largest = float(np.nanmax(readings)) if np.isfinite(readings).any() else 1.0
    return scale(unit, largest)


def _time(account: DiagnosisArrays) -> tuple[FloatArray, str]:
    time = account.record.time - account.record.time[0]
    length, unit = duration(float(time[-1]))
    factor = length / float(time[-1]) if time[-1] > 0 else 1.0
    return time * factor, f"time since the first row [{unit}]"


def _thin(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fewer points, with the smallest and the largest of every stretch: peaks stay."""
    if len(y) <= MOST_POINTS:
        return x, y
    keep: set[int] = set()
    for rows in np.array_split(np.arange(len(y)), MOST_POINTS // 2):
        part = y[rows]
        keep |= {int(rows[0])} if np.isnan(part).all() else {
            int(rows[np.nanargmin(part)]), int(rows[np.nanargmax(part)])
        }  # fmt: skip
    order = np.array(sorted(keep))
    return x[order], y[order]


def _over_time(axes: Axes, account: DiagnosisArrays, column: int) -> None:
    factor, unit = _unit(account, column)
    time, _ = _time(account)
    stretches = runs(account.held_out)
    if len(stretches) <= 40:
        half = np.median(np.diff(time)) / 2 if len(time) > 1 else 0.5
        for first, last in stretches:
            axes.axvspan(time[first] - half, time[last] + half, color=FAINT, alpha=0.45, lw=0)
    few = len(time) <= 400
    measured = account.record.readings[:, column] * factor
    look = {"lw": 0, "marker": ".", "markersize": 2.6} if few else {"lw": 2.2, "alpha": 0.4}
    axes.plot(*_thin(time, measured), color=MEASURED, **look)
    axes.plot(
        *_thin(time, account.before[:, column] * factor), color=BEFORE, lw=0.9, dashes=(4, 1.6)
    )
    axes.plot(*_thin(time, account.after[:, column] * factor), color=AFTER, lw=1.1)
    axes.set_xlim(time[0], time[-1] if time[-1] > time[0] else time[0] + 1)
    axes.margins(y=0.08)
    grid(axes, "y")
    axes.set_title(f"{label(account.record.sensors[column])} [{unit}]")


def _against(axes: Axes, account: DiagnosisArrays, column: int) -> None:
    factor, unit = _unit(account, column)
    measured = account.record.readings[:, column] * factor
    thin = np.linspace(0, len(measured) - 1, min(len(measured), MOST_DOTS)).round().astype(int)
    every = [account.before[:, column] * factor, account.after[:, column] * factor, measured]
    finite = np.concatenate([values[np.isfinite(values)] for values in every])
    low, high = float(finite.min()), float(finite.max())
    edge = 0.06 * (high - low) or 1.0
    axes.plot(
        [low - edge, high + edge], [low - edge, high + edge], color=MEASURED, lw=0.7, zorder=1
    )
    for simulated, colour, shape in ((every[0], BEFORE, "^"), (every[1], AFTER, "o")):
        for rows, depth in ((~account.held_out, 0.22), (account.held_out, 0.85)):
            x, y = (np.where(rows, values, np.nan)[thin] for values in (simulated, measured))
            axes.plot(x, y, shape, color=colour, markersize=2.7, alpha=depth, mew=0)
    axes.set(xlim=(low - edge, high + edge), ylim=(low - edge, high + edge))
    axes.set_box_aspect(0.82)
    grid(axes)
    axes.set_title(label(account.record.sensors[column]))
    axes.set_xlabel(f"simulated [{unit}]", labelpad=1.5)
    axes.set_ylabel(f"measured [{unit}]", labelpad=1.5)


def _key(account: DiagnosisArrays, smooth: bool) -> list[Line2D | Patch]:
    if smooth:
        few = len(account.record) <= 400
        look = {"lw": 0, "marker": "."} if few else {"lw": 2.2, "alpha": 0.4}
        return [
            Line2D([], [], color=MEASURED, label="measured", **look),
            Line2D([], [], color=BEFORE, lw=1, dashes=(4, 1.6), label="simulated before"),
            Line2D([], [], color=AFTER, lw=1.2, label="simulated after"),
            Patch(color=FAINT, alpha=0.6, label="rows that no step saw"),
        ]
    return [
        Line2D([], [], ls="", color=BEFORE, marker="^", markersize=4, label="before"),
        Line2D([], [], ls="", color=AFTER, marker="o", markersize=4, label="after"),
        Line2D([], [], color=MEASURED, lw=0.8, label="measured = simulated"),
        Patch(color=AFTER, alpha=0.25, label="pale: rows that the diagnosis used"),
    ]
