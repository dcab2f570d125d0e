"""What a baseline tells, when it is doubted, and when it is refused."""

from typing import Any

import numpy as np
import pytest

from monitored_worlds import BASELINE, SENSORS, WORLDS, Rows, noise
from rga.detection import SyncMonitor
from rga.detection.baseline.baseline_model import Reference
from rga.detection.statistic import STATISTICS
from rga.errors import InputError

MISSING = float("nan")


def doubted(rows: Rows) -> bool:
    return bool(SyncMonitor(rows, arl0=1000).doubts)


@pytest.mark.parametrize("world", WORLDS)
def test_a_stationary_baseline_is_not_doubted(world: str) -> None:
    """One in a hundred may be."""
    assert sum(doubted(noise(world, BASELINE, seed)) for seed in range(40)) <= 3


def test_many_sensors_that_go_together_are_doubted_only_where_one_changes() -> None:
    generator = np.random.default_rng(4)
    for _ in range(6):
        rows = generator.normal(size=(1000, 84)) + generator.normal(size=(1000, 1))
        assert not doubted(rows)
        rows[500:, 3] += 1.0
        assert doubted(rows)


def drift(rows: Rows) -> None:
    rows[:, 2] += np.linspace(0.0, 2.5, len(rows)) * rows[:, 2].std()


def long_drift(rows: Rows) -> None:
    rows[:, 2] += np.linspace(0.0, 10.0, len(rows)) * rows[:, 2].std()


def step(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] += 1.5 * rows[:, 2].std()


def high_step(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] += 10.0 * rows[:, 2].std()


def louder(rows: Rows) -> None:
    rows[len(rows) // 2 :, 2] *= 2.0


@pytest.mark.parametrize("world", ["white", "heavy tails", "correlated"])
@pytest.mark.parametrize("change", [drift, long_drift, step, high_step, louder])
def test_a_baseline_that_changes_is_doubted(world: str, change: Any) -> None:
    found = 0
    for seed in range(10):
        rows = noise(world, BASELINE, seed)
        change(rows)
        found += doubted(rows)
    assert found >= 8


def test_a_baseline_that_wanders_is_doubted() -> None:
    walks = [np.cumsum(noise("white", BASELINE, seed), axis=0) for seed in range(10)]
    assert sum(doubted(walk) for walk in walks) >= 6


@pytest.mark.parametrize("world", [*WORLDS, "few digits"])
def test_scores_are_standard_normal_and_independent(world: str) -> None:
    rows = noise(world.replace("few digits", "white"), 2 * 2000, 3)
    if world == "few digits":
        rows = np.round(2 * rows) / 2
    statistics = Reference.learn(rows[:2000]).statistics(np.full(len(STATISTICS), np.inf), 2000)
    statistics.update_many(rows[2000:])
    scores = statistics.recent()[10:]
    assert np.abs(scores.mean(axis=0)).max() < 0.15
    assert np.abs(scores.std(axis=0) - 1.0).max() < 0.1
    off = np.corrcoef(np.hstack([scores[1:], scores[:-1]]).T) - np.eye(2 * SENSORS)
    assert np.abs(off).max() < 0.13


def test_gaps_do_not_change_what_is_learned() -> None:
    rows = noise("all", 4000, 1)
    gaps = rows.copy()
    gaps[np.random.default_rng(0).random(rows.shape) < 0.2] = MISSING
    whole, parts = Reference.learn(rows), Reference.learn(gaps)
    assert np.abs(whole.mixing - parts.mixing).max() < 0.15
    assert np.abs(whole.weights.sum(axis=0) - parts.weights.sum(axis=0)).max() < 0.2
    assert np.abs(whole.units / parts.units - 1.0).max() < 0.2


@pytest.mark.parametrize(
    ("rows", "sensors"), [(60, 84), (30, 1), (30, 6), (60, 1), (400, 1), (35, 20)]
)
def test_short_and_narrow_baselines_are_learned(rows: int, sensors: int) -> None:
    generator = np.random.default_rng(3)
    alarms = 0
    for _ in range(10):
        readings = generator.normal(size=(rows + 300, sensors))
        monitor = SyncMonitor(readings[:rows], arl0=3_000)
        alarms += bool(monitor.update_many(readings[rows:])[-1])
    assert alarms <= 5


def test_readings_that_are_mostly_missing_are_learned() -> None:
    rows = noise("white", 600, 3)
    rows[np.random.default_rng(0).random(rows.shape) < 0.9] = MISSING
    reference = Reference.learn(rows)
    assert reference.weights.shape == (0, SENSORS)
    assert np.isfinite(reference.mixing).all()


def test_outliers_of_a_baseline_weigh_little() -> None:
    rows = noise("correlated", 1000, 2)
    spoiled = rows.copy()
    spoiled[[3, 500], [0, 4]] = 1e9, -1e9
    plain, other = Reference.learn(rows), Reference.learn(spoiled)
    assert np.abs(plain.mixing - other.mixing).max() < 0.05
    assert np.abs(plain.units / other.units - 1.0).max() < 0.05


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (np.ones(5), "its shape must be"),
        (np.ones((5, 0)), "its shape must be"),
        (np.ones((3, 2)), "as to sensor 0, it has 3 readings in the baseline, fewer than 30"),
        (np.zeros((0, 2)), "as to sensor 0, it has 0 readings"),
        (np.ones((50, 2)), "as to sensor 0, its readings in the baseline are all alike"),
        ([["a", "b"]], "give an array of numbers"),
        ([[1.0, 2.0], [3.0]], "give an array of numbers"),
        (None, "its shape must be"),
    ],
)
def test_what_is_no_baseline_is_refused(rows: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        SyncMonitor(rows)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (float("inf"), "the value is inf .row 0 of the baseline, sensor 2"),
        (1e61, "the value is 1e.61"),
    ],
)
def test_a_number_that_is_none_of_a_sensors_is_named(value: float, words: str) -> None:
    rows = noise("white", 100, 0)
    rows[:, 2] = value
    with pytest.raises(InputError, match=words):
        SyncMonitor(rows)


@pytest.mark.parametrize(("value", "why"), [(MISSING, "0 readings"), (7.0, "all alike")])
def test_a_sensor_that_tells_nothing_is_left_out(value: float, why: str) -> None:
    """The others are watched as if it were not there, under their own numbers."""
    baseline, stream = noise("white", 200, 0), noise("white", 60, 1)
    stream[20:, 3] += 5.0
    without = SyncMonitor(np.delete(baseline, 2, axis=1))
    expected = without.update_many(np.delete(stream, 2, axis=1))
    baseline[:, 2] = value
    monitor = SyncMonitor(baseline)
    assert list(monitor.unwatched) == [2]
    assert why in monitor.unwatched[2]
    stream[:, 2] = 1e9
    again = SyncMonitor.from_bytes(monitor.to_bytes())
    for one in (monitor, again):
        assert np.array_equal(one.update_many(stream), expected)
        assert one.alarm is not None
        assert one.alarm.sensors == (3,)
        assert one.unwatched == monitor.unwatched
    with pytest.raises(InputError, match="row 60 of the stream, sensor 1"):
        monitor.update([0.0, float("inf"), *stream[0, 2:]])
    with pytest.raises(InputError, match="its shape must be"):
        monitor.update_many(np.delete(stream, 2, axis=1))
