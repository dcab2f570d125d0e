"""What is kept of rows that have gone by, at a cost that does not grow with them.

Rows are taken in blocks, whose counts, means and sums of squares are put together (Chan, Golub and
LeVeque 1983, The American Statistician 37, 242).
"""

from typing import NamedTuple

import numpy as np

from rga.arrays import FloatArray
from rga.twin.rows.recent import RecentRows

#: rows of a block, and how many blocks back a row is remembered: two weeks of minutes
BLOCK, BLOCKS = 256, 80


class Moments(NamedTuple):
    """How many values each channel has, their mean, and squares about it: float[channels] each."""

    known: FloatArray
    mean: FloatArray
    squares: FloatArray

    @classmethod
    def of(cls, values: FloatArray) -> "Moments":
        """Of values float[rows, channels], NaN where missing."""
        seen = np.isfinite(values)
        count = seen.sum(axis=0).astype(float)
        mean = np.where(seen, values, 0.0).sum(axis=0) / np.maximum(count, 1.0)
        squares = np.where(seen, values - mean, 0.0) ** 2
        return cls(count, mean, squares.sum(axis=0))


class RowSummaries:
    """Mean and spread of the squared gaps of the latest rows, and where contexts have been.

    Args:
        rows: the rows of a run. Those that are followed again are to be told of.
        channels, contexts: how many there are.
    """

    def __init__(self, rows: RecentRows, channels: int, contexts: int) -> None:
        self._rows = rows
        # A block stands at its number modulo their count, -1 where none does: a state that is
        # written over by parts then changes in few of them.
        self._numbers = np.full(BLOCKS, -1, dtype=np.int64)
        self._moments = np.zeros((BLOCKS, 3, channels))
        self._ends = np.zeros((BLOCKS, 2, contexts))
        self._older = np.full((2, contexts), np.nan)

    def followed(self, first: int, end: int) -> None:
        """Rows from one to before another have been followed, for the first time or again."""
        latest = max(end // BLOCK, int(self._numbers.max()) + 1)
        for number in range(max(first // BLOCK, latest - BLOCKS), end // BLOCK):
            place = number % BLOCKS
            if 0 <= self._numbers[place] < number:
                low, high = self._ends[place]
                self._older = np.stack(
                    [np.fmin(self._older[0], low), np.fmax(self._older[1], high)]
                )
            rows = number * BLOCK, (number + 1) * BLOCK
            self._moments[place] = Moments.of(self._rows.gaps(*rows))
            self._ends[place] = _ends(self._rows.rows(*rows).contexts)
            self._numbers[place] = number

    def gaps_before(self, end: int) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation of the squared gaps before a row, float[channels] each.

        NaN for channels without a gap.
        """
        parts = [Moments(*self._moments[place]) for place in self._places(end)]
        parts.append(Moments.of(self._rows.gaps(end - end % BLOCK, end)))
        count, mean, squares = (np.stack(table) for table in zip(*parts, strict=True))
        total = count.sum(axis=0)
        with np.errstate(invalid="ignore"):
            middle = (count * mean).sum(axis=0) / total
            about = (squares + count * (mean - middle) ** 2).sum(axis=0)
            return middle, np.sqrt(about / total)

    def contexts_before(self, end: int) -> FloatArray:
        """Smallest and largest of every context before a row, float[2, contexts].

        Of rows that are long past they are as they were when these were summed up.
        """
        parts = [self._older, *(self._ends[place] for place in self._places(end))]
        parts.append(_ends(self._rows.rows(end - end % BLOCK, end).contexts))
        stacked = np.stack(parts)
        return np.stack([np.fmin.reduce(stacked[:, 0]), np.fmax.reduce(stacked[:, 1])])

    def to_bytes(self) -> bytes:
        """The state; what stays as it was stands where it stood."""
        tables = (self._numbers, self._moments, self._ends, self._older)
        return b"".join(table.astype("<f8").tobytes() for table in tables)

    def restore(self, state: bytes) -> None:
        """Go on where another of the same shape stood."""
        values, begun = np.frombuffer(state, dtype="<f8"), 0
        for table in (self._numbers, self._moments, self._ends, self._older):
            table[...] = values[begun : begun + table.size].reshape(table.shape)
            begun += table.size

    def _places(self, end: int) -> list[int]:
        """Places of the whole blocks before a row."""
        last = end // BLOCK
        numbers = range(max(0, last - BLOCKS), last)
        return [one % BLOCKS for one in numbers if self._numbers[one % BLOCKS] == one]


def _ends(values: FloatArray) -> FloatArray:
    """Smallest and largest of columns, float[2, columns]; NaN for those without a value."""
    none = np.full((1, values.shape[1]), np.nan)
    table = np.concatenate([none, values])
    return np.stack([np.fmin.reduce(table), np.fmax.reduce(table)])
