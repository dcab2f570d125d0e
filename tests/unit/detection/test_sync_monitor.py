"""The monitor: what it finds beside its null twin, how it begins again, what it refuses."""

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rga.detection import SyncMonitor, rows_between
from rga.errors import InputError
from unchanged_streams import BASELINE, MISSING, SENSORS, Rows, noise


def hidden_step(stream: Rows) -> None:
    stream[:, 3] += 1.5


def hidden_step_in_few(stream: Rows) -> None:
    stream[:, [1, 3, 4]] -= 1.0


def hidden_step_alike(stream: Rows) -> None:
    stream += 0.7


def hidden_drift(stream: Rows) -> None:
    stream[:, 3] += 0.01 * np.arange(len(stream))


def hidden_noise(stream: Rows) -> None:
    stream[:, 3] *= 2.5


def hidden_quiet(stream: Rows) -> None:
    stream[:, 3] *= 0.2


def hidden_stuck(stream: Rows) -> None:
    stream[:, 3] = 0.1


CHANGES = [
    (hidden_step, "step", (3,)),
    (hidden_step_in_few, "step", (1, 3, 4)),
    (hidden_step_alike, "step", tuple(range(SENSORS))),
    (hidden_drift, "drift", (3,)),
    (hidden_noise, "variance", (3,)),
    (hidden_quiet, "variance", (3,)),
    (hidden_stuck, "variance", (3,)),
]
ONSET = 200


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(("hide", "kind", "sensors"), CHANGES)
def test_a_change_is_found_and_its_null_twin_is_not(
    hide: Any, kind: str, sensors: tuple[int, ...], seed: int
) -> None:
    rows = noise("white", 800 + ONSET + 250, seed)
    baseline, quiet = rows[:800], rows[800:]
    twin = SyncMonitor(baseline, arl0=20_000)
    assert not twin.update_many(quiet).any()
    assert twin.alarm is None
    changed = quiet.copy()
    hide(changed[ONSET:])
    monitor = SyncMonitor(baseline, arl0=20_000)
    alarms = monitor.update_many(changed)
    assert not alarms[:ONSET].any()
    assert alarms[-1]
    alarm = monitor.alarm
    assert alarm is not None
    assert alarm.row == np.argmax(alarms)
    assert alarm.kind == kind
    # One sensor may be named by chance, behind those that have changed.
    assert sorted(alarm.sensors[: len(sensors)]) == list(sensors)
    assert len(alarm.sensors) <= len(sensors) + 1
    first, last = alarm.since_ci90
    assert first <= alarm.since <= last <= alarm.row
    # Nine in ten intervals hold the onset; none is far off.
    assert first - 15 <= ONSET <= last + 15


def test_a_dead_sensor_does_not_hide_the_others() -> None:
    rows = noise("correlated", BASELINE + 200, 5)
    rows[BASELINE + 50 :, 1] = MISSING
    rows[BASELINE + 100 :, 3] += 3.0
    monitor = SyncMonitor(rows[:BASELINE], arl0=10_000)
    alarms = monitor.update_many(rows[BASELINE:])
    assert not alarms[:100].any()
    assert alarms[-1]
    assert monitor.alarm is not None
    assert monitor.alarm.sensors[0] == 3
    assert 1 not in monitor.alarm.sensors


def test_the_same_seed_gives_the_same_bits() -> None:
    rows = noise("white", 300, 0)
    same = [SyncMonitor(rows, arl0=300, seed=seed).to_bytes() for seed in (4, 4)]
    assert same[0] == same[1]
    assert SyncMonitor(rows, arl0=300, seed=5).to_bytes() != same[0]


def test_any_layout_is_read() -> None:
    rows = np.round(8 * noise("white", 400, 3)) / 8
    assert not SyncMonitor(rows[:300], arl0=300).update_many(rows[300:]).any()
    rows[390:, 1] += 8
    expected = SyncMonitor(rows[:300], arl0=300)
    alarms = expected.update_many(rows[300:])
    assert alarms[-1]
    wide = np.repeat(rows, 2, axis=1)
    for same in (rows.tolist(), rows.astype(np.float32), np.asfortranarray(rows), wide[:, ::2]):
        monitor = SyncMonitor(same[:300], arl0=300)
        assert np.array_equal(monitor.update_many(same[300:]), alarms)
        assert monitor.to_bytes() == expected.to_bytes()
    assert expected.update_many(np.zeros((0, SENSORS))).shape == (0,)


def alarms_of(rows: Rows) -> NDArray[np.bool_]:
    return SyncMonitor(rows[:300], arl0=1000).update_many(rows[300:])


