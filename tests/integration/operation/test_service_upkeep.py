"""What the guide of a service says of systemd and of backups holds of a service that runs."""

import shutil
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rga
from live_streams import sinking
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.notices import fault_log
from rga.operation.packets.packet import EPOCH
from rga.operation.service import Service
from rga.records import Record
from rga_bench.operation.broker import Mosquitto
from rga_bench.operation.service_process import ServiceProcess
from served.bridges import lived, packets_of
from served.brokers import mosquitto
from served.made_service import waited_for, write_service

__all__ = ["mosquitto"]

#: rows of the record, and those that had come when it was copied
ROWS, COPIED = 90, 60


def test_systemd_is_told_that_it_answers_and_goes_on(
    measured_bridge: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    address = write_service(tmp_path, measured_bridge)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as system:
        system.bind(str(tmp_path / "n"))
        system.settimeout(60)
        monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "n"))
        with ServiceProcess(tmp_path, address):
            said: list[bytes] = []
            while b"READY=1" not in said or said[-1] != b"WATCHDOG=1":
                said.append(system.recv(64))
    assert set(said) == {b"READY=1", b"WATCHDOG=1"}
    assert said.count(b"READY=1") == 1


def test_a_copy_of_a_service_that_was_stopped_goes_on(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    payloads = packets_of(record, EPOCH.replace(year=2026))
    folder, restored = tmp_path / "served", tmp_path / "restored"
    folder.mkdir()
    write_service(folder, measured_bridge)

    def served(place: Path, part: slice) -> None:
        service = Service(read_configuration(place / "serve.toml"))
        lived(service.twins["east"], payloads[part])
        service.stop()

    served(folder, slice(COPIED))
    shutil.copytree(folder, restored)
    for place in (folder, restored):
        served(place, slice(COPIED, None))
    with (
        rga.LiveTwin(folder / "data" / "east") as whole,
        rga.LiveTwin(restored / "data" / "east") as other,
    ):
        events = whole.twin.history().events
        assert other.twin.history().events == events
        # Rows that waited in the inbox as it was copied were played as well.
        assert max(one.row for one in events) > COPIED


def test_a_dead_broker_and_its_end_stand_in_the_log(
    measured_bridge: dict[str, Any],
    mosquitto: Mosquitto,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(fault_log, "LASTS", 0.0)
    mosquitto.kill()
    source = f'kind = "mqtt"\nurl = "{mosquitto.url}"\ntopics = ["rga/v1/east/data/#"]'
    write_service(tmp_path, measured_bridge, source=source)
    lines: list[str] = []
    service = Service(read_configuration(tmp_path / "serve.toml"), said=lines.append)
    service.start()
    dead = f"twin east, mqtt: nobody answers at 127.0.0.1:{mosquitto.port}"
    waited_for(lambda: dead in lines)
    mosquitto.start()
    waited_for(lambda: lines[-1] == "twin east, mqtt: goes on")
    service.stop()
    assert lines.count(dead) == 1
