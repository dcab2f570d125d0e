"""A service on a repository of an earlier rga: it opens, history and all, a copy beside it."""

import shutil
import sqlite3
from collections import namedtuple
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

import rga
from live_streams import assert_same, history, sinking
from rga.dashboard.app import app_of
from rga.jobs.worker import MOST_FAILURES, Worker
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.service import Service
from rga.records import Record
from rga.twin.repository import sqlite, tables
from rga.twin.repository.database import FILE_NAME
from served.bridges import packets_of
from served.made_service import write_service
from served.service_times import NOON
from stored_runs import alter

ROWS, BEFORE = 100, 60
HERE = "http://127.0.0.1:8471"
EAST = "/api/v1/twins/east"


def make_older(file: Path) -> None:
    """Make a repository what rga wrote before its entries had checksums."""
    for table in tables.OF_A_RUN:
        alter(str(file), f"ALTER TABLE {table.name} DROP COLUMN checksum")
    alter(str(file), "UPDATE rga_repository SET version_num = '0003'")


def served(folder: Path, packets: list[bytes]) -> tuple[Service, Worker]:
    """A service to which packets are sent."""
    service = Service(read_configuration(folder / "serve.toml"))
    twin = service.twins["east"]
    for packet in packets:
        twin.receive("http", [("http", packet)])
    twin.seal()
    return service, Worker([twin.directory])


def test_a_repository_of_before_opens_with_its_history(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    write_service(tmp_path, measured_bridge)
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    packets = packets_of(record, NOON)
    service, worker = served(tmp_path, packets[:BEFORE])
    worker.round()
    service.stop()
    file = tmp_path / "data" / "east" / FILE_NAME
    make_older(file)
    service, worker = served(tmp_path, packets[BEFORE:])
    with TestClient(app_of(service), base_url=HERE) as client:
        assert "older" in client.get(EAST).json()["detail"]
        usage = namedtuple("usage", "total used free")
        with monkeypatch.context() as full:
            full.setattr(sqlite.shutil, "disk_usage", lambda _: usage(10, 10, 0))
            for _ in range(MOST_FAILURES + 1):
                worker._idle.clear()
                worker.round()
        assert "no room for a copy" in worker.failed[file.parent]
        worker._idle.clear()
        worker.round()
        assert worker.failed == {}
        assert client.get(EAST).json()["now"]["rows"] > BEFORE
    service.stop()
    with rga.LiveTwin(file.parent) as twin:
        found = history(twin)
    copy = file.with_name(f"{FILE_NAME}.revision-0003")
    with sqlite3.connect(copy) as held:
        columns = {one[1] for one in held.execute("PRAGMA table_info(step)")}
        assert held.execute("SELECT count(*) FROM step").fetchone() > (1,)
    assert "number" in columns
    assert "checksum" not in columns
    # As it would have been without the older file in between.
    shutil.rmtree(tmp_path / "data")
    service, worker = served(tmp_path, packets)
    worker.round()
    service.stop()
    with rga.LiveTwin(file.parent) as twin:
        assert_same(found, history(twin))
    assert not copy.exists()
