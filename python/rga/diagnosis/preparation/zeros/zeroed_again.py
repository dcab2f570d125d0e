"""A logger that is zeroed again in mid-record, on all of its channels."""

import numpy as np

from rga.diagnosis.preparation.zeros.levels import Compared, moving_means

#: rows over which the logger may have taken its zero, and over which levels are compared
TAKEN, BESIDE = (1, 2, 5, 10), 10


def zeroed_again(compared: Compared) -> int | None:
    """The row from which on the channels start from zero again, if no single cause makes that."""
    row = zero_from(compared)
    return None if row is None or _one_cause(compared, row) else row


def zero_from(compared: Compared) -> int | None:
    """The row from which on the channels start from zero again, if there is one."""
    criteria = compared.data.criteria.zeros
    noise, own = compared.noise, compared.own
    expected = np.where(compared.data.observed, compared.simulated, np.nan)
    over = moving_means(compared.residual, BESIDE)
    rows = np.arange(BESIDE, len(over))
    before, after = over[rows - BESIDE], over[rows]
    shift = noise * np.sqrt(2 / BESIDE)
    found = np.zeros(len(rows), dtype=bool)
    for taken in TAKEN:
        shown = moving_means(compared.readings, taken)[rows]
        should = moving_means(expected, taken)[rows] + before
        far = np.maximum(criteria.far_from_zero * shift, criteria.offset * own)
        telling = (np.abs(should) > far) & compared.working
        zero = telling & (np.abs(shown) <= criteria.near_zero * own)
        missed = criteria.shift_share * np.abs(should) + criteria.shift_deviations * shift
        zero &= np.abs(after - before + should) <= missed
        enough = telling.sum(1) >= compared.at_least(criteria.share_of_channels)
        found |= enough & (zero.sum(1) >= criteria.reading_zero * telling.sum(1))
    if not found.any():
        return None
    # Rows beside it may read near zero too: where it happened the levels lie furthest apart.
    apart = np.nansum(np.abs(after - before) / np.where(compared.working, shift, np.inf), axis=1)
    return int(rows[np.argmax(np.where(found, apart, -1.0))])


def _one_cause(compared: Compared, row: int) -> bool:
    """Whether a single cause that begins at a row makes the jump of all channels there."""
    residual = compared.residual
    beside = residual[row - BESIDE : row], residual[row : row + BESIDE]
    before, after = (moving_means(part, len(part))[0] for part in beside)
    jump = compared.over_noise(after - before)
    for change, late in compared.changes:
        shown = compared.over_noise(change[row : row + BESIDE].mean(0) + late)
        alike = (shown @ jump) ** 2
        if alike > compared.data.criteria.zeros.one_cause * (shown @ shown) * (jump @ jump):
            return True
    return False
