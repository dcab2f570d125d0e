"""A PostgreSQL server that is away for a while: all is taken in, and the twin goes on after."""

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any

from starlette.testclient import TestClient

import rga
from live_streams import SETTINGS, assert_same, history, sinking
from rga.dashboard.app import app_of
from rga.jobs.worker import MOST_FAILURES, Worker
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.service import Service
from rga.records import Record
from rga.twin.repository import Repository
from served.bridges import packets_of
from served.made_service import waited_for, write_service
from served.postgresql import PostgreSQLServer, postgresql_server
from served.service_times import NOON, SetClock

__all__ = ["postgresql_server"]

#: how long it is away beyond what else is done [s]; `RGA_TEST_AWAY=300` is five minutes
AWAY = float(os.environ.get("RGA_TEST_AWAY", "0"))
ROWS = 100
HERE = "http://127.0.0.1:8471"
EAST = "/api/v1/twins/east"


def test_rows_are_kept_and_played_when_it_is_there_again(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    postgresql_server: PostgreSQLServer,
    tmp_path: Path,
) -> None:
    write_service(tmp_path, measured_bridge)
    path = tmp_path / "serve.toml"
    place = f'repository = "{postgresql_server.url}"\n[[twin]]'
    path.write_text(path.read_text("utf-8").replace("[[twin]]", place), "utf-8")
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    service, clock = Service(read_configuration(path), SetClock()), time.monotonic()
    twin = service.twins["east"]
    worker = Worker([twin.directory], repository=postgresql_server.url)
    packets = packets_of(record, NOON)
    with TestClient(app_of(service), base_url=HERE) as client:

        def send(some: list[bytes]) -> None:
            for packet in some:
                assert client.post(f"{EAST}/packets", content=packet).status_code == 200
            twin.seal()
            worker._idle.clear()
            worker.round()

        # A server on which nothing is yet is one on which the twin has not begun.
        assert client.get(EAST).status_code == client.get("/readyz").status_code == 200
        send(packets[:60])
        assert worker.failed == {}
        assert client.get(EAST).status_code == 200
        postgresql_server.stop()
        for first in range(60, 80, 4):
            send(packets[first : first + 4])
        assert len(range(60, 80, 4)) > MOST_FAILURES
        assert "server" in worker.failed[twin.directory]
        assert client.get(EAST).status_code == client.get("/readyz").status_code == 503
        service.supervision.round()
        assert service.faults == {}
        time.sleep(max(0.0, AWAY - (time.monotonic() - clock)))
        postgresql_server.start()
        send(packets[80:])
        assert worker.failed == {}
        assert client.get(EAST).status_code == client.get("/readyz").status_code == 200
        account = client.get(f"{EAST}/account").json()["http"]
        assert (account["difference"], account["used"] + account["waiting"]) == (0, ROWS)
    with rga.LiveTwin(twin.directory, postgresql_server.url) as live:
        assert live.waiting[1] == 0
        found = history(live)
    with rga.live(
        tmp_path / "model.json",
        tmp_path / "alone",
        settings=tmp_path / "settings.json",
        name="alone",
    ) as live:
        live.feed(found.record)
        live.play()
        expected = history(live)
    service.stop()
    assert_same(found, expected)


def test_a_server_that_goes_away_in_the_middle_of_a_step(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    postgresql_server: PostgreSQLServer,
    tmp_path: Path,
) -> None:
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    (tmp_path / "model.json").write_text(json.dumps(measured_bridge), "utf-8")
    histories = []
    for place, repository in (("east", postgresql_server.url), ("alone", None)):
        begun = {"settings": SETTINGS, "repository": repository}
        with rga.live(tmp_path / "model.json", tmp_path / place, **begun) as twin:
            twin.feed(record)
        worker = Worker([tmp_path / place], repository=repository)
        if repository is not None:
            playing = Thread(target=worker.round)
            playing.start()
            with Repository.open(repository) as opened:
                waited_for(lambda: opened.runs() and opened.latest().rows)
            postgresql_server.stop()
            playing.join()
            assert not worker.round()
            assert "server" in worker.failed[tmp_path / place]
            postgresql_server.start()
            worker._idle.clear()
        worker.round()
        assert worker.failed == {}
        with rga.LiveTwin(tmp_path / place, repository) as twin:
            assert twin.waiting == (0, 0)
            histories.append(history(twin))
    assert_same(*histories)
