"""What a service raises alarms of, and what it does not: nothing of a calm stream or a restart."""

import shutil
from collections import Counter, namedtuple
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SINKS_AT
from rga.errors import InputError
from rga.operation.disk import room as disk_room
from rga.operation.inbox.account import Account
from rga.operation.inbox.refused import refused_packets
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import Number, SensorPacket
from rga.operation.service_clock import microseconds
from rga.operation.service_file import FILE_NAME
from rga.records import Record
from rga.twin import Reject
from served.alarmed_bridge import EVERY, PATIENCE, Bridge, made
from served.service_times import NOON


@pytest.fixture
def calm(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> Bridge:
    return made(tmp_path, measured_bridge, measured_record, 120, sinks=False)


@pytest.fixture(scope="module")
def sunk(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path_factory: pytest.TempPathFactory,
) -> Bridge:
    """A bridge whose bearing has sunk; `before.sqlite` is what the service knew before."""
    folder = tmp_path_factory.mktemp("sunk")
    bridge = made(folder, measured_bridge, measured_record, 120, sinks=True)
    bridge.send(60)
    assert bridge.changes == []
    bridge.service.stop()
    shutil.copy(folder / "data" / FILE_NAME, folder / "before.sqlite")
    bridge.start()
    bridge.send(60)
    return bridge


def monitor_alarms(bridge: Bridge) -> int:
    """Alarms of the monitor that the repository knows of."""
    with rga.LiveTwin(bridge.service.twins["east"].directory) as live:
        return sum(one.kind == "alarm" for one in live.twin.history().events)


def test_where_nothing_sinks_nothing_is_told(calm: Bridge) -> None:
    calm.send(120)
    assert monitor_alarms(calm) == 0
    assert calm.changes == []
    assert calm.notices == 0


def test_a_bearing_that_sinks_is_told_of_once(sunk: Bridge) -> None:
    count = Counter(sunk.changes)
    # While nobody has decided the monitor finds the same change again: that is one alarm.
    assert monitor_alarms(sunk) > 1
    assert count["gap", "alarm", "raised"] == 1
    assert count["gap", "alarm", "cleared"] == 0
    assert count["proposal", "proposal", "raised"] == 1
    assert sunk.notices == len(sunk.changes)
    first = next(one for one in reversed(sunk.service.alarms.all(10)) if one.kind == "gap")
    assert first.twin == "east"
    assert first.sensors
    assert "how often such an alarm comes without a change is not known" in first.words
    since = (first.since - NOON).total_seconds() / EVERY
    assert f"since row {since:.0f};" in first.words
    assert SINKS_AT - 5 <= since <= SINKS_AT + 20


def test_what_was_said_is_said_again_by_no_restart(sunk: Bridge) -> None:
    said = sunk.changes
    for _ in range(3):
        sunk.restart()
        sunk.look(play=True)
    assert sunk.changes == said


def test_what_a_twin_said_while_the_service_was_away_is_told_once(
    sunk: Bridge, tmp_path: Path
) -> None:
    sunk.service.stop()
    folder = shutil.copytree(sunk.folder, tmp_path / "again")
    sunk.start()
    shutil.copy(folder / "before.sqlite", folder / "data" / FILE_NAME)
    bridge = Bridge(folder, sunk.record)
    book = bridge.service.alarms
    book._tell, tell = _fails, book._tell
    bridge.look(play=False)
    assert bridge.changes == []
    assert "no room" in bridge.service.faults["east", "alarms"]
    book._tell = tell
    for _ in range(3):
        bridge.look(play=False)
    assert Counter(bridge.changes)["gap", "alarm", "raised"] == 1
    assert ("east", "alarms") not in bridge.service.faults
    assert bridge.notices == len(bridge.changes)


def test_what_is_decided_is_no_alarm_any_more(sunk: Bridge) -> None:
    said = sunk.changes
    with rga.LiveTwin(sunk.service.twins["east"].directory) as live:
        live.ask(Reject(who="Ada", why="the bearing was greased"))
        live.play()
    sunk.look(play=True)
    ends = [("proposal", "proposal", one) for one in ("acknowledged", "cleared")]
    assert sunk.changes == [*said, *ends]
    alarm = next(one for one in sunk.service.alarms.all(10) if one.kind == "proposal")
    assert (alarm.state, alarm.acknowledged_by) == ("closed", "Ada")
    assert " was rejected by Ada: a model with " in alarm.words
    assert "the bearing was greased" in [one.why for one in sunk.service.alarms.life(alarm.id)]


def _fails(*_: object) -> None:
    raise InputError("there is no room", "disk", "make some")


@pytest.mark.parametrize("restarts", [10, pytest.param(100, marks=pytest.mark.thorough)])
def test_restarts_give_no_notice(calm: Bridge, restarts: int) -> None:
    calm.send(10)
    for _ in range(restarts):
        calm.restart()
        calm.look(play=False)
        calm.clock.pass_by(50 * 60)
        calm.look(play=False)
    assert calm.changes == []
    assert calm.notices == 0
    # As long, without a restart the silence is told of.
    calm.wait(PATIENCE)
    assert calm.changes == [("source", "down", "raised")]
    calm.restart()
    calm.wait(PATIENCE + 120)
    assert calm.changes == [("source", "down", "raised")]


def test_a_source_that_is_down_is_told_of_until_it_sends(calm: Bridge) -> None:
    calm.wait(PATIENCE)
    assert calm.changes == [("source", "down", "raised")]
    calm.wait(PATIENCE)
    (alarm,) = calm.service.alarms.open()
    assert alarm.words == "source http has sent nothing for 60 min"
    assert alarm.since == NOON
    calm.send(2)
    down = [one for one in calm.changes if one[1] == "down"]
    assert down == [("source", "down", "raised"), ("source", "down", "cleared")]
    # What it kept meanwhile is old, or its clock is behind.
    assert ("source", "clock", "raised") in calm.changes


def test_what_is_refused_is_no_sign_of_life(calm: Bridge) -> None:
    for _ in range(round(PATIENCE / 60)):
        calm.service.twins["east"].receive("http", [("http", b"{}")])
        calm.wait(60)
    assert calm.changes == [("source", "down", "raised")]


def test_packets_that_never_came_are_told_of(calm: Bridge) -> None:
    calm.send(8)
    calm.send(3, skipped=1)
    assert calm.changes == []
    calm.send(8)
    assert calm.changes == [("source", "missing", "raised")]
    (alarm,) = calm.service.alarms.open()
    assert alarm.words == "source http: 1 packet never came"
    calm.receive(11)
    calm.send(2)
    assert calm.changes[-1] == ("source", "missing", "cleared")


def test_what_a_logger_sent_before_it_was_first_heard_is_no_loss(calm: Bridge) -> None:
    calm.send(8)
    calm.receive(8, known=Number("running", 7))
    calm.receive(9, known=Number("running", 8))
    calm.send(8)
    assert calm.changes == []
    assert calm.service.twins["east"].numbers("http")["running"].gaps == [(0, 6)]


def test_a_clock_that_is_ahead_is_told_of(calm: Bridge) -> None:
    calm.send(8)
    calm.receive(1000, known=Number("another", 0))
    calm.send(1)
    assert calm.changes == [("source", "clock", "raised")]
    assert "its clock is" in calm.service.alarms.open()[0].words
    calm.send(9)
    assert calm.changes == [("source", "clock", "raised"), ("source", "clock", "cleared")]


def test_a_logger_that_counts_anew_is_told_of(calm: Bridge) -> None:
    calm.send(8)
    calm.receive(8, known=Number("s", 0))
    calm.send(1)
    assert calm.changes == [("source", "numbers", "raised")]
    assert "counts anew" in calm.service.alarms.open()[0].words


def test_a_number_with_other_values_is_refused_and_the_same_written_otherwise_counts_for_nothing(
    calm: Bridge,
) -> None:
    calm.send(8)
    east, at = calm.service.twins["east"], np.array([microseconds(NOON)])

    def sent(*values: float, binary: bool = True) -> bytes:
        names = calm.record.sensors[:2]
        return write_packet(
            SensorPacket(Number("x", 0), names, at, np.array([values])), binary=binary
        )

    same, written, other = sent(1.0, np.nan), sent(1.0, np.nan, binary=False), sent(7.0, np.nan)
    outcomes = [
        east.receive("http", [("http", one)])[0] for one in (same, same, written, other, same)
    ]
    assert [fate for fate, _ in outcomes] == [
        outcomes[0][0], "duplicate", "duplicate", "refused", "duplicate",
    ]  # fmt: skip
    assert outcomes[0][0] in ("waiting", "late")
    assert outcomes[3][1] == "stream x, packet 0 came before with other content"
    assert all(one.difference == 0 for one in east.packets.account().values())
    assert refused_packets(east.inbox, 1)[0].payload == other


def test_a_sensor_that_is_silent_is_named(calm: Bridge) -> None:
    calm.send(20)

    def silent(values: np.ndarray[Any, Any]) -> None:
        values[1] = np.nan

    calm.send(20, spoil=silent)
    assert calm.changes == [("quality", "silent", "raised")]
    (alarm,) = calm.service.alarms.open()
    assert alarm.sensors == (calm.record.sensors[1],)
    calm.restart()
    calm.send(5, spoil=silent)
    assert len(calm.changes) == 1
    calm.send(12)
    assert calm.changes[1:] == [("quality", "silent", "cleared")]


def test_channels_that_are_not_used_are_told_of_once(calm: Bridge) -> None:
    calm.send(8)
    assert calm.changes == []
    names, values = ("D1", "D77"), np.array([[0.0, 1.0]])
    for number in range(5):
        calm.clock.pass_by(60)
        times = np.array([microseconds(calm.clock.now())])
        packet = SensorPacket(Number("another", number), names, times, values)
        calm.service.twins["east"].receive("http", [("http", write_packet(packet, binary=True))])
        calm.look(play=False)
    assert calm.changes == [("quality", "refused", "raised")]
    (alarm,) = calm.service.alarms.open()
    assert alarm.words.startswith("source http: 1 channel is not used: D77 (")
    calm.send(8)
    assert [one for one in calm.changes if one[1] == "refused"] == [
        ("quality", "refused", "raised")
    ]


@pytest.mark.parametrize("unknown", [True, False])
def test_quality_is_told_of_at_once_after_a_start_and_once(calm: Bridge, unknown: bool) -> None:
    names = (calm.record.sensors[0], "D77" if unknown else calm.record.sensors[1])
    told = [("quality", "refused", "raised")] if unknown else []
    for start in range(3):
        for number in range(3):
            calm.clock.pass_by(60)
            times = np.array([microseconds(calm.clock.now())])
            known = Number(f"start{start}", number)
            packet = write_packet(SensorPacket(known, names, times, np.array([[0.0, 1.0]])))
            calm.service.twins["east"].receive("http", [("http", packet)])
            calm.look(play=False)
        assert calm.changes == told
        calm.restart()
    # Nothing has come since: whether all is well nobody knows, and no alarm is cleared for that.
    calm.wait(PATIENCE - 60)
    assert calm.changes == told


@pytest.mark.parametrize("is_wrong", [True, False])
def test_a_range_that_is_left_is_told_of_right_after_a_restart(
    calm: Bridge, is_wrong: bool
) -> None:
    def spoil(values: np.ndarray[Any, Any]) -> None:
        values[-1] = 1e6 if is_wrong else values[-1]

    calm.send(20)
    calm.send(5, spoil=spoil)
    assert calm.changes == []
    told = [("quality", "out of range", "raised")] if is_wrong else []
    for _ in range(3):
        calm.restart()
        # Half an hour, of an hour of patience.
        calm.send(3, spoil=spoil)
        assert calm.changes == told


def test_a_packet_of_which_nothing_is_known_is_told_of(calm: Bridge) -> None:
    calm.send(20)
    assert calm.changes == []
    account = {("http", 0): Account(received=5, used=4), ("http", 1): Account(duplicate=1)}
    packets = calm.service.twins["east"].packets
    packets.account, sound = lambda: account, packets.account  # type: ignore[method-assign]
    calm.wait(900)
    assert calm.changes == [("service", "account", "raised")]
    (alarm,) = calm.service.alarms.open()
    assert alarm.words.startswith("source http: of 2 packets nothing is known")
    packets.account = sound  # type: ignore[method-assign]
    calm.send(3)
    assert calm.changes[1:] == [("service", "account", "cleared")]


def test_a_twin_that_is_not_played_lags_and_is_told_why(calm: Bridge) -> None:
    calm.send(8)
    for _ in range(50):
        calm.clock.pass_by(EVERY)
        calm.receive(calm.sent)
        calm.sent += 1
        calm.look(play=False)
    assert calm.changes == [("service", "lag", "raised")]
    east = calm.service.twins["east"].directory
    calm.service.workers._told["watch"] = {east: "its repository is damaged"}
    for _ in range(3):
        calm.clock.pass_by(60)
        calm.look(play=False)
    parked = next(one for one in calm.service.alarms.open() if one.cause == "parked")
    assert parked.words == "the twin is not played: its repository is damaged"
    calm.service.workers._told["watch"] = {}
    calm.send(3)
    assert set(calm.changes[2:]) == {
        ("service", "lag", "cleared"),
        ("service", "parked", "cleared"),
    }


def test_a_disk_that_is_nearly_full_is_told_of(
    calm: Bridge, monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = namedtuple("usage", "total used free")
    room = [20]
    monkeypatch.setattr(
        disk_room.shutil, "disk_usage", lambda _: usage(100, 100 - room[0], room[0])
    )
    calm.send(10)
    assert calm.changes == []
    room[0] = 9
    calm.send(3)
    assert calm.changes == [("service", "disk", "raised")]
    assert calm.service.alarms.open()[0].twin is None
    room[0] = 11
    calm.send(3)
    assert calm.changes[1:] == [("service", "disk", "cleared")]


def test_a_twin_that_cannot_be_read_keeps_no_other_from_being_looked_at(calm: Bridge) -> None:
    calm.service.stop()
    bridge = Bridge(calm.folder, calm.record, ("west", "east"))
    bridge.send(9)
    west = bridge.service.twins["west"].directory / "twin.sqlite"
    west.write_bytes(b"no repository" * 1000)
    bridge.wait(2 * PATIENCE)
    found = {(one.twin, one.kind, one.cause) for one in bridge.service.alarms.open()}
    assert found == {
        ("west", "service", "repository"),
        ("west", "source", "down"),
        ("east", "source", "down"),
    }
