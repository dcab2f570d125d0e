"""What a baseline tells, and when it is refused."""

from typing import Any

import numpy as np
import pytest

from rga.detection import SyncMonitor
from rga.detection.baseline.baseline_model import Reference
from rga.detection.statistic import STATISTICS
from rga.errors import InputError
from unchanged_streams import MISSING, SENSORS, WORLDS, noise


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
def test_a_sensor_without_information_is_left_out(value: float, why: str) -> None:
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
