"""Mean and spread of the gaps so far, at a cost that does not grow with the rows.

Rows are taken in blocks, whose counts, means and sums of squares are put together (Chan, Golub and
LeVeque 1983, The American Statistician 37, 242).
"""

from typing import NamedTuple

import numpy as np

from rga.arrays import FloatArray
from rga.twin.row_buffer import RowBuffer

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


class GapMoments:
    """Mean and standard deviation of the squared gaps of the latest rows.

    Args:
        rows: the rows of a run. Those whose gaps change are to be told of.
    """

    def __init__(self, rows: RowBuffer) -> None:
        self._rows = rows
        self._blocks: dict[int, Moments] = {}

    def changed(self, first: int) -> None:
        """The gaps of rows from one on are others now."""
        for number in [one for one in self._blocks if (one + 1) * BLOCK > first]:
            del self._blocks[number]

    def before(self, end: int) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation of the rows before one, float[channels] each.

        NaN for channels without a gap.
        """
        last = end // BLOCK
        parts = [self._block(number) for number in range(max(0, last - BLOCKS), last)]
        parts.append(Moments.of(self._rows.gaps(last * BLOCK, end)))
        count, mean, squares = (np.stack(table) for table in zip(*parts, strict=True))
        total = count.sum(axis=0)
        with np.errstate(invalid="ignore"):
            middle = (count * mean).sum(axis=0) / total
            about = (squares + count * (mean - middle) ** 2).sum(axis=0)
            return middle, np.sqrt(about / total)

    def _block(self, number: int) -> Moments:
        if number not in self._blocks:
            first = number * BLOCK
            self._blocks[number] = Moments.of(self._rows.gaps(first, first + BLOCK))
        return self._blocks[number]
