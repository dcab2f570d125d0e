"""Thresholds of the monitor: the tails that they are read from."""

import numpy as np
import pytest

from rga.detection.thresholds import (
    BLOCKS,
    SHARES,
    STREAMS,
    TailModel,
    tails,
)


@pytest.mark.parametrize("arl0", [2_000.0, 10_000.0, 1e6])
def test_thresholds_are_what_chance_reaches_in_so_many_rows(arl0: float) -> None:
    simulated = TailModel(np.linspace(5.0, 12.0, len(SHARES)), np.linspace(0.9, 2.0, 24), 10_000)
    limits = simulated.thresholds(arl0)
    assert simulated.chance(limits, int(arl0)) == pytest.approx(-np.expm1(-1.0))
    assert simulated.chance(limits, int(arl0) // 100) == pytest.approx(0.01, rel=0.01)


def test_the_tail_of_exponential_peaks_is_found() -> None:
    generator = np.random.default_rng(3)
    values = generator.exponential(size=(STREAMS * BLOCKS, 400)) * 1.5
    location, scale = tails(values)
    # Exceeded by one block of twenty.
    assert location.mean() == pytest.approx(1.5 * np.log(BLOCKS), rel=0.02)
    # The larger of two estimates is a little large.
    assert 1.5 < scale.mean() < 1.05 * 1.5
    assert scale.std() < 0.07 * 1.5


def test_a_tail_that_is_heavier_further_out_is_seen() -> None:
    """Beside one that is lighter further out, which is not trusted to stay so."""
    generator = np.random.default_rng(4)
    rare = generator.exponential(size=(STREAMS * BLOCKS, 100))
    bend = np.log(BLOCKS)
    beyond = np.maximum(rare - bend, 0.0)
    for slope, least, most in ((3.0, 2.7, 3.3), (0.3, 0.7, 1.0)):
        _, scale = tails(np.minimum(rare, bend) + slope * beyond)
        assert least < scale.mean() < most


def test_a_statistic_that_is_as_large_as_it_can_get_raises_no_alarm() -> None:
    peaks = np.random.default_rng(5).exponential(size=(STREAMS * BLOCKS, len(SHARES)))
    peaks[::3, 4] = 46.0
    simulated = TailModel(*tails(peaks), 10_000)
    limits = simulated.thresholds(10_000.0)
    assert limits[4] > np.exp(46.0)
    assert (np.delete(limits, 4) < np.exp(20.0)).all()
