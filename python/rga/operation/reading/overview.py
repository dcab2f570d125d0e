"""A long past in few numbers: least, mean and largest of blocks of rows."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray, IntArray

Floats = NDArray[np.floating[Any]]
#: rows of a block
BLOCK = 32


@dataclass(frozen=True)
class Trace:
    """Some columns over time, one entry for one row or for several.

    Attributes:
        time: of the first row of each entry [s since the first row], float[n].
        mean, least, most: float[n, columns], NaN where nothing is; of four bytes where they are
            of many rows.
    """

    time: FloatArray
    mean: Floats
    least: Floats
    most: Floats

    def __len__(self) -> int:
        return len(self.time)

    def at_most(self, entries: int) -> "Trace":
        """The same in so many entries or fewer.

        >>> rows = as_trace(np.arange(4.0), np.array([[1.0], [3.0], [np.nan], [8.0]]))
        >>> rows.at_most(2).mean.ravel().tolist(), rows.at_most(2).most.ravel().tolist()
        ([2.0, 8.0], [3.0, 8.0])
        """
        if len(self) <= entries:
            return self
        edges = np.linspace(0, len(self), entries + 1).astype(int)[:-1]
        return Trace(
            self.time[edges],
            _mean(self.mean, edges),
            np.fmin.reduceat(self.least, edges, axis=0),
            np.fmax.reduceat(self.most, edges, axis=0),
        )


def as_trace(time: FloatArray, values: FloatArray) -> Trace:
    """Rows as they are: time float[n], values float[n, columns]."""
    return Trace(time, values, values, values)


class Overview:
    """The past of some columns, grown as rows are appended; old rows are kept as blocks alone.

    Args:
        columns: how many there are.
    """

    def __init__(self, columns: int) -> None:
        self._columns = columns
        self._blocks: list[Trace] = []
        self._joined: Trace | None = None
        self._open = as_trace(np.zeros(0), np.zeros((0, columns)))
        #: rows that were appended
        self.rows = 0

    def append(self, time: FloatArray, values: FloatArray) -> None:
        """Take rows in: time float[n], values float[n, columns]."""
        self.rows += len(time)
        times = np.concatenate([self._open.time, time])
        rows = np.concatenate([self._open.mean, values]).reshape(len(times), self._columns)
        whole = len(times) // BLOCK * BLOCK
        if whole:
            blocks = as_trace(times[:whole], rows[:whole]).at_most(whole // BLOCK)
            self._blocks.append(_small(blocks))
            self._joined = None
        self._open = as_trace(times[whole:], rows[whole:])

    def between(self, begin: float, end: float) -> Trace:
        """What lies within [begin, end) [s since the first row], in blocks."""
        if self._joined is None:
            self._joined = _joined(self._blocks, self._columns)
            self._blocks = [self._joined] if len(self._joined) else []
        found = _joined([self._joined, self._open], self._columns)
        # A block counts with all its rows, as some may lie within.
        first = int(np.searchsorted(found.time, begin))
        before = int(np.searchsorted(found.time, begin, side="right")) - 1
        if 0 <= before < len(self._joined):
            first = before
        last = int(np.searchsorted(found.time, end)) if end > begin else first
        parts = (found.mean, found.least, found.most)
        return Trace(found.time[first:last], *(one[first:last] for one in parts))


def _small(trace: Trace) -> Trace:
    """The same in half the room: seven digits are enough for a picture."""
    parts = (trace.mean, trace.least, trace.most)
    return Trace(trace.time, *(np.asarray(one, dtype=np.float32) for one in parts))


def _joined(parts: list[Trace], columns: int) -> Trace:
    if not parts:
        return as_trace(np.zeros(0), np.zeros((0, columns)))
    names = ("time", "mean", "least", "most")
    return Trace(*(np.concatenate([getattr(one, name) for one in parts]) for name in names))


def _mean(values: Floats, edges: IntArray) -> FloatArray:
    there = np.isfinite(values)
    count = np.add.reduceat(there, edges, axis=0, dtype=np.int64)
    total = np.add.reduceat(np.where(there, values, 0.0), edges, axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
