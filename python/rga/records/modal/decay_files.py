"""A free decay out of a logger's file, and its modes as a modal record."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.mapping import TimeColumns
from rga.records.modal.columns import DAMPING, DEVIATION, DURATION, FREQUENCY, TIME
from rga.records.modal.free_decay import DecayingMode
from rga.records.read import read_table
from rga.records.record import time_label
from rga.records.times import read_clock

#: share of the usual step by which steps may differ: clocks of loggers write whole milliseconds
JITTER = 0.5


@dataclass(frozen=True)
class Decay:
    """What sensors read while a structure swings freely.

    Attributes:
        motion: float[samples, sensors].
        step: between samples [s].
        points: names of the points at which they measure.
        middle: of the stretch, as the file writes times.
    """

    motion: FloatArray
    step: float
    points: tuple[str, ...]
    middle: str | float

    @property
    def duration(self) -> float:
        """How long it lasts [s]."""
        return len(self.motion) * self.step


def decay_of(
    path: str | Path,
    begin: float = 0.0,
    end: float | None = None,
    columns: Sequence[str] | None = None,
) -> Decay:
    """A stretch of a logger's file.

    Args:
        path: file of any format of records, with a time column.
        begin, end: of the stretch [s after the first row]; None: to the last row.
        columns: names of those that are looked at, each by itself or as NAME=POINT with the point
            at which it measures; None: all.

    Raises:
        InputError: the file cannot be read, lacks a column, or its steps in time are not alike; or
            nothing lies within the stretch.
    """
    table = read_table(path)
    clock = read_clock(table, TimeColumns())
    within = clock.seconds >= begin
    if end is not None:
        within &= clock.seconds <= end
    time = clock.seconds[within]
    if len(time) < 2:
        raise InputError(
            "there are no samples in the stretch",
            f"{path}, which lasts {clock.seconds[-1]:g} s",
            "give seconds after the first row",
        )
    steps = np.diff(time)
    step = float((time[-1] - time[0]) / len(steps))
    odd = np.abs(steps / step - 1.0) > JITTER
    if odd.any():
        row = int(np.argmax(odd))
        raise InputError(
            f"{steps[row]:g} s pass where {step:g} s are usual",
            f"{path}, {time[row]:g} s after the first row",
            "give a stretch without gaps",
        )
    known = [
        name for name in table.frame.columns if name not in (*clock.columns, *table.bookkeeping)
    ]
    if not known:
        raise InputError(
            "there is nothing but the time", str(path), "give a column for each sensor"
        )
    chosen = [_named(one, known, Path(path)) for one in columns or known]
    points = tuple(point for _, point in chosen)
    if len(set(points)) < len(points):
        twice = next(one for one in points if points.count(one) > 1)
        raise InputError(f"{twice!r} is given twice", "--column", "give each point once")
    motion = np.column_stack([table.numbers(name)[within] for name, _ in chosen])
    return Decay(motion, step, points, time_label(clock.start, float(time.mean())))


def _named(given: str, known: Sequence[str], path: Path) -> tuple[str, str]:
    """Column and point."""
    name, _, point = (given, "", "") if given in known else given.rpartition("=")
    name, point = name or given, point or name or given
    if name not in known:
        raise InputError(
            f"there is no column {name!r}",
            f"{path}, columns {', '.join(known[:12])}",
            "give columns as NAME or NAME=POINT",
        )
    return name, point


def modal_table(decay: Decay, modes: Sequence[DecayingMode]) -> pl.DataFrame:
    """Modes of a decay as a modal record, a line a mode.

    Args:
        decay: out of which they are.
        modes: of `decaying_modes`.
    """
    columns = {
        TIME: [decay.middle] * len(modes),
        DURATION: [decay.duration] * len(modes),
        FREQUENCY: [one.frequency for one in modes],
        DEVIATION: [one.scatter or None for one in modes],
        DAMPING: [one.damping for one in modes],
    }
    shapes = {point: [float(one.shape[k]) for one in modes] for k, point in enumerate(decay.points)}
    return pl.DataFrame(columns | shapes)
