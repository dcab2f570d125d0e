"""Channels that jump together in one row and stay: a logger that was started anew.

What a structure does at once, it does in a pattern that few causes make. A logger whose card was
started anew, or whose data were referred to another zero, moves some channels and leaves others, by
constants that go with nothing.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.preparation.zeros.levels import (
    Compared,
    RunningSums,
    blocks,
    constant,
    left_by_causes,
    moving_means,
)
from rga.diagnosis.preparation.zeros.zeroed_again import BESIDE, TAKEN

#: rows over which a jump must be there already, and the share of it
AT_ONCE, THERE = 2, 0.7
#: share of a jump that must be left in the rest of the record
STAYS = 0.5


@dataclass(frozen=True)
class Jump:
    """A jump of many channels.

    Attributes:
        row: the first behind it.
        jumping: bool[sensors].
        size: of the jump, float[sensors], in units of the sensors.
        at_zero: these channels read zero right behind it.
    """

    row: int
    jumping: BoolArray
    size: FloatArray
    at_zero: bool


def restarted(compared: Compared) -> Jump | None:
    """The largest jump of many channels, if no few causes make it."""
    jump = jump_of_many(compared)
    return None if jump is None or _few_causes(compared, jump) else jump


def jump_of_many(compared: Compared) -> Jump | None:
    """The largest jump of many channels that stays, if there is one."""
    criteria = compared.data.criteria.zeros
    sums = RunningSums.of(compared.residual)
    shift = np.where(compared.working, compared.noise * np.sqrt(2 / BESIDE), np.inf)

    def jumps(rows: IntArray) -> tuple[FloatArray, BoolArray]:
        """How far levels move at rows, and which of them at once, float and bool[n, sensors]."""
        size = sums.means(rows, rows + BESIDE) - sums.means(rows - BESIDE, rows)
        at_once = sums.means(rows, rows + AT_ONCE) - sums.means(rows - AT_ONCE, rows)
        far = np.nan_to_num(np.abs(size)) > criteria.far_from_zero * shift
        return size, far & (at_once * np.sign(size) > THERE * np.abs(size))

    rows = np.arange(BESIDE, len(compared.residual) - BESIDE + 1)
    apart = np.full(len(rows), -1.0)
    for block in blocks(len(rows)):
        size, jumping = jumps(rows[block])
        many = jumping.sum(1) >= compared.at_least(criteria.share_that_jumps)
        # Means over rows beside a jump hold a part of it: it is largest where it happened.
        apart[block][many] = (np.nan_to_num(np.abs(size)) / shift * jumping).sum(1)[many]
    if (apart < 0).all():
        return None
    row = int(rows[np.argmax(apart)])
    (size,), (channels,) = jumps(np.array([row]))
    largest = np.where(channels, size, 0.0)
    jump = Jump(row, channels, largest, _at_zero(compared, row, channels))
    return jump if _stays(compared, jump) else None


def _stays(compared: Compared, jump: Jump) -> bool:
    """Whether what jumped is a constant from there on, and does not go with the loads."""
    criteria = compared.data.criteria.zeros
    later = np.arange(len(compared.readings)) >= jump.row
    before, unsure_before = _level(compared, ~later)
    after, unsure_after = _level(compared, later)
    missed = (1 - STAYS) * np.abs(jump.size)
    missed += criteria.shift_deviations * np.hypot(unsure_before, unsure_after)
    stays = np.abs(after - before - jump.size) <= missed
    return bool(stays[jump.jumping].mean() >= criteria.reading_zero)


def _level(compared: Compared, rows: BoolArray) -> tuple[FloatArray, FloatArray]:
    """The constant in the residual of some rows beside the courses of the loads, and its noise."""
    course = constant(compared.simulator, compared.data.rows(rows))[:, None]
    weight = np.where(np.isfinite(compared.residual[rows]), course, 0.0)
    power = np.maximum((weight * course).sum(0), 1e-300)
    level = (weight * np.nan_to_num(compared.residual[rows])).sum(0) / power
    return level, compared.noise / np.sqrt(power)


def _few_causes(compared: Compared, jump: Jump) -> bool:
    """Whether few causes of the structure that begin there make the jump."""
    criteria = compared.data.criteria.zeros
    patterns = list(compared.changes_from(jump.row, BESIDE))
    size = compared.over_noise(jump.size)
    # No cause ends at the zero of the logger by chance, unless it is a load that acts no more.
    left = left_by_causes(size, patterns, 1 if jump.at_zero else criteria.most_causes)
    many = (np.abs(left) > criteria.far_from_zero * np.sqrt(2 / BESIDE)).sum()
    share = (left @ left) / (size @ size)
    return bool(many < criteria.fewest_channels or share < 1 - criteria.one_cause)


def _at_zero(compared: Compared, row: int, jumping: BoolArray) -> bool:
    """Whether channels read zero right behind a row."""
    criteria = compared.data.criteria.zeros
    for taken in TAKEN:
        shown = moving_means(compared.readings[row : row + taken, jumping], taken)[0]
        zero = np.abs(shown) <= criteria.near_zero * compared.own[jumping]
        if zero.mean() >= criteria.reading_zero:
            return True
    return False
