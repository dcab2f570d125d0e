"""Thresholds of the monitor: how often chance lifts its statistics above them."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import poisson

from rga.detection.baseline.baseline_model import Reference
from rga.detection.thresholds import (
    BLOCKS,
    SHARES,
    STREAMS,
    TailModel,
    calibration,
    tails,
)

SENSORS, BLOCK, ROWS = 12, 500, 9_000_000
SEEDS = range(8)
Peaks = NDArray[np.float64]


@pytest.fixture(scope="module")
def peaks() -> Peaks:
    """The largest values of the statistics in blocks of known noise, float[blocks, statistics]."""
    generator = np.random.default_rng(11)
    statistics = Reference.known(SENSORS).statistics(np.full(len(SHARES), np.inf), 0)
    found = np.empty((ROWS // BLOCK, len(SHARES)))
    for own in found:
        statistics.update_many(generator.standard_normal((BLOCK, SENSORS)))
        own[:] = statistics.take_peaks()
    return found


@pytest.mark.parametrize("arl0", [10_000.0, 100_000.0, 300_000.0])
def test_false_alarms_are_as_rare_as_asked_beyond_the_streams(arl0: float, peaks: Peaks) -> None:
    """On average over calibrations, each from streams of 10 000 rows."""
    expected = ROWS / arl0
    low, high = poisson.interval(0.98, expected)
    alarms = []
    for seed in SEEDS:
        limits = calibration(SENSORS, None, 0.0, 10_000.0, seed).thresholds(arl0)
        above = (peaks > limits).any(axis=1)
        # Blocks that follow each other are one alarm.
        alarms.append(above[0] + (above[1:] & ~above[:-1]).sum())
    assert 0.9 * low < np.mean(alarms) < high
    # A calibration scatters by some 15 %.
    assert max(alarms) < 1.3 * expected + 3.0 * expected**0.5


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
