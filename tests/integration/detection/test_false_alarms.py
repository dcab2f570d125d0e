"""False alarms of the monitor: as rare as asked, whatever dies or goes missing."""

import numpy as np
import pytest
from scipy.stats import binomtest

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
