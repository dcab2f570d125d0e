"""False alarms of the monitor: as rare as asked, whatever dies or goes missing."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.stats import binomtest, poisson

from rga.detection import SyncMonitor
from unchanged_streams import BASELINE, MISSING, SENSORS, WORLDS, noise


@pytest.mark.parametrize("world", WORLDS)
def test_false_alarms_are_as_rare_as_set(world: str) -> None:
    """Over `arl0` rows the chance of one is 1 - 1/e."""
    arl0, draws = 500, 60
    alarms = 0
    for draw in range(draws):
        rows = noise(world, BASELINE + arl0, 100 + draw)
        monitor = SyncMonitor(rows[:BASELINE], arl0=arl0)
        alarms += bool(monitor.update_many(rows[BASELINE:])[-1])
    interval = binomtest(alarms, draws).proportion_ci(0.95)
    assert interval.low < 0.7
    assert interval.high > 0.4


@pytest.mark.parametrize("dead", [[2], [0, 1, 2, 3, 4], list(range(SENSORS))])
def test_sensors_that_die_raise_no_alarm(dead: list[int]) -> None:
    alarms = 0
    for draw in range(20):
        rows = noise("correlated", BASELINE + 1000, 300 + draw)
        rows[BASELINE:, dead] = MISSING
        monitor = SyncMonitor(rows[:BASELINE], arl0=10_000)
        alarms += bool(monitor.update_many(rows[BASELINE:])[-1])
    assert alarms <= 5


@pytest.mark.parametrize("world", WORLDS)
def test_readings_missing_at_random_raise_no_alarm(world: str) -> None:
    alarms = 0
    for draw in range(20):
        rows = noise(world, BASELINE + 500, 500 + draw)
        gaps = np.random.default_rng(draw).random(rows.shape) < 0.3
        rows[gaps] = MISSING
        monitor = SyncMonitor(rows[:BASELINE], arl0=5_000)
        alarms += bool(monitor.update_many(rows[BASELINE:])[-1])
    # One in ten is to be expected.
    assert alarms <= 7


def test_noise_too_slow_for_a_memory_raises_no_more_alarms() -> None:
    """A twentieth of the variance lives for 14 rows: an autoregression does not see it."""
    arl0, rows, draws, alarms = 2_000, 12_000, 6, 0
    for draw in range(draws):
        generator = np.random.default_rng(700 + draw)
        fast, steps = generator.standard_normal((2, 4_000 + rows, SENSORS))
        slow = np.sqrt(1 - 0.93**2) * lfilter([1.0], [1.0, -0.93], steps, axis=0)
        readings = fast + 0.22 * slow
        monitor = SyncMonitor(readings[:4_000], arl0=arl0)
        for packet in np.split(readings[4_000:], rows // 50):
            if monitor.update_many(packet)[-1]:
                alarms += 1
                monitor.begin_again()
    low, high = poisson.interval(0.99, draws * rows / arl0)
    assert low / 2 <= alarms <= high


def test_what_sensors_miss_together_in_the_baseline_is_usual() -> None:
    """Once in 300 rows twenty are off at once, which no simulated stream is."""
    arl0, draws, alarms = 10_000, 4, 0
    for draw in range(draws):
        generator = np.random.default_rng(800 + draw)
        readings = generator.standard_normal((15_000, 20))
        readings[generator.random(len(readings)) < 1 / 300] *= 2.0
        monitor = SyncMonitor(readings[:5_000], arl0=arl0)
        for packet in np.split(readings[5_000:], 200):
            if monitor.update_many(packet)[-1]:
                alarms += 1
                monitor.begin_again()
    assert alarms <= 4 * draws


def usual(missing: str, draw: int) -> NDArray[np.float64]:
    """Rows of five sensors that go together, with a memory, of which readings are missing."""
    generator = np.random.default_rng(900 + draw)
    rows, sensors = 300 + 500, 5
    steps = generator.standard_normal((rows, sensors)) + generator.standard_normal((rows, 1))
    readings = lfilter([1.0], [1.0, -0.4], steps, axis=0)
    gone = generator.random(readings.shape) < {"none": 0.0, "few": 0.12}.get(missing, 0.4)
    if missing == "cold":
        # What is missing goes with the temperature of the day, as modes do in frost.
        day = np.sin(2.0 * np.pi * np.arange(rows) / 24.0)[:, None]
        gone = generator.random(readings.shape) < 0.4 - 0.35 * day
    if missing == "never whole":
        gone[np.arange(rows), generator.integers(0, sensors, rows)] = True
        assert gone.any(axis=1).all()
    return np.where(gone, MISSING, readings)


@pytest.mark.parametrize("missing", ["none", "few", "many", "cold", "never whole"])
def test_false_alarms_are_no_more_frequent_whatever_is_missing(missing: str) -> None:
    """Over `arl0` rows the chance of one is 1 - 1/e."""
    arl0, draws, alarms = 500, 40, 0
    for draw in range(draws):
        rows = usual(missing, draw)
        monitor = SyncMonitor(rows[:300], arl0=arl0)
        alarms += bool(monitor.update_many(rows[300:])[-1])
    interval = binomtest(alarms, draws).proportion_ci(0.95)
    assert interval.low < 1.0 - np.exp(-1.0)
    assert interval.high > 0.3
