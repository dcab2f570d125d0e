"""The rows on which a logger was set to zero, where nobody declared it.

A channel that was set to zero over some rows has a mean of zero there, whatever the loads were.
Noise leaves more than that in the mean of any other rows: a mean that lies nearer to zero than
noise allows was taken off.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtr

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.preparation.zeros.levels import Compared, RunningSums, blocks

#: numbers of rows that are tried anywhere in a record; from its first row on every number is
ANYWHERE = (1, 2, 3, 5, 10, 20, 50)
#: chance at which means of some rows of a record may lie so near to zero by themselves
BY_CHANCE = 1e-6
#: offset that counts where the rows surely are those of a zero, in deviations of the noise
SEEN = 3.0
#: share of all rows in which a channel must be off by what was taken off there: something that
#: begins later moves the others, and rows in which a logger wrote zeros move none
STANDS = 0.3
#: stretches that are looked at so, those nearest to zero first
LOOKED_AT = 50


@dataclass(frozen=True)
class ZeroRows:
    """Rows whose mean was taken off.

    Attributes:
        first, last: row numbers, from 0 on.
        taken: mean of the simulation there, of channels that it tells, float[sensors]; else 0.
        surely: no readings about zero have means so near to it by chance.
    """

    first: int
    last: int
    taken: FloatArray
    surely: bool


def zero_rows(compared: Compared) -> ZeroRows | None:
    """The rows over which channels most likely were set to zero, if there are such."""
    criteria = compared.data.criteria.zeros
    first, end = _stretches(len(compared.readings))
    readings = RunningSums.of(compared.readings)
    simulated = RunningSums.of(np.where(compared.data.observed, compared.simulated, np.nan))
    chance, found = np.ones(len(first)), np.zeros(len(first), dtype=bool)
    surely = found.copy()

    def told(of: slice | IntArray) -> tuple[FloatArray, BoolArray]:
        """What is simulated in stretches, and where that is far, float, bool[n, sensors]."""
        should = np.where(compared.working, simulated.means(first[of], end[of]), 0.0)
        least = np.where(surely[of], SEEN, criteria.offset)[:, None] * compared.noise
        return should, np.abs(should) > least

    for block in blocks(len(first)):
        mean = readings.means(first[block], end[block])
        zero = compared.working & (np.abs(mean) <= criteria.near_zero * compared.own)
        squares = np.zeros(zero.shape)
        np.divide(mean, compared.own, out=squares, where=zero)
        # Of stretches that read zero as nearly, the longer one says more.
        power = (squares**2).sum(1) * (end[block] - first[block])
        chance[block] = chdtr(np.maximum(zero.sum(1), 1), power)
        surely[block] = chance[block] * len(first) < BY_CHANCE
        surely[block] &= zero.sum(1) >= criteria.reading_zero * compared.working.sum()
        _, telling = told(block)
        few = np.where(surely[block], 1, compared.at_least(criteria.share_of_channels))
        found[block] = telling.sum(1) >= few
        found[block] &= (telling & zero).sum(1) >= criteria.reading_zero * telling.sum(1)
    order = np.argsort(np.where(found, chance, np.inf), kind="stable")
    for best in order[: min(LOOKED_AT, found.sum())]:
        (should,), (telling,) = told(np.array([best]))
        taken = np.where(telling, should, 0.0)
        if _stands(compared, taken):
            return ZeroRows(int(first[best]), int(end[best]) - 1, taken, bool(surely[best]))
    return None


def _stands(compared: Compared, taken: FloatArray) -> bool:
    """Whether channels are off by what was taken off them in many rows."""
    criteria = compared.data.criteria.zeros
    missed = criteria.shift_share * np.abs(taken) + criteria.shift_deviations * compared.noise
    residual, told = compared.residual[:, taken != 0], taken != 0
    within = np.abs(residual + taken[told]) <= missed[told]
    share = within.sum(0) / np.maximum(np.isfinite(residual).sum(0), 1)
    return bool((share >= STANDS).mean() >= criteria.reading_zero)


def _stretches(rows: int) -> tuple[IntArray, IntArray]:
    """First rows and ends of stretches of a record that a zero may have been taken over."""
    first, end = [np.zeros(rows, dtype=np.int64)], [np.arange(1, rows + 1)]
    for width in (width for width in ANYWHERE if width < rows):
        first.append(np.arange(1, rows - width + 1))
        end.append(first[-1] + width)
    return np.concatenate(first), np.concatenate(end)