def test_scale_and_level_do_not_matter() -> None:
    rows = noise("white", 500, 3)
    assert not alarms_of(rows).any()
    rows[400:, 2] += 1.5
    alarms = alarms_of(rows)
    assert alarms[-1]
    assert np.array_equal(alarms_of(1e4 + 1e-2 * rows), alarms)
    assert np.array_equal(alarms_of(-1e9 + 1e12 * rows), alarms)


def test_outliers_do_not_blind() -> None:
    """Beside the same stream without them, which raises no alarm before the change either."""
    rows = noise("white", 1000, 7)
    rows[900:, 2] += 2.0
    for places in ([], [20, 100], [20, 750]):
        spoiled = rows.copy()
        spoiled[places, 2] = 1e9
        alarms = SyncMonitor(spoiled[:700], arl0=10_000).update_many(spoiled[700:])
        assert not alarms[:200].any()
        assert alarms[230]


def test_it_begins_again() -> None:
    rows = noise("white", 500, 4)
    monitor, fresh = (SyncMonitor(rows[:300], arl0=10_000) for _ in range(2))
    assert monitor.update_many(rows[300:400] + 5.0)[-1]
    assert not fresh.update_many(rows[300:400]).any()
    monitor.begin_again()
    assert monitor.alarm is None
    assert not monitor.update_many(rows[400:]).any()
    assert monitor.rows == 200


def test_a_monitor_of_what_is_known() -> None:
    stream = noise("white", 400, 8)
    assert not SyncMonitor.known(SENSORS, arl0=10_000).update_many(stream).any()
    stream[200:, 1] += 1.5
    monitor = SyncMonitor.known(SENSORS, arl0=10_000)
    assert not monitor.update_many(stream[:200]).any()
    assert monitor.update_many(stream[200:])[-1]
    assert monitor.alarm is not None
    assert monitor.alarm.sensors == (1,)


@pytest.mark.parametrize("arl0", [0, -1.0, 99.9, MISSING, float("inf"), 1e13])
def test_other_rates_are_refused(arl0: float) -> None:
    with pytest.raises(InputError, match="arl0 is"):
        SyncMonitor(noise("white", 100, 0), arl0=arl0)
    with pytest.raises(InputError, match="arl0 is"):
        SyncMonitor.known(2, arl0=arl0)


def test_other_arguments_are_refused() -> None:
    with pytest.raises(InputError, match="-1 is no seed"):
        SyncMonitor.known(2, arl0=200, seed=-1)
    with pytest.raises(InputError, match="0 sensors"):
        SyncMonitor.known(0)


@pytest.mark.parametrize("rows", [1.0, [1.0, 2.0], [[1.0, 2.0, 3.0]], np.ones((1, 1, 2))])
def test_other_shapes_are_refused(rows: Any) -> None:
    with pytest.raises(InputError, match=r"its shape must be \[n, "):
        SyncMonitor.known(2, arl0=200).update_many(rows)


@pytest.mark.parametrize("row", [1.0, [1.0], [[1.0, 2.0]], ["high", "low"]])
def test_other_rows_are_refused(row: Any) -> None:
    with pytest.raises(InputError):
        SyncMonitor.known(2, arl0=200).update(row)


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), 1e61])
def test_infinite_values_are_refused_and_leave_no_trace(value: float) -> None:
    monitor = SyncMonitor.known(SENSORS, arl0=200)
    monitor.update_many(noise("white", 2, 0))
    before = monitor.to_bytes()
    rows = noise("white", 5, 1)
    rows[3, 1] = value
    with pytest.raises(InputError, match="row 5 of the stream, sensor 1"):
        monitor.update_many(rows)
    assert monitor.to_bytes() == before


def test_foreign_bytes_are_refused() -> None:
    state = SyncMonitor.known(2, arl0=200).to_bytes()
    head, _, rest = state.partition(b"\n")
    heads = (b"{}", b"[]", b"[" * 100_000, b"\xff", b"7", head.replace(b"1.0, ", b""))
    spoiled = [one + b"\n" + rest for one in heads]
    endless = state.replace(b'"seed": 0', b'"seed": Infinity')
    for other in (b"", b"rga", state[:-4], state + b"\0", head, rest, endless, *spoiled):
        with pytest.raises(InputError, match="to_bytes"):
            SyncMonitor.from_bytes(other)


def test_rows_between_false_alarms() -> None:
    assert rows_between(1, per="hour", rate=1.0) == 3600
    assert rows_between(2, per="day", rate=10.0) == 432_000
    assert rows_between(12, per="year", rate=1.0) == rows_between(1, per="month", rate=1.0)
    for arguments in ({"alarms": 0}, {"alarms": MISSING}, {"rate": -1.0}, {"per": "fortnight"}):
        given: dict[str, Any] = {"alarms": 1, "per": "day", "rate": 1.0, **arguments}
        with pytest.raises(InputError, match="give"):
            rows_between(**given)
    for alarms, rate in ((1e-320, 1.0), (1.0, 1e308), (1000.0, 1e-3)):
        with pytest.raises(InputError, match="100 to 1e\\+12 are possible"):
            rows_between(alarms, per="day", rate=rate)


