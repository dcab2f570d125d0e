"""False alarms at the thresholds of the monitor, over millions of rows."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import poisson

from rga.detection.baseline.baseline_model import Reference
from rga.detection.thresholds import SHARES, StreamNoise, calibration

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
def test_false_alarms_are_as_rare_as_set_beyond_the_streams(arl0: float, peaks: Peaks) -> None:
    """On average over calibrations, each from streams of 10 000 rows."""
    expected = ROWS / arl0
    low, high = poisson.interval(0.98, expected)
    alarms = []
    for seed in SEEDS:
        limits = calibration(StreamNoise(SENSORS), None, 10_000.0, seed).thresholds(arl0)
        above = (peaks > limits).any(axis=1)
        # Blocks that follow each other are one alarm.
        alarms.append(above[0] + (above[1:] & ~above[:-1]).sum())
    assert 0.9 * low < np.mean(alarms) < high
    # A calibration scatters by some 15 %.
    assert max(alarms) < 1.3 * expected + 3.0 * expected**0.5
