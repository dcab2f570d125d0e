"""What is kept of rows in blocks, beside what all rows say together."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.twin.hardware.interface import Packet
from rga.twin.rows.recent import RecentRows, Stretch
from rga.twin.rows.summaries import BLOCK, BLOCKS, RowSummaries


class Followed:
    """Rows with a context that rises, simulated by one number; all of them are stored."""

    def __init__(self, rows: int) -> None:
        draw = np.random.default_rng(3)
        readings = draw.normal(5.0, 2.0, (rows, 4))
        readings[draw.random((rows, 4)) < 0.1] = np.nan
        readings[:, 3] = np.nan
        self.whole = Stretch.empty(rows, 4, 0, 1)
        self.whole.time[:], self.whole.readings[:] = np.arange(rows), readings
        self.rows = RecentRows(4, 0, 1, lambda first, end: self.whole[first:end])
        self.summaries = RowSummaries(self.rows, 4, 1)

    def take_in(self, end: int, packet: int = 100) -> None:
        for first in range(len(self.rows), end, packet):
            part = self.whole[first : min(end, first + packet)]
            self.rows.append(Packet(first, part.time, part.readings, part.measured))
            self.follow(first, first + len(part), 4.5)

    def follow(self, first: int, end: int, simulated: float) -> None:
        part = self.whole[first:end]
        part.simulated[:], part.spread[:] = simulated, 1.0
        part.contexts[:, 0] = np.arange(first, end)
        self.rows.followed(first, part.contexts, part.spread, part.simulated)
        self.summaries.followed(first, end)

    def expected(self, first: int, end: int) -> tuple[FloatArray, FloatArray]:
        gaps = ((self.whole.readings - self.whole.simulated)[first:end, :3]) ** 2
        return np.nanmean(gaps, axis=0), np.nanstd(gaps, axis=0)


@pytest.mark.parametrize("end", [1, BLOCK - 1, BLOCK, 3 * BLOCK + 17, 1000])
def test_they_are_those_of_all_rows_together(end: int) -> None:
    case = Followed(1000)
    case.take_in(end)
    mean, deviation = case.summaries.gaps_before(end)
    np.testing.assert_allclose((mean[:3], deviation[:3]), case.expected(0, end), rtol=1e-12)
    assert np.isnan((mean[3], deviation[3])).all()
    assert case.summaries.contexts_before(end).ravel().tolist() == [0, end - 1]


def test_rows_that_are_followed_anew_count_as_they_are_now() -> None:
    case, end = Followed(4 * BLOCK), 4 * BLOCK
    case.take_in(end)
    before = case.summaries.gaps_before(end)
    case.follow(2 * BLOCK + 5, end, 1e6)
    assert case.summaries.gaps_before(end)[0][0] > before[0][0]
    case.follow(2 * BLOCK + 5, end, 4.5)
    np.testing.assert_array_equal(case.summaries.gaps_before(end), before)


def test_what_is_long_past_is_forgotten_but_where_contexts_were() -> None:
    case, end = Followed((BLOCKS + 2) * BLOCK), (BLOCKS + 2) * BLOCK
    case.take_in(2 * BLOCK)
    case.follow(0, 2 * BLOCK, 1e6)
    case.take_in(end, packet=999)
    mean, _ = case.summaries.gaps_before(end)
    np.testing.assert_allclose(mean[:3], case.expected(2 * BLOCK, end)[0], rtol=1e-12)
    assert case.summaries.contexts_before(end).ravel().tolist() == [0, end - 1]
    assert case.summaries.contexts_before(BLOCKS * BLOCK).ravel()[0] == 0


def test_another_goes_on_with_the_same_bits_and_changes_few_of_them() -> None:
    case, end = Followed(6 * BLOCK), 6 * BLOCK
    case.take_in(5 * BLOCK)
    early = case.summaries.to_bytes()
    case.take_in(end)
    late = case.summaries.to_bytes()
    differing = (np.frombuffer(early) != np.frombuffer(late)).sum()
    assert 0 < differing < 20
    again = RowSummaries(case.rows, 4, 1)
    again.restore(late)
    np.testing.assert_array_equal(again.gaps_before(end), case.summaries.gaps_before(end))
    np.testing.assert_array_equal(again.contexts_before(end), case.summaries.contexts_before(end))
