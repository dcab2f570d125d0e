"""The monitor: what it finds beside its null twin, how rare false alarms are, how it restarts."""

import pickle
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.stats import binomtest

from monitored_worlds import BASELINE, SENSORS, WORLDS, Rows, noise
from rga.detection import SyncMonitor, rows_between
from rga.errors import InputError

MISSING = float("nan")


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


@pytest.mark.parametrize("world", WORLDS)
def test_false_alarms_are_as_rare_as_asked(world: str) -> None:
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


def stream_of(memory: float, common: float, gaps: bool, dead: bool, seed: int) -> Rows:
    """With a change in the last third, and a sensor more than the rest that may be dead."""
    generator = np.random.default_rng(seed)
    rows = generator.normal(size=(500, 3)) + common * generator.normal(size=(500, 1))
    for row in range(4, len(rows)):
        rows[row] += memory * (0.5 * rows[row - 1] + 0.3 * rows[row - 4])
    rows[430:, 0] += 4.0
    if gaps:
        rows[generator.random(rows.shape) < 0.1] = MISSING
    if dead:
        rows[350:, 2] = MISSING
    return rows


@settings(deadline=None, max_examples=40)
@given(
    memory=st.sampled_from([0.0, 0.6, 1.0]),
    common=st.sampled_from([0.0, 1.5]),
    gaps=st.booleans(),
    dead=st.booleans(),
    seed=st.integers(0, 20),
    cuts=st.sets(st.integers(300, 500), max_size=5),
)
def test_cuts_and_restarts_leave_the_same_bits(
    memory: float, common: float, gaps: bool, dead: bool, seed: int, cuts: set[int]
) -> None:
    rows = stream_of(memory, common, gaps, dead, seed)
    monitors = [SyncMonitor(rows[:300], arl0=200) for _ in range(3)]
    one_by_one, in_parts, stored = monitors
    alarms = np.array([one_by_one.update(row) for row in rows[300:]])
    for start, end in pairwise([300, *sorted(cuts), 500]):
        in_parts = pickle.loads(pickle.dumps(in_parts))
        stored = SyncMonitor.from_bytes(stored.to_bytes())
        for monitor in (in_parts, stored):
            found = monitor.update_many(rows[start:end])
            assert np.array_equal(found, alarms[start - 300 : end - 300])
    assert in_parts.to_bytes() == stored.to_bytes() == one_by_one.to_bytes()
    assert in_parts.alarm == stored.alarm == one_by_one.alarm
    assert stored.doubts == one_by_one.doubts
    assert (stored.rows, stored.arl0) == (200, 200.0)


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
    with pytest.raises(InputError, match="the seed is -1"):
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
    told = []
    for chunk in (9000, 700):
        one = pickle.loads(pickle.dumps(monitor))
        for first in range(0, len(stream), chunk):
            one.update_many(stream[first : first + chunk])
        told.append(one.alarm)
    assert told[0] == told[1]
    assert told[0] is not None
    assert told[0].since_ci90[0] <= told[0].since <= told[0].since_ci90[1] <= told[0].row
    assert abs(told[0].since - 300) < 10
    one.begin_again()
    assert one.alarm is None


@pytest.mark.parametrize("sensors", [1, 3])
def test_a_logger_that_is_silent_raises_no_alarm(sensors: int) -> None:
    monitor = SyncMonitor.known(sensors, arl0=500)
    assert not monitor.update_many(np.full((3000, sensors), np.nan)).any()


def test_sensors_that_repeat_others_are_doubted() -> None:
    rows = np.random.default_rng(1).normal(size=(400, 4))
    assert SyncMonitor(rows, arl0=500).doubts == ()
    copied = np.c_[rows, rows[:, 1]]
    (doubt,) = SyncMonitor(copied, arl0=500).doubts
    assert doubt.startswith("sensors 1, 4 read nearly what others of them read")


def test_coarse_readings_are_doubted() -> None:
    rows = np.random.default_rng(2).normal(size=(400, 2))
    coarse = np.c_[rows[:, 0], np.round(rows[:, 1] / 2.0)]
    assert "sensor 1 reads mostly one value" in " ".join(SyncMonitor(coarse, arl0=500).doubts)


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
