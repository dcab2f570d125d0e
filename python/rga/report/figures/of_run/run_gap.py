"""The gap of a run, by row and by sensor, and the phases into which its events divide it."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rga.arrays import FloatArray
from rga.report.figures.when import when
from rga.twin.history import Event, History

#: events after which the twin simulates otherwise than before
CHANGES = ("recall", "recalibration", "version", "rollback")
MOST_PHASES = 6
#: rows below which a phase shows nothing
LEAST = 3


@dataclass(frozen=True)
class Phase:
    """A stretch of rows to look at by itself: from the first row up to, without, the last."""

    title: str
    first: int
    last: int


def standardised(history: History) -> FloatArray:
    """Squared difference over variance of the noise, float[rows, sensors] [-]; NaN where none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = history.gaps / history.noise**2
    return np.where(np.isfinite(ratio), ratio, np.nan)


def mean(values: FloatArray, axis: int | None = None) -> FloatArray:
    """Mean of what is finite; NaN where nothing is.

    >>> mean(np.array([[1.0, np.nan], [3.0, np.nan]]), axis=0)
    array([ 2., nan])
    """
    finite = np.isfinite(values)
    count = finite.sum(axis=axis)
    total = np.where(finite, values, 0.0).sum(axis=axis)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan))


def usual(by_row: FloatArray) -> float:
    """Median of what is finite, as the events report a gap; NaN where nothing is."""
    known = by_row[np.isfinite(by_row)]
    return float(np.median(known)) if len(known) else float("nan")


def window(history: History) -> int:
    """Rows over which the gap is smoothed."""
    return max(5, len(history.record) // 80)


def smoothed(history: History, by_row: FloatArray) -> FloatArray:
    """Running mean of float[rows] that does not reach across a change of the twin."""
    half = window(history) // 2
    changes = sorted({min(history.calibration_rows, len(by_row)), *_rows(history, CHANGES)})
    edges = [0]
    for row in changes:
        # Changes close to each other leave no stretch to average over.
        if row - edges[-1] > half and len(by_row) - row > half:
            edges.append(row)
    edges.append(len(by_row))
    result = np.full(len(by_row), np.nan)
    for first, last in pairwise(edges):
        part = by_row[first:last]
        finite = np.isfinite(part)
        sums = np.concatenate([[0.0], np.cumsum(np.where(finite, part, 0.0))])
        counts = np.concatenate([[0], np.cumsum(finite)])
        rows = np.arange(len(part))
        left, right = np.maximum(rows - half, 0), np.minimum(rows + half + 1, len(part))
        count = counts[right] - counts[left]
        average = (sums[right] - sums[left]) / np.maximum(count, 1)
        result[first:last] = np.where(count > 0, average, np.nan)
    return result


def row_of(history: History, event: Event) -> int:
    """The row of an event, kept within the record."""
    return int(np.clip(event.row, 0, len(history.record) - 1))


def phases(history: History) -> list[Phase]:
    """Rows after the calibration, at alarms and after changes of the twin, and at the end.

    At most `MOST_PHASES`: of the many, the first, the last and some at even distances.
    """
    total = len(history.record)
    start = min(history.calibration_rows, total - 1)
    length = max(total // 16, 5)
    turns = {
        row_of(history, event): event
        for event in history.events
        if event.kind in ("alarm", *CHANGES) and event.row >= start
    }
    rows = sorted(turns)
    found = [Phase("After calibration", start, min([start + length, total, *rows[:1]]))]
    for row, following in pairwise([*rows, total]):
        event = turns[row]
        first, last = row, min(row + length, following)
        if event.kind == "alarm" and last - first < 3:
            # The twin was mended at once: the rows that led to the alarm show what was wrong.
            first, last = max(row - 2, start), row + 1
        found.append(Phase(f"{_title(history, event)} {when(event.time)}", first, last))
    end = max(found[-1].last, total - length)
    if end < total:
        found.append(Phase("At the end", end, total))
    found = [phase for phase in found if phase.last - phase.first >= LEAST] or found[:1]
    if len(found) > MOST_PHASES:
        chosen = np.linspace(0, len(found) - 1, MOST_PHASES).round().astype(int)
        found = [found[number] for number in chosen]
    return found


def _title(history: History, event: Event) -> str:
    if event.kind == "version" and (number := version_number(history, event)):
        return f"With version {number} from"
    said = {
        "alarm": "At the alarm of",
        "recall": "As it was before, from",
        "recalibration": "Recalibrated at",
        "version": "With a new version from",
        "rollback": "After going back at",
    }
    return said[event.kind]


def version_number(history: History, event: Event) -> int | None:
    """The number of the version that an event brought, where the history has it."""
    return next((one.number for one in history.versions if one.row == event.row > 0), None)


def _rows(history: History, kinds: tuple[str, ...]) -> list[int]:
    return [row_of(history, event) for event in history.events if event.kind in kinds]
