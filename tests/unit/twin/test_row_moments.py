"""Moments of the gaps in blocks, beside those of all rows together."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.twin.messages.hardware import Packet
from rga.twin.row_buffer import RowBuffer
from rga.twin.row_moments import BLOCK, BLOCKS, GapMoments


def buffer(rows: int) -> RowBuffer:
    draw = np.random.default_rng(3)
    readings = draw.normal(5.0, 2.0, (rows, 4))
    readings[draw.random((rows, 4)) < 0.1] = np.nan
    readings[:, 3] = np.nan
    ledger = RowBuffer(4, 0, 0)
    ledger.append(Packet(0, np.arange(float(rows)), readings, np.zeros((rows, 0))))
    ledger.simulated[:] = 4.5
    return ledger


def expected(ledger: RowBuffer, first: int, end: int) -> tuple[FloatArray, FloatArray]:
    gaps = ledger.gaps(first, end)[:, :3]
    return np.nanmean(gaps, axis=0), np.nanstd(gaps, axis=0)


@pytest.mark.parametrize("end", [1, BLOCK - 1, BLOCK, 3 * BLOCK + 17, 1000])
def test_they_are_those_of_all_rows_together(end: int) -> None:
    ledger = buffer(1000)
    moments = GapMoments(ledger)
    for rows in range(0, end, 100):
        moments.before(rows)
    mean, deviation = moments.before(end)
    np.testing.assert_allclose((mean[:3], deviation[:3]), expected(ledger, 0, end), rtol=1e-12)
    assert np.isnan((mean[3], deviation[3])).all()


def test_rows_that_are_followed_anew_count_as_they_are_now() -> None:
    ledger = buffer(4 * BLOCK)
    moments = GapMoments(ledger)
    before = moments.before(4 * BLOCK)
    ledger.simulated[2 * BLOCK + 5 :] = 1e6
    moments.changed(2 * BLOCK + 5)
    assert moments.before(4 * BLOCK)[0][0] > before[0][0]
    ledger.simulated[2 * BLOCK + 5 :] = 4.5
    moments.changed(2 * BLOCK + 5)
    np.testing.assert_array_equal(moments.before(4 * BLOCK), before)


def test_what_is_long_past_is_forgotten() -> None:
    ledger = buffer((BLOCKS + 2) * BLOCK)
    ledger.simulated[: 2 * BLOCK] = 1e6
    mean, _ = GapMoments(ledger).before(len(ledger))
    np.testing.assert_allclose(mean[:3], expected(ledger, 2 * BLOCK, len(ledger))[0], rtol=1e-12)
