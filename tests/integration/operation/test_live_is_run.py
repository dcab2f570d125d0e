"""What a served twin says of what it was sent is what `rga run` says of the exported rows."""

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import rga
from live_streams import SETTINGS, assert_same, history, sinking
from rga.dashboard.app import app_of
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.inbox.account import Account
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import Number, SensorPacket
from rga.operation.service import Service
from rga.records import Record
from rga.twin.runner import taken_up
from served.made_service import MIDNIGHT, write_service


@pytest.fixture
def folder(measured_bridge: dict[str, Any], tmp_path: Path) -> Path:
    """Of a service: its configuration, and the files that it names."""
    write_service(tmp_path, measured_bridge)
    return tmp_path


@pytest.fixture
def record(folder: Path, measured_record: Callable[..., Record]) -> Record:
    """Of a bearing that sinks, with holes."""
    found = sinking(
        read_model(json.loads((folder / "model.json").read_text("utf-8")), "b"),
        measured_record,
        100,
    )
    draw = np.random.default_rng(2)
    found.readings[draw.random(found.readings.shape) < 0.03] = np.nan
    return found


def packets_of(record: Record, draw: random.Random) -> list[bytes]:
    """The rows of a record, some at a time, as a logger sends them."""
    names = (*record.sensors, *record.contexts)
    values = np.column_stack([record.readings, *record.contexts.values()])
    payloads, row, number = [], 0, 0
    while row < len(record):
        times = MIDNIGHT + np.array([round(record.time[row] * 1e6)])
        number = len(payloads)
        packet = SensorPacket(Number("s", number), names, times, values[row : row + 1])
        payloads.append(write_packet(packet, binary=draw.random() < 0.5))
        row += 1
    return payloads


@pytest.mark.parametrize("seed", [1, 2])
def test_rows_and_history_are_those_of_the_record(seed: int, folder: Path, record: Record) -> None:
    draw = random.Random(seed)
    service = Service(read_configuration(folder / "serve.toml"))
    twin = service.twins["east"]
    client = TestClient(app_of(service), base_url="http://127.0.0.1")
    # At most three rows behind others, and some of them twice.
    sent = [(k + draw.uniform(0, 3), one) for k, one in enumerate(packets_of(record, draw))]
    sent += [
        (k + draw.uniform(0, 9), one) for k, (_, one) in enumerate(sent) if draw.random() < 0.1
    ]
    told: dict[str, int] = {"stored": 0, "duplicate": 0, "late": 0}
    for _, payload in sorted(sent, key=lambda one: one[0]):
        answer = client.post("/api/v1/twins/east/packets", content=payload)
        assert answer.status_code == 200
        assert answer.json()["refused"] == []
        for name in told:
            told[name] += answer.json()[name]
        if draw.random() < 0.1:
            twin.seal()
            with rga.LiveTwin(twin.directory) as live:
                live.play()
    assert told == {"stored": 100, "duplicate": len(sent) - 100, "late": 0}
    twin._heard["http"] -= 10_000
    twin.seal()
    with rga.LiveTwin(twin.directory) as live:
        live.play()
        found = history(live)
        live.twin.record.write(folder / "export.csv")
    again = rga.load_record(folder / "export.csv", live.model)
    np.testing.assert_array_equal(again.readings, record.readings[: len(again)])
    np.testing.assert_array_equal(again.time, record.time[: len(again)])
    settings = rga.twin.Settings.model_validate(SETTINGS.model_dump() | {"adopt": SETTINGS.adopt})
    with taken_up(live.model, again, folder / "played.sqlite", settings, 0) as running:
        while running.stage != "close":
            running.step()
        assert_same(found, running.history())
    account = client.get("/api/v1/twins/east/account").json()["http"]
    assert account["used"] == 100
    assert account["difference"] == 0
    assert sum(twin.packets.account().values(), Account()).difference == 0
    service.stop()


def test_what_cannot_be_taken_is_told(folder: Path) -> None:
    service = Service(read_configuration(folder / "serve.toml"))
    client = TestClient(app_of(service), base_url="http://127.0.0.1")
    assert client.post("/api/v1/twins/west/packets", content=b"").status_code == 404
    answer = client.post("/api/v1/twins/east/packets", content=b"{}")
    assert answer.status_code == 200
    assert len(answer.json()["refused"]) == 1
    answer = client.post("/api/v1/twins/east/packets", content=b"x" * (8 * 2**20 + 1))
    assert answer.status_code == 413
    account = client.get("/api/v1/twins/east/account").json()["http"]
    assert (account["received"], account["refused"], account["difference"]) == (1, 1, 0)
    service.stop()
