"""A logger that plays a record: what it sends, and what goes wrong as it was drawn."""

from collections import Counter
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from rga.errors import InputError
from rga.operation.feeding.faults import Faults, garbage, script
from rga.operation.feeding.player import play
from rga.operation.feeding.sent_record import sent_record
from rga.operation.packets.native import read_packet
from rga.operation.packets.packet import Number
from rga.records.mapping import RecordMapping

ROWS = 200


class Box:
    """Keeps what it is to send."""

    def __init__(self) -> None:
        self.payloads: list[tuple[bytes, Number | None]] = []

    def send(self, payload: bytes, number: Number | None) -> None:
        self.payloads.append((payload, number))

    def finish(self) -> None:
        pass


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "record.csv"
    lines = [f"2026-11-23T00:{k // 60:02d}:{k % 60:02d}Z,{k / 8},{-k}" for k in range(ROWS)]
    path.write_text("\n".join(["time,D1,load", *lines]), "utf-8")
    return path


def test_what_is_sent_is_what_the_file_holds(file: Path) -> None:
    record, box = sent_record(file, RecordMapping()), Box()
    assert play(record, box, 7, np.inf, Faults()) == Counter(packet=29)
    packets = [read_packet(payload, "a test") for payload, _ in box.payloads]
    assert [one.number for one in packets] == [number for _, number in box.payloads]
    assert [one.number.sequence for one in packets if one.number] == list(range(29))
    values = np.concatenate([one.values for one in packets])
    np.testing.assert_array_equal(values[:, 0], np.arange(ROWS) / 8)
    np.testing.assert_array_equal(values[:, 1], -np.arange(ROWS))
    times = np.concatenate([one.times for one in packets])
    assert set(np.diff(times)) == {1_000_000}


def test_a_packet_is_no_longer_than_a_minute(file: Path) -> None:
    record = sent_record(file, RecordMapping())
    assert record.edges(1000) == [0, 60, 120, 180, 200]


def test_a_file_without_a_zone_takes_a_start(tmp_path: Path) -> None:
    path = tmp_path / "record.csv"
    path.write_text("time,D1\n0,1\n1,2\n", "utf-8")
    with pytest.raises(InputError, match="no zone"):
        sent_record(path, RecordMapping())
    start = datetime.fromisoformat("2026-11-23T00:00:00+00:00")
    record = sent_record(path, RecordMapping(), start)
    assert record.times.tolist() == [1_795_392_000_000_000, 1_795_392_001_000_000]


def test_faults_are_as_they_were_drawn() -> None:
    faults = Faults(seed=3, duplicate=0.1, out_of_order=0.2, late=0.05, garbage=0.1)
    times = [float(k) for k in range(1000)]
    drawn = script(times, faults)
    assert drawn == script(times, faults)
    assert drawn != script(times, faults.model_copy(update={"seed": 4}))
    counts = Counter(one.kind for one in drawn)
    assert counts["packet"] + counts["late"] == 1000
    assert 60 < counts["duplicate"] < 150
    assert 25 < counts["late"] < 90
    assert 60 < counts["garbage"] < 150
    assert sorted(one.packet for one in drawn if one.kind in ("packet", "late")) == list(
        range(1000)
    )
    for one in drawn:
        behind = one.due - times[one.packet]
        most = {"packet": 60, "late": 3600, "duplicate": 3660, "garbage": 0}[one.kind]
        assert 0 <= behind <= most
        assert one.kind != "late" or behind == 3600
    assert script(times, Faults()) == [
        one for one in script(times, Faults(seed=9)) if one.kind == "packet"
    ]


def test_garbage_is_no_packet() -> None:
    assert garbage(3, 1) == garbage(3, 1) != garbage(4, 1)
    for packet in range(200):
        with pytest.raises(InputError):
            read_packet(garbage(packet, 0), "a test")