def test_an_alarm_stays_explained_by_the_rows_around_it() -> None:
    """However many rows come behind it, and in whatever chunks."""
    generator = np.random.default_rng(0)
    monitor = SyncMonitor(generator.normal(size=(500, 3)), arl0=2000)
    stream = generator.normal(size=(9000, 3))
    quiet = pickle.loads(pickle.dumps(monitor))
    assert not quiet.update_many(stream[:400]).any()
    assert quiet.alarm is None
    stream[300:, 1] += 2.0
    alarms = []
    for chunk in (9000, 700):
        one = pickle.loads(pickle.dumps(monitor))
        for first in range(0, len(stream), chunk):
            one.update_many(stream[first : first + chunk])
        alarms.append(one.alarm)
    assert alarms[0] == alarms[1]
    assert alarms[0] is not None
    assert alarms[0].since_ci90[0] <= alarms[0].since <= alarms[0].since_ci90[1] <= alarms[0].row
    assert abs(alarms[0].since - 300) < 10
    one.begin_again()
    assert one.alarm is None


@pytest.mark.parametrize("sensors", [1, 3])
def test_a_logger_that_is_silent_raises_no_alarm(sensors: int) -> None:
    monitor = SyncMonitor.known(sensors, arl0=500)
    assert not monitor.update_many(np.full((3000, sensors), np.nan)).any()


def test_sensors_that_repeat_others_are_warned_of() -> None:
    rows = np.random.default_rng(1).normal(size=(400, 4))
    assert SyncMonitor(rows, arl0=500).warnings == ()
    copied = np.c_[rows, rows[:, 1]]
    (warning,) = SyncMonitor(copied, arl0=500).warnings
    assert warning.startswith("sensors 1, 4 read nearly what others of them read")
    (warning,) = SyncMonitor(copied, arl0=500, names="abcde").warnings
    assert warning.startswith("sensors b, e read nearly what others of them read")
    with pytest.raises(InputError, match="2 names of 5 sensors"):
        SyncMonitor(copied, arl0=500, names="ab")


def test_coarse_readings_are_warned_of() -> None:
    rows = np.random.default_rng(2).normal(size=(400, 2))
    coarse = np.c_[rows[:, 0], np.round(rows[:, 1] / 2.0)]
    assert "sensor 1 reads mostly one value" in " ".join(SyncMonitor(coarse, arl0=500).warnings)


def test_masked_readings_are_missing() -> None:
    rows = np.random.default_rng(3).normal(size=(200, 2))
    monitor = SyncMonitor(rows, arl0=500)
    again = pickle.loads(pickle.dumps(monitor))
    stream = np.random.default_rng(4).normal(size=(100, 2))
    stream[::3, 0] = np.nan
    monitor.update_many(stream)
    again.update_many(np.ma.masked_invalid(stream))
    assert again.to_bytes() == monitor.to_bytes()


@pytest.mark.parametrize(
    "made",
    [
        lambda rows: SyncMonitor(rows, arl0="x"),
        lambda rows: SyncMonitor(rows, arl0=None),
        lambda rows: SyncMonitor(rows, seed=1.5),
        lambda rows: SyncMonitor(rows + 1j),
        lambda rows: SyncMonitor(rows.astype("M8[s]")),
        lambda rows: SyncMonitor(rows.astype(str)),
        lambda rows: SyncMonitor.known("3"),  # type: ignore[arg-type]
        lambda rows: SyncMonitor.known(10**9),
        lambda rows: SyncMonitor.from_bytes("state"),  # type: ignore[arg-type]
        lambda rows: rows_between("1", per="month", rate=1.0),  # type: ignore[arg-type]
        lambda rows: rows_between(1, per=["day"], rate=1.0),  # type: ignore[arg-type]
    ],
)
def test_what_is_of_another_type_is_refused(made: Callable[[Rows], Any]) -> None:
    with pytest.raises(InputError):
        made(np.random.default_rng(5).normal(size=(60, 2)))


def test_a_seed_that_was_drawn_is_kept() -> None:
    rows = np.random.default_rng(6).normal(size=(60, 2))
    monitor = SyncMonitor(rows, arl0=500, seed=np.int64(3))
    assert pickle.dumps(monitor) == pickle.dumps(SyncMonitor(rows, arl0=500, seed=3))
