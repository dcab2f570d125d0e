"""The gap over the run, with all that happened to the twin."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from rga.arrays import FloatArray
from rga.drawing.figure_style import AFTER, BEFORE, FAINT, INK, STEEL, grid, inline, style
from rga.drawing.label import label
from rga.drawing.labels import LETTER
from rga.drawing.time_axis import TimeAxis, spaced, thinned, time_axis
from rga.quantities import number, short
from rga.report.figures.of_run.run_gap import (
    mean,
    row_of,
    smoothed,
    standardised,
    version_number,
    window,
)
from rga.twin.history import Event, History

WIDTH, LEFT, RIGHT = 10.0, 0.115, 0.985
LANE, HIGH = 0.2, 2.9  # inches
MOST_POINTS, MOST_PEAKS, MOST_MARKS = 900, 20, 300
#: names that an alarm shows beside its mark
MOST_NAMES = 2


class Look(NamedTuple):
    """How a kind of event is drawn: in its lane, and as a line across the gap."""

    said: str
    colour: str
    shape: str
    across: bool


LOOKS = {
    "alarm": Look("alarm", BEFORE, "v", True),
    "recall": Look("as it was before", "#56b4e9", "^", True),
    "recalibration": Look("recalibrated", AFTER, "o", True),
    "diagnosis": Look("diagnosis", INK, "D", False),
    "version": Look("new version", "#009e73", "s", True),
    "rollback": Look("went back", "#a0447f", "X", True),
    "proposal": Look("proposal", "#009e73", "d", False),
    "command": Look("command", INK, "P", False),
    "novel context": Look("novel context", "#9a6b00", "|", False),
}


def draw_timeline(history: History) -> Markup | None:
    """Gap over time below lanes of events; None where there is neither."""
    by_row = mean(standardised(history), axis=1)
    lanes = [kind for kind in LOOKS if any(event.kind == kind for event in history.events)]
    if not len(history.record) or not (lanes or np.isfinite(by_row).any()):
        return None
    time = time_axis(history.record)
    top, bottom = 0.36, 0.5
    high = top + LANE * len(lanes) + 0.05 + HIGH + bottom
    with style():
        figure = Figure(figsize=(WIDTH, high))
        wide = RIGHT - LEFT
        axes = figure.add_axes((LEFT, bottom / high, wide, HIGH / high))
        _gap(axes, history, by_row, time)
        if lanes:
            place = (LEFT, 1 - (top + LANE * len(lanes)) / high, wide, LANE * len(lanes) / high)
            _lanes(figure.add_axes(place), history, lanes, time)
        figure.legend(handles=_key(history), loc="upper right", ncols=4)
        return inline(figure, "timeline", _words(history, by_row))


def _gap(axes: Axes, history: History, by_row: FloatArray, time: TimeAxis) -> None:
    line = smoothed(history, by_row)
    if history.calibration_rows:
        last = min(history.calibration_rows, len(by_row)) - 1
        axes.axvspan(time.ends[0], time.at[last] + time.step / 2, color=FAINT, alpha=0.5, lw=0)
    for kind, look in LOOKS.items():
        rows = sorted({row_of(history, e) for e in history.events if e.kind == kind})
        if look.across and len(rows) <= MOST_MARKS:
            for row in rows:
                axes.axvline(time.at[row], color=look.colour, lw=0.8, alpha=0.7, zorder=1.5)
    low, high = _range(by_row, line)
    # All would make the page heavy; the largest are never left out.
    largest = np.argsort(np.nan_to_num(by_row), kind="stable")[-MOST_PEAKS:]
    raw = np.union1d(spaced(len(by_row), MOST_POINTS), largest)
    with np.errstate(invalid="ignore"):
        shown = np.maximum(by_row[raw], low)
    axes.plot(time.at[raw], shown, ".", color=STEEL, markersize=3.4, alpha=0.7, mew=0)
    seen = thinned(line, MOST_POINTS)
    axes.plot(time.at[seen], line[seen], color=INK, lw=1.3, zorder=3)
    axes.axhline(1.0, color=INK, lw=0.8, dashes=(3, 2), zorder=1)
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    few = high / low < 100
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("gap, mean over sensors [-]")
    grid(axes, "y")
    time.dress(axes)


def _range(by_row: FloatArray, line: FloatArray) -> tuple[float, float]:
    seen = by_row[np.isfinite(by_row) & (by_row > 0)]
    if not len(seen):
        return 0.1, 10.0
    # A few rows that happen to fit well would take up half of the axis.
    least = min(float(np.quantile(seen, 0.01)), float(np.nanmin(line)) or 1.0)
    return 0.8 * min(max(least, 1e-3), 0.8), 1.4 * max(float(seen.max()), 2.0)


def _lanes(axes: Axes, history: History, lanes: Sequence[str], time: TimeAxis) -> None:
    axes.set_ylim(len(lanes) - 0.5, -0.5)
    time.dress(axes, labelled=False)
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="both", length=0)
    axes.set_yticks(range(len(lanes)), [LOOKS[kind].said for kind in lanes])
    for tick, kind in zip(axes.get_yticklabels(), lanes, strict=True):
        tick.set_color(LOOKS[kind].colour)
    for lane, kind in enumerate(lanes):
        axes.axhline(lane, color=FAINT, lw=0.6, zorder=0)
        look = LOOKS[kind]
        events = sorted(
            (event for event in history.events if event.kind == kind),
            key=lambda event: event.row,
        )
        rows = sorted({row_of(history, event) for event in events})
        keep = rows if len(rows) <= MOST_MARKS else rows[:: -(-len(rows) // MOST_MARKS)]
        at = time.at[keep]
        axes.plot(at, [lane] * len(at), look.shape, color=look.colour, markersize=5, clip_on=False)
        _beside(axes, history, events, lane, time)


def _beside(
    axes: Axes, history: History, events: Sequence[Event], lane: int, time: TimeAxis
) -> None:
    """Words beside the marks of a lane, to the right or else to the left, where they fit."""
    first, last = time.ends
    inches = WIDTH * (RIGHT - LEFT) / (last - first)
    at = [float(time.at[row_of(history, event)] - first) * inches for event in events]
    free = 0.0
    for place, event in enumerate(events):
        words = _said(history, event)
        room = LETTER * len(words) + 0.2
        following = at[place + 1] - 0.06 if place + 1 < len(at) else (last - first) * inches
        if words and at[place] + room <= following:
            x, side, end = at[place] + 0.08, "left", at[place] + room
        elif words and at[place] - room >= free:
            x, side, end = at[place] - 0.08, "right", at[place] + 0.08
        else:
            free = at[place] + 0.08
            continue
        free = end
        axes.text(
            first + x / inches, lane, words, fontsize=6.6, ha=side, va="center", zorder=4,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.3},
        )  # fmt: skip


def _said(history: History, event: Event) -> str:
    if event.kind == "alarm":
        more = len(event.sensors) - MOST_NAMES
        names = ", ".join(label(name, 14) for name in event.sensors[:MOST_NAMES])
        return f"{names} and {more} more" if more > 0 else names
    said = []
    if event.kind == "version" and (one := version_number(history, event)):
        said.append(f"version {one}")
    if event.gap_before is not None and event.gap_after is not None:
        said.append(f"gap {number(event.gap_before, 2)} → {number(event.gap_after, 2)}")
    return ", ".join(said)


def _key(history: History) -> list[Line2D | Patch]:
    smooth = f"mean over {window(history)} rows"
    handles: list[Line2D | Patch] = [
        Line2D([], [], ls="", marker=".", color=STEEL, label="single rows"),
        Line2D([], [], color=INK, lw=1.3, label=smooth),
        Line2D([], [], color=INK, lw=0.8, dashes=(3, 2), label="noise alone"),
    ]
    if history.calibration_rows:
        handles.append(Patch(color=FAINT, alpha=0.6, label="rows of the calibration"))
    return handles


def _words(history: History, by_row: FloatArray) -> str:
    line = smoothed(history, by_row)
    if not np.isfinite(line).any():
        return "Events of the run; no gap is known."
    parts = [
        f"{kind} at {', '.join(str(e.time) for e in history.events if e.kind == kind)}"
        for kind in ("alarm", "recall", "recalibration", "version", "rollback")
        if any(event.kind == kind for event in history.events[:MOST_MARKS])
    ]
    largest = f"Gap over time, at most {number(float(np.nanmax(line)))} once smoothed"
    return "; ".join([largest, *parts]) + "."
