"""A logger that plays a record: what it sends, and what goes wrong as it was drawn."""

import json
from collections import Counter
from collections.abc import Callable, Iterator
from datetime import datetime
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from socket import socket
from threading import Thread
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.operation.feeding import senders
from rga.operation.feeding.faults import Faults, garbage, script
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender, HttpSender
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


def test_what_is_missing_is_sent_as_missing(tmp_path: Path) -> None:
    path = tmp_path / "record.csv"
    path.write_text("time,D1,Gauge 2\n0,-9999,1\n1,2,-1\n2,Overrange,3\n", "utf-8")
    channels = {"D2": {"column": "Gauge 2", "missing": [-1], "unit": "cm"}}
    mapping = RecordMapping.model_validate({"missing": [-9999], "channels": channels})
    start = datetime.fromisoformat("2026-11-23T00:00:00+00:00")
    record = sent_record(path, mapping, start)
    np.testing.assert_array_equal(record.values, [[np.nan, 1], [2, np.nan], [np.nan, 3]])
    assert record.channels == ("D1", "Gauge 2")


def test_a_mapping_beside_the_record_is_taken(tmp_path: Path, rga: Callable[..., Any]) -> None:
    record, box = tmp_path / "record.csv", tmp_path / "box"
    box.mkdir()
    record.write_text("time,D1\n2026-11-23T00:00:00Z,-9999\n2026-11-23T00:01:00Z,2\n", "utf-8")
    (tmp_path / "import.toml").write_text("missing = [-9999]", "utf-8")
    done = rga("feed", record, "--to", box, "--stream", "s")
    assert done.code == 0
    assert done.out == "2 rows went out as stream s, in 2 packets.\n"
    packets = [read_packet(one.read_bytes(), "a test") for one in sorted(box.iterdir())]
    np.testing.assert_array_equal([one.values.item() for one in packets], [np.nan, 2])


def test_a_stream_that_no_packet_may_have_is_refused(file: Path, rga: Callable[..., Any]) -> None:
    for stream in ("a b", "x" * 65, ""):
        refused = rga("feed", file, "--to", file.parent, "--stream", stream)
        assert refused.code == 2
        words = " ".join(refused.err.replace("\u2502", " ").split())
        assert "is no name of a stream" in words
    assert [one.name for one in file.parent.iterdir()] == [file.name]


class _Answering(BaseHTTPRequestHandler):
    """Answers what its server says, and 200 from the third call on."""

    def do_POST(self) -> None:
        self.server.calls += 1  # type: ignore[attr-defined]
        again = self.server.code == 503 and self.server.calls > 2  # type: ignore[attr-defined]
        self.send_response(200 if again else self.server.code)  # type: ignore[attr-defined]
        self.end_headers()
        is_refused = self.server.calls <= self.server.refuses  # type: ignore[attr-defined]
        told = ["none of its channels is used"] if is_refused else []
        self.wfile.write(json.dumps({"refused": told}).encode())

    def log_message(self, format: str, *args: Any) -> None:
        pass


@pytest.fixture
def answering() -> Iterator[HTTPServer]:
    with HTTPServer(("127.0.0.1", 0), _Answering) as server:
        server.calls = server.refuses = 0  # type: ignore[attr-defined]
        Thread(target=server.serve_forever).start()
        yield server
        server.shutdown()


@pytest.mark.parametrize(("refuses", "code"), [(0, 0), (1, 0), (4, 2)])
def test_packets_that_are_refused_are_counted(
    file: Path, answering: HTTPServer, rga: Callable[..., Any], refuses: int, code: int
) -> None:
    answering.code, answering.refuses = 200, refuses  # type: ignore[attr-defined]
    place = f"http://127.0.0.1:{answering.server_port}/east"
    done = rga("feed", file, "--to", place, "--rows", 60, "--json", "-")
    assert done.code == code
    assert json.loads(done.out)["refused"] == refuses
    told = f"{refuses} of 4 packets were refused: none of its channels is used"
    assert (told in done.err) == (refuses > 0)


@pytest.mark.parametrize("code", [401, 403])
def test_who_may_not_send_is_told_of_the_token(answering: HTTPServer, code: int) -> None:
    answering.code = code  # type: ignore[attr-defined]
    sender = HttpSender(f"http://127.0.0.1:{answering.server_port}/east")
    with pytest.raises(InputError, match="RGA_TOKEN"):
        sender.send(b"0", None)


def test_a_service_that_takes_nothing_is_told_of_once(
    answering: HTTPServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(senders, "SILENT", 0.0)
    monkeypatch.setattr(senders, "AGAIN", 0.01)
    answering.code, told = 503, []  # type: ignore[attr-defined]
    place = f"http://127.0.0.1:{answering.server_port}/east"
    sender = HttpSender(place, told=told.append)
    sender.send(b"0", None)
    assert len(told) == 1
    assert place in told[0]
    assert "503" in told[0]


class _Dying(BaseHTTPRequestHandler):
    """Says at first less than it has promised, as a service that is killed."""

    def do_POST(self) -> None:
        self.server.calls += 1  # type: ignore[attr-defined]
        said = json.dumps({"refused": []}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(said)))
        self.end_headers()
        if self.server.calls > 2:  # type: ignore[attr-defined]
            self.wfile.write(said)

    def log_message(self, format: str, *args: Any) -> None:
        pass


def test_an_answer_that_is_half_said_is_none(
    answering: HTTPServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(senders, "AGAIN", 0.01)
    answering.RequestHandlerClass = _Dying
    HttpSender(f"http://127.0.0.1:{answering.server_port}/east").send(b"0", None)
    assert answering.calls == 3  # type: ignore[attr-defined]


class _Heard(Exception):
    """Ends a wait that has no end."""


def _hear(words: str) -> None:
    raise _Heard(words)


@pytest.mark.parametrize("scheme", ["http", "mqtt"])
def test_an_address_where_nobody_answers_is_told(
    monkeypatch: pytest.MonkeyPatch, scheme: str
) -> None:
    monkeypatch.setattr(senders, "SILENT", 0.0)
    with socket() as unused:
        unused.bind(("127.0.0.1", 0))
        place = f"127.0.0.1:{unused.getsockname()[1]}"
        sender: senders.Sender = HttpSender(f"http://{place}/east", told=_hear)
        if scheme == "mqtt":
            sender = BrokerSender(f"mqtt://{place}/rga/v1/east/data/logger", told=_hear)
        with pytest.raises(_Heard, match=f"nobody answers at {scheme}://{place}"):
            sender.send(b"0", Number("s", 0))


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


def test_a_unit_goes_out_with_the_name_of_its_channel(tmp_path: Path) -> None:
    path, start = tmp_path / "r.csv", datetime.fromisoformat("2026-11-23T00:00:00Z")
    path.write_text("time,D1,D2 (mm),D3\n,cm,mm,-\n0,1,2,3\n1,1,2,3\n", "utf-8")
    record = sent_record(path, RecordMapping(), start)
    assert record.channels == ("D1 [cm]", "D2 (mm)", "D3")
    path.write_text("time,D1 (mm)\n,cm\n0,1\n1,1\n", "utf-8")
    with pytest.raises(InputError, match="says 'mm', the line of units says 'cm'"):
        sent_record(path, RecordMapping(), start)
