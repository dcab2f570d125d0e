"""A disk that is full for a while: nothing is half written, and all goes on when there is room."""

import json
import os
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from datetime import timedelta
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from starlette.testclient import TestClient

import rga
from live_streams import SETTINGS, assert_same, history, sinking
from rga.dashboard.app import app_of
from rga.jobs.worker import MOST_FAILURES, Worker
from rga.model import read_model
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.configuration import read_configuration
from rga.operation.feeding import senders
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender
from rga.operation.inbox.archive import FOLDER
from rga.operation.service import Service
from rga.operation.service_file import FILE_NAME
from rga.operation.sources import mqtt
from rga.records import Record
from rga.twin.hardware.inbox import INBOX
from rga.twin.repository.database import FILE_NAME as REPOSITORY
from rga.twin.repository.faults import DiskFull
from rga_bench.operation.broker import Mosquitto
from served.bridges import packets_of
from served.brokers import mosquitto
from served.full_disk import Disk, limited_disk
from served.made_service import sent_of, waited_for, write_service
from served.service_times import NOON, SetClock

__all__ = ["mosquitto"]

#: how long the disk is full [s]; `RGA_TEST_FULL=300` is five minutes
FULL = float(os.environ.get("RGA_TEST_FULL", "1.5"))
ROWS = 100
HERE = "http://127.0.0.1:8471"
TOPIC = "rga/v1/east/data/logger"
#: fills what is left of the last page
LARGE = b"\x81" + b"x" * 50_000


@pytest.fixture
def disk() -> Iterator[Disk]:
    with limited_disk() as found:
        yield found


@pytest.fixture
def record(measured_bridge: dict[str, Any], measured_record: Callable[..., Record]) -> Record:
    return sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)


@pytest.fixture
def served(measured_bridge: dict[str, Any], tmp_path: Path) -> Iterator[Callable[..., Service]]:
    """Makes a service; nothing of it runs by itself."""
    begun: list[Service] = []

    def make(alarms: str = "", **changed: Any) -> Service:
        write_service(tmp_path, measured_bridge, **changed)
        path = tmp_path / "serve.toml"
        path.write_text(alarms + path.read_text("utf-8"), "utf-8")
        begun.append(Service(read_configuration(tmp_path / "serve.toml"), SetClock()))
        return begun[-1]

    yield make
    for one in begun:
        one.stop()


def assert_kept(service: Service, record: Record) -> None:
    """All packets of the record are there once, and rows are those of the record."""
    twin = service.twins["east"]
    found = list(twin.packets.account().values())
    assert sum(one.difference for one in found) == 0
    assert sum(one.late + one.refused for one in found) == 0, found
    assert sum(one.used + one.waiting for one in found) == len(record)
    twin.seal()
    station = twin.inbox.station
    assert station is not None
    rows = twin.inbox.packet(station, 0, len(record))
    assert len(record) - 5 <= len(rows.time) < len(record)
    assert (rows.readings == record.readings[: len(rows.time)]).all()


def test_a_sender_is_told_to_wait_and_nothing_is_lost(
    served: Callable[..., Service], disk: Disk, record: Record
) -> None:
    service, path, answers = served(), "/api/v1/twins/east/packets", list[int]()
    with TestClient(app_of(service), base_url=HERE) as client:
        for number, packet in enumerate(packets_of(record, NOON)):
            disk.full = number == ROWS // 2
            if disk.full:
                # What fits into pages that are begun is kept; soon nothing does.
                assert client.post(path, content=LARGE).status_code == 507
            answer = client.post(path, content=packet)
            if answer.status_code == 507:
                assert int(answer.headers["Retry-After"]) > 0
                answers.append(507)
                disk.full = False
                answer = client.post(path, content=packet)
            assert answer.status_code == 200
    assert len(answers) <= 1
    assert_kept(service, record)


def test_a_broker_holds_what_cannot_be_kept(
    served: Callable[..., Service],
    disk: Disk,
    record: Record,
    mosquitto: Mosquitto,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mqtt, "PROBE", 0.1)
    monkeypatch.setattr(mqtt, "BROKEN", 0.5)
    monkeypatch.setattr(mqtt, "AGAIN", 0.1)
    # The broker sends no more, the probe neither, before the first of so many are acknowledged.
    monkeypatch.setattr(mqtt, "RECEIVE_MAXIMUM", 5)
    monkeypatch.setattr(senders, "UNACKNOWLEDGED", 0.5)
    source = f'kind = "mqtt"\nurl = "{mosquitto.url}"\ntopics = ["{TOPIC}"]\nclock.check = false'
    service = served(source=source)
    broker = service._sources["east", "mqtt"]
    broker.start()
    waited_for(lambda: broker.fault is None)
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    work = (sent_of(record), sender, 1, 30_000.0, Faults())
    feeding = Thread(target=play, args=work, daemon=True)
    feeding.start()
    twin, told = service.twins["east"], set[str | None]()
    waited_for(lambda: twin.numbers("mqtt"))
    disk.full = True
    until = time.monotonic() + FULL
    while time.monotonic() < until:
        told.add(broker.fault)
        time.sleep(0.02)
    assert feeding.is_alive()
    # That the broker brings nothing more is no fault of the broker.
    assert {one for one in told if one} == {next(one for one in told if one and "full" in one)}
    disk.full = False
    feeding.join(60)
    waited_for(lambda: broker.fault is None)
    assert_kept(service, record)


