"""A logger that is zeroed again in mid-record, on all of its channels."""

import numpy as np

from rga.diagnosis.preparation.zeros.levels import Compared, RunningSums, blocks, moving_means

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
    missing, shown_sums, expected_sums = (
        RunningSums.of(values) for values in (compared.residual, compared.readings, expected)
    )
    all_rows = np.arange(BESIDE, len(expected) - BESIDE + 1)
    shift = noise * np.sqrt(2 / BESIDE)
    far = np.maximum(criteria.far_from_zero * shift, criteria.offset * own)
    apart = np.full(len(all_rows), -1.0)
    for block in blocks(len(all_rows)):
        rows = all_rows[block]
        before, after = missing.means(rows - BESIDE, rows), missing.means(rows, rows + BESIDE)
        found = np.zeros(len(rows), dtype=bool)
        for taken in TAKEN:
            shown = shown_sums.means(rows, rows + taken)
            should = expected_sums.means(rows, rows + taken) + before
            telling = (np.abs(should) > far) & compared.working
            zero = telling & (np.abs(shown) <= criteria.near_zero * own)
            missed = criteria.shift_share * np.abs(should) + criteria.shift_deviations * shift
            zero &= np.abs(after - before + should) <= missed
            enough = telling.sum(1) >= compared.at_least(criteria.share_of_channels)
            found |= enough & (zero.sum(1) >= criteria.reading_zero * telling.sum(1))
        # Rows beside it may read near zero too: where it happened the levels lie furthest apart.
        levels = np.abs(after - before)[found] / np.where(compared.working, shift, np.inf)
        apart[block][found] = np.nansum(levels, axis=1)
    return None if (apart < 0).all() else int(all_rows[np.argmax(apart)])


def _one_cause(compared: Compared, row: int) -> bool:
    """Whether a single cause that begins at a row makes the jump of all channels there."""
    residual = compared.residual
    beside = residual[row - BESIDE : row], residual[row : row + BESIDE]
    before, after = (moving_means(part, len(part))[0] for part in beside)
    jump = compared.over_noise(after - before)
    for shown in compared.changes_from(row, BESIDE):
        alike = (shown @ jump) ** 2
        if alike > compared.data.criteria.zeros.one_cause * (shown @ shown) * (jump @ jump):
            return True
    return False
