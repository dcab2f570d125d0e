"""Rows of packets: what comes of the same samples is the same, however they arrived."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model, read_model
from rga.operation.inbox.account import Account
from rga.operation.inbox.packets import Packets
from rga.operation.packets.formats import StatedFormat
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import MICROSECONDS, Number, SensorPacket
from rga.operation.packets.topics import TopicPattern
from rga.operation.rows.grid import Grid
from rga.operation.rows.samples import Reader
from rga.operation.rows.sealing import Sealing
from rga.operation.sources.arrivals import arrival_of
from rga.operation.sources.clock import ClockRule, ClockWatch
from rga.records.mapping import Channel, RecordMapping, TimeColumns
from rga.twin.hardware.inbox import Inbox

#: 2026-11-23T00:00:00Z
MIDNIGHT = 1_795_392_000_000_000
MINUTE = 60 * MICROSECONDS
CHANNELS = ("D1", "D2", "temperature")
#: seconds between samples, and how many there are
STEP, COUNT = 7, 200


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


class Twin:
    """An inbox that is closed and opened again as often as one likes."""

    def __init__(
        self,
        folder: Path,
        model: Model,
        mappings: dict[str, RecordMapping],
        stated: StatedFormat | None = None,
    ) -> None:
        self._folder, self._model = folder, model
        self.readers = {name: Reader(name, model, one, stated) for name, one in mappings.items()}
        self.start()

    def start(self) -> None:
        self.inbox = Inbox(self._folder)
        grid = Grid(every=MINUTE, lateness=2 * MINUTE)
        self.packets = Packets(self.inbox, grid, self.readers)
        self.sealing = Sealing(self.inbox, self.packets, self._model, self.readers, grid)

    def send(
        self,
        source: str,
        payload: bytes,
        arrived: int = MIDNIGHT,
        where: str = "a test",
        clock: ClockWatch | None = None,
    ) -> str:
        one = arrival_of(payload, arrived, where, self.readers[source], clock)
        return self.packets.receive(source, [one])[0][0]

    def rows(self) -> np.ndarray:
        station = self.inbox.station
        assert station is not None
        packet = self.inbox.packet(station, 0, 10_000)
        return np.column_stack([packet.time, packet.readings, packet.contexts])


@pytest.fixture
def twin(tmp_path: Path, model: Model) -> Twin:
    return Twin(tmp_path, model, {"logger": RecordMapping()})


def readings() -> np.ndarray:
    return np.random.default_rng(5).normal(size=(COUNT, len(CHANNELS)))


def payloads(values: np.ndarray, size: int = 5) -> list[bytes]:
    times = MIDNIGHT + STEP * MICROSECONDS * np.arange(len(values))
    return [
        write_packet(
            SensorPacket(
                Number("s", k // size), CHANNELS, times[k : k + size], values[k : k + size]
            ),
            binary=bool(k % 2),
        )
        for k in range(0, len(values), size)
    ]


def test_a_row_is_the_mean_of_its_cell(twin: Twin, model: Model) -> None:
    values = readings()
    for payload in payloads(values):
        assert twin.send("logger", payload) == "waiting"
    # The last sample is of second 1393: rows end two minutes before.
    assert twin.sealing.seal(twin.packets.latest(), silent=()) == 21
    rows = twin.rows()
    station = twin.inbox.station
    assert station is not None
    assert station.start == "2026-11-23T00:00:00+00:00"
    assert (station.channels, station.measured) == (tuple(model.sensors), ("temperature",))
    np.testing.assert_array_equal(rows[:, 0], 60.0 * np.arange(21))
    cell = STEP * np.arange(COUNT) // 60
    for k in range(21):
        mean = values[cell == k].mean(axis=0)
        np.testing.assert_allclose(rows[k, [1, 2, -1]], mean, rtol=1e-12)
    assert np.isnan(rows[:, 3:-1]).all()
    # Nothing is left to wait for where the logger is silent.
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) == 3
    assert sum(twin.packets.account().values(), Account()) == Account(received=40, used=40)


@pytest.mark.parametrize(
    "seed", [0, 1, *(pytest.param(k, marks=pytest.mark.thorough) for k in range(2, 8))]
)
def test_rows_do_not_hang_on_how_packets_arrived(
    seed: int, tmp_path: Path, model: Model, twin: Twin
) -> None:
    values = readings()
    for payload in payloads(values):
        twin.send("logger", payload)
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    draw = random.Random(seed)
    (tmp_path / "other").mkdir()
    other = Twin(tmp_path / "other", model, {"logger": RecordMapping()})
    sent = payloads(values, size=draw.choice([1, 3, 8]))
    # Each at most two minutes behind others of later times, and some of them again.
    late = [(k + draw.uniform(0, 120 / (STEP * 8)), one) for k, one in enumerate(sent)]
    late += [(k + draw.uniform(0, 5), one) for k, one in enumerate(sent) if draw.random() < 0.2]
    for _, payload in sorted(late, key=lambda one: one[0]):
        assert other.send("logger", payload) != "late"
        if draw.random() < 0.3:
            other.sealing.seal(other.packets.latest(), silent=())
        if draw.random() < 0.3:
            other.start()
    other.sealing.seal(other.packets.latest(), silent=["logger"])
    np.testing.assert_array_equal(other.rows(), twin.rows())
    account = sum(other.packets.account().values(), Account())
    assert account == Account(len(late), used=len(sent), duplicate=len(late) - len(sent))


def test_what_comes_after_its_row_is_late(twin: Twin) -> None:
    sent = payloads(readings())
    twin.send("logger", sent[-1])
    twin.sealing.seal(twin.packets.latest(), silent=())
    twin.send("logger", sent[-2])
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) == 2
    assert twin.send("logger", sent[0]) == "late"
    account = sum(twin.packets.account().values(), Account())
    assert account == Account(received=3, used=2, late=1)


@pytest.mark.parametrize("sealed_before", [False, True])
def test_of_a_packet_across_what_is_sealed_the_rest_is_used(
    twin: Twin, sealed_before: bool
) -> None:
    values = readings()
    sent = payloads(values)
    # Of seconds 280 to 308.
    across = sent.pop(8)
    # The last of these is of second 448: rows are final up to second 300.
    for payload in sent[:12]:
        twin.send("logger", payload)
    if sealed_before:
        assert twin.sealing.seal(twin.packets.latest(), silent=()) == 5
    assert twin.send("logger", across) == "waiting"
    for payload in sent[12:]:
        twin.send("logger", payload)
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) + 5 * sealed_before == 24
    second = STEP * np.arange(COUNT)
    in_time = (second < 280) | (second >= 300)
    for k, row in enumerate(twin.rows()):
        mean = values[(second // 60 == k) & in_time].mean(axis=0)
        np.testing.assert_allclose(row[[1, 2, -1]], mean, rtol=1e-12)
    account = sum(twin.packets.account().values(), Account())
    assert account == Account(received=40, used=40, partly_late=1)


def test_rows_wait_for_every_source_until_it_is_silent(tmp_path: Path, model: Model) -> None:
    mapping = RecordMapping()
    twin = Twin(tmp_path, model, {"east": mapping, "west": mapping})
    for payload in payloads(readings()):
        twin.send("east", payload)
    assert twin.sealing.seal(twin.packets.latest(), silent=()) == 0
    assert twin.sealing.seal(twin.packets.latest(), silent=["west"]) == 21


def test_a_long_pause_makes_no_rows(twin: Twin) -> None:
    for day in (0, 30):
        time = np.array([MIDNIGHT + day * 86_400 * MICROSECONDS])
        packet = SensorPacket(None, ("D1",), time, np.array([[1.5]]))
        twin.send("logger", write_packet(packet))
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) == 2
    np.testing.assert_array_equal(twin.rows()[:, :2], [[0, 1.5], [30 * 86_400, 1.5]])


def test_names_units_and_signs_go_through_the_mapping(tmp_path: Path, model: Model) -> None:
    channels = {"D1": Channel(column="ch 1", unit="m", sign=-1), "D2": Channel(column="ch 2")}
    mapping = RecordMapping(channels=channels, unused={"D3": "broken"})
    twin = Twin(tmp_path, model, {"logger": mapping})
    time = np.array([MIDNIGHT])
    for names in (("ch 1", "spare"), ("ch 2",)):
        packet = SensorPacket(None, names, time, np.array([[0.002, 7.0][: len(names)]]))
        twin.send("logger", write_packet(packet))
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    station = twin.inbox.station
    assert station is not None
    assert "D3" not in station.channels
    np.testing.assert_array_equal(twin.rows()[0, 1:3], [-2.0, 0.002])


FOREIGN: dict[str, Callable[[], bytes]] = {
    "CSV": lambda: b"time,D1,D2\n2026-11-23T00:00:00Z,1.5,2.5\n2026-11-23T00:01:00Z,2.5,3.5\n",
    "line protocol": lambda: (
        f"D1 v=1.5 {MIDNIGHT * 1000}\nD2 v=2.5 {MIDNIGHT * 1000}\n"
        f"D1 v=2.5 {(MIDNIGHT + MINUTE) * 1000}\nD2 v=3.5 {(MIDNIGHT + MINUTE) * 1000}\n"
    ).encode(),
    "SenML": lambda: (
        b'[{"bt":%d,"n":"D1","v":1.5},{"n":"D2","v":2.5},'
        b'{"n":"D1","t":60,"v":2.5},{"n":"D2","t":60,"v":3.5}]' % (MIDNIGHT // MICROSECONDS)
    ),
}


@pytest.mark.parametrize("kind", FOREIGN)
def test_formats_of_others_give_the_same_rows(kind: str, tmp_path: Path, model: Model) -> None:
    channels = {"D1": Channel(column="D1 v"), "D2": Channel(column="D2 v")}
    mapping = RecordMapping(channels=channels if kind == "line protocol" else {})
    twin = Twin(tmp_path, model, {"logger": mapping})
    assert twin.send("logger", FOREIGN[kind]()) == "waiting"
    assert twin.send("logger", FOREIGN[kind]()) == "duplicate"
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    np.testing.assert_array_equal(twin.rows()[:, :3], [[0, 1.5, 2.5], [60, 2.5, 3.5]])


WITHOUT_TIME: dict[str, tuple[StatedFormat, str, bytes]] = {
    "number": (StatedFormat("number", TopicPattern("site/{channel}")), "site/D1", b"1.5"),
    "row": (StatedFormat("row", columns=("D1", "D2")), "site", b"1.5,7"),
    "SenML": (StatedFormat(), "site", b'[{"n":"D1","v":1.5}]'),
    "line protocol": (StatedFormat(), "site", b"D1 v=1.5"),
}


@pytest.mark.parametrize("kind", WITHOUT_TIME)
def test_what_has_no_time_is_of_when_it_arrived(kind: str, tmp_path: Path, model: Model) -> None:
    stated, where, payload = WITHOUT_TIME[kind]
    channels = {"D1": Channel(column="D1 v")} if kind == "line protocol" else {}
    twin = Twin(tmp_path, model, {"logger": RecordMapping(channels=channels)}, stated)
    # The same reading again is no duplicate, and it is read the same after a restart.
    for minute in range(3):
        assert twin.send("logger", payload, MIDNIGHT + minute * MINUTE, where) == "waiting"
    twin.start()
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    np.testing.assert_array_equal(twin.rows()[:, :2], [[0, 1.5], [60, 1.5], [120, 1.5]])


def test_a_row_has_a_time_of_its_own_where_a_column_is_one(tmp_path: Path, model: Model) -> None:
    stated = StatedFormat("row", columns=("when", "D1"))
    time = TimeColumns(columns=["when"], format="%d.%m.%Y %H:%M", zone="Europe/Berlin")
    twin = Twin(tmp_path, model, {"logger": RecordMapping(time=time, decimal=",")}, stated)
    assert twin.send("logger", b"23.11.2026 01:00;1,5\r\n") == "waiting"
    assert twin.send("logger", b"23.11.2026 01:00;1,5\r\n") == "duplicate"
    assert twin.send("logger", b"25.10.2026 02:30;1,5") == "refused"
    assert twin.send("logger", b"1,5") == "refused"
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    np.testing.assert_array_equal(twin.rows()[:, :2], [[0, 1.5]])


def test_units_of_a_payload_are_turned_into_those_of_the_model(twin: Twin) -> None:
    time = MIDNIGHT // MICROSECONDS
    pack = f"""[{{"bt":{time},"n":"D1","u":"m","v":0.002}},{{"n":"D2","u":"kg","v":5}},
        {{"n":"temperature","u":"Cel","v":11}},{{"n":"spare","v":1}}]"""
    assert twin.send("logger", pack.encode()) == "waiting"
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    rows = twin.rows()
    assert rows[0, 1] == 2.0
    assert np.isnan(rows[0, 2])
    assert rows[0, -1] == 11
    refused = twin.readers["logger"].remarks.refused
    assert set(refused) == {"D2", "spare"}
    assert "kg" in refused["D2"]


def test_two_channels_that_mean_the_same_are_refused_when_they_come(
    tmp_path: Path, model: Model
) -> None:
    mapping = RecordMapping(channels={"D1": Channel(column="ch 1")})
    twin = Twin(tmp_path, model, {"logger": mapping})
    packet = SensorPacket(None, ("ch 1", "D1"), np.array([MIDNIGHT]), np.array([[1.0, 2.0]]))
    assert twin.send("logger", write_packet(packet)) == "refused"
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) == 0


def test_a_clock_that_runs_back_changes_no_row(tmp_path: Path, model: Model) -> None:
    rows = []
    for wrong in (False, True):
        (tmp_path / str(wrong)).mkdir()
        twin = Twin(tmp_path / str(wrong), model, {"logger": RecordMapping()})
        clock, number = ClockWatch(ClockRule()), 0

        def send(moment: int, arrived: int, value: float) -> str:
            nonlocal number
            packet = SensorPacket(
                Number("s", number),
                ("D1",),
                np.array([moment]),
                np.array([[value]]),
            )
            number += 1
            return twin.send("logger", write_packet(packet), arrived, clock=clock)  # noqa: B023

        now = MIDNIGHT
        for minute in range(60):
            now = MIDNIGHT + minute * MINUTE
            assert send(now, now, minute) == "waiting"
        if wrong:
            for ahead in (120, -120, -60 * 24 * 365 * 56):
                assert send(now + ahead * MINUTE, now + MINUTE, 99.0) == "refused"
            assert send(now, now + 2 * MINUTE, 99.0) == "refused"
        send(now + 3 * MINUTE, now + 3 * MINUTE, 60.0)
        twin.sealing.seal(twin.packets.latest(), silent=["logger"])
        rows.append(twin.rows())
        account = sum(twin.packets.account().values(), Account())
        assert (account.difference, account.refused) == (0, 4 if wrong else 0)
    np.testing.assert_array_equal(*rows)


def test_what_cannot_be_used_is_refused_before_it_is_kept(twin: Twin) -> None:
    reader = twin.readers["logger"]
    for payload, words in (
        (b"garbage", "no rows below the header"),
        (b'{"v": 1}', "no packet"),
        (b"time,D1\n2026-11-23T00:00:00,1.5\n2026-11-23T00:01:00,2.5\n", "no zone"),
        (b"time,D1\n0,1.5\n1,2.5\n", "no time stamps"),
        (b'{"t0": "2026-11-23T00:00:00Z", "chan', "this is no JSON"),
        (b"[" * 5000, "too deep"),
        (b"time,a\x01b\n2026-11-23T00:00:00Z,1\n", "control character"),
        (b'[{"n": "a\\u0000b", "v": 1}]', "control character"),
        (packet_of("a\\u0000b"), "control character"),
        (packet_of("a\\nb"), "control character"),
    ):
        one = arrival_of(payload, MIDNIGHT, "topic", reader, ClockWatch(ClockRule()))
        assert one.refused is not None
        assert words in one.refused
        assert twin.packets.receive("logger", [one])[0][0] == "refused"
    sent = payloads(readings())[0]
    for arrived, words in (
        (MIDNIGHT - 3600 * MICROSECONDS, "its clock is 60.5 min ahead"),
        (MIDNIGHT + 30 * 86_400 * MICROSECONDS, "its readings are 30 days old"),
    ):
        one = arrival_of(sent, arrived, "topic", reader, ClockWatch(ClockRule()))
        assert one.refused is not None
        assert one.refused.startswith(f"{words}: set the clock")
    assert twin.sealing.seal(twin.packets.latest(), silent=["logger"]) == 0


def packet_of(channel: str) -> bytes:
    """A packet of one channel, whose name is written as JSON has it."""
    return (
        b'{"v": 1, "t0": "2026-11-23T00:00:00Z", "values": [[1]], "channels": ["%s"]}'
        % channel.encode()
    )


def test_a_twin_that_has_ended_takes_no_more(twin: Twin) -> None:
    sent = payloads(readings())
    twin.send("logger", sent[0])
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    twin.inbox.end()
    twin.send("logger", sent[20])
    with pytest.raises(InputError, match="ended"):
        twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    account = sum(twin.packets.account().values(), Account())
    assert account == Account(received=2, used=1, waiting=1)


def test_a_context_that_begins_to_come_after_the_first_rows_is_told(twin: Twin) -> None:
    values, reader = readings(), twin.readers["logger"]
    times = MIDNIGHT + STEP * MICROSECONDS * np.arange(COUNT)
    for k, rows in enumerate(np.split(np.arange(COUNT), COUNT // 5)):
        channels = CHANNELS if rows[0] >= COUNT // 2 else CHANNELS[:2]
        own = values[rows, : len(channels)]
        packet = SensorPacket(Number("s", k), channels, times[rows], own)
        assert twin.send("logger", write_packet(packet)) == "waiting"
        twin.sealing.seal(twin.packets.latest(), silent=())
        assert not reader.remarks.refused or channels == CHANNELS
    twin.sealing.seal(twin.packets.latest(), silent=["logger"])
    station = twin.inbox.station
    assert station is not None
    assert station.measured == ()
    assert "the first rows had none of it" in reader.remarks.refused["temperature"]