@pytest.mark.parametrize("has_room", [False, True])
def test_what_can_wait_waits_where_little_is_free(
    served: Callable[..., Service], record: Record, has_room: bool
) -> None:
    # All of a disk is never free.
    service = served(alarms=f"[alarms]\ndisk = {0.0 if has_room else 1.0}\n")
    twin = service.twins["east"]
    twin.receive("http", [("http", one) for one in packets_of(record, NOON)])
    twin.seal()
    service.workers.start()
    waited_for(lambda: service.workers.at.get("heavy") == twin.directory)
    waited_for(lambda: "heavy" not in service.workers.at)
    with rga.LiveTwin(twin.directory) as live:
        if has_room:
            waited_for(lambda: live.waiting[0] < twin.inbox.rows)
        # A run begins with a long step.
        assert (live.waiting[0] < twin.inbox.rows) == has_room
    clock = service._clock
    assert isinstance(clock, SetClock)
    clock.pass_by(9 * 86_400)
    # A later packet makes the rows of all others final.
    later = packets_of(record.rows(slice(1)), NOON + timedelta(days=9), "later")
    twin.receive("http", [("http", one) for one in later])
    twin.seal()
    service._tidy()
    # Packets are taken in and rows are made all the same.
    assert twin.inbox.rows > ROWS - 5
    assert (twin.directory / FOLDER).exists() == has_room
    assert service.workers.failed == {}


@pytest.fixture
def begun(measured_bridge: dict[str, Any], record: Record, tmp_path: Path) -> Callable[[str], Path]:
    """Makes twins that wait to be played, all of the same rows."""
    (tmp_path / "model.json").write_text(json.dumps(measured_bridge), "utf-8")

    def make(name: str) -> Path:
        place = tmp_path / name
        with rga.live(tmp_path / "model.json", place, settings=SETTINGS, name="east") as twin:
            twin.feed(record)
        return place

    return make


@pytest.mark.parametrize("file", [REPOSITORY, pytest.param(INBOX, marks=pytest.mark.thorough)])
def test_a_worker_goes_on_where_there_was_no_room(
    begun: Callable[[str], Path], disk: Disk, file: str
) -> None:
    alone, place = begun("alone"), begun("place")
    with rga.LiveTwin(alone) as twin:
        twin.play()
        expected = history(twin)
    worker = Worker([place])
    disk.only = file
    # It begins on a disk that is full; later it is full between two steps.
    for steps in (0, 1, 3):
        disk.full = True
        for _ in range(MOST_FAILURES + 2):
            worker._idle.clear()
            worker.round()
        if file != INBOX:
            assert "full" in worker.failed[place]
        disk.full = False
        left = iter(range(steps))
        with rga.LiveTwin(place) as twin:
            twin.play(lambda _, left=left: next(left, None) is not None)  # type: ignore[misc]
    worker._idle.clear()
    worker.round()
    assert worker.failed == {}
    with rga.LiveTwin(place) as twin:
        assert twin.waiting == (0, 0)
        assert_same(history(twin), expected)


def test_an_alarm_waits_for_room(served: Callable[..., Service], disk: Disk) -> None:
    service = served()
    book = service.alarms
    disk.only = FILE_NAME
    keys = [ConditionKey("east", "gap", "alarm", f"{k}" + "x" * 1000) for k in range(12)]
    observations = [
        Observation((), frozenset({"gap"}), (Condition(key, key.subject, NOON),)) for key in keys
    ]
    disk.full, kept = True, 0
    # What fits into pages that are begun is kept.
    with suppress(DiskFull):
        for one in observations:
            book.observe("east", one)
            kept += 1
    assert kept < len(keys)
    with pytest.raises(DiskFull):
        book.observe("east", observations[kept])
    # What was refused left nothing half done.
    assert [one.change for one in book.transitions(0, 1000)].count("raised") == kept
    disk.full = False
    for one in observations[kept:]:
        book.observe("east", one)
    assert [one.change for one in book.transitions(0, 1000)].count("raised") == len(keys)
