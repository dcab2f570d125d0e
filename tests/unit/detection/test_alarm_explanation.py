"""What an alarm tells: sizes in the unit of the readings, sensors, a sentence."""

import numpy as np
import pytest

from rga.detection import Alarm, SyncMonitor

SENSORS = 20


def test_the_size_of_a_change_is_in_the_unit_of_the_readings() -> None:
    generator = np.random.default_rng(0)
    rows = 20.0 + 0.1 * generator.normal(size=(1500, 3))
    quiet = SyncMonitor(rows[:1000], arl0=10_000)
    assert not quiet.update_many(rows[1000:]).any()
    rows[1200:, 1] += 0.15
    monitor = SyncMonitor(rows[:1000], arl0=10_000)
    monitor.update_many(rows[1000:])
    alarm = monitor.alarm
    assert alarm is not None
    assert alarm.sensors == (1,)
    assert alarm.change[0] == pytest.approx(0.15, abs=0.03)


def test_a_sensor_that_is_not_read_has_not_changed() -> None:
    generator = np.random.default_rng(0)
    rows = generator.normal(size=(1300, SENSORS))
    rows[1090:, 5] = np.nan
    quiet = SyncMonitor(rows[:1000], arl0=10_000)
    assert not quiet.update_many(rows[1000:]).any()
    rows[1100:] += 1.0
    monitor = SyncMonitor(rows[:1000], arl0=10_000)
    monitor.update_many(rows[1000:])
    alarm = monitor.alarm
    assert alarm is not None
    assert sorted(alarm.sensors) == [one for one in range(SENSORS) if one != 5]


def test_it_is_reported_in_a_sentence() -> None:
    alarm = Alarm(12, "", "step", (3,), (1.0,), (2.0,), 10, (8, 11))
    assert alarm.sentence() == (
        "a step in sensor 3 since row 10 (8 to 11); one bad sensor would look like this"
    )
    many = Alarm(12, "", "variance", (3, 0, 1, 2, 5), (1.0,) * 5, (2.0,) * 5, 10, (8, 11))
    names = tuple("abcdef")
    assert many.sentence(names) == (
        "a change of variance in d, a, b, c and 1 more since row 10 (8 to 11)"
    )
