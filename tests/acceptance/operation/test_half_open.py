"""A connection that both ends believe in and that brings nothing: it is found, and all comes."""

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from live_streams import sinking
from rga.dashboard.app import app_of
from rga.dashboard.server import listening_socket, server_of
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.feeding import senders
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender, HttpSender, Sender
from rga.operation.served_twin import ServedTwin
from rga.operation.service import Service
from rga.operation.service_clock import ServiceClock
from rga.operation.sources import mqtt
from rga.records import Record
from rga_bench.operation.broker import Mosquitto
from served.brokers import mosquitto
from served.made_service import sent_of, waited_for, write_service
from served.relay import Relay, relay_to

__all__ = ["mosquitto"]

#: how long nothing arrives [s]; `RGA_TEST_AWAY=600` is ten minutes
AWAY = float(os.environ.get("RGA_TEST_AWAY", "2"))
#: rows of the record, and how many seconds of it pass in one
ROWS, SPEED = 60, 15_000.0
TOPIC = "rga/v1/east/data/logger"


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less patience than the service and its loggers have."""
    monkeypatch.setattr(mqtt, "PROBE", 0.2)
    monkeypatch.setattr(mqtt, "BROKEN", 0.8)
    monkeypatch.setattr(mqtt, "KEEP_ALIVE", 1)
    monkeypatch.setattr(senders, "UNACKNOWLEDGED", 1.0)
    monkeypatch.setattr(senders, "ANSWER", 0.5)
    monkeypatch.setattr(senders, "AGAIN", 0.1)


@pytest.fixture
def record(measured_bridge: dict[str, Any], measured_record: Callable[..., Record]) -> Record:
    return sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS, sinks=False)


class Feeding:
    """A logger that sends a record to a twin."""

    def __init__(self, record: Record, sender: Sender, twin: ServedTwin, source: str) -> None:
        self.record, self.twin, self.source = record, twin, source
        work = (sent_of(record), sender, 1, SPEED, Faults())
        self._thread = Thread(target=play, args=work, daemon=True)
        self._thread.start()

    @property
    def kept(self) -> int:
        """Number after the highest that is kept."""
        known = self.twin.numbers(self.source).get("s")
        return 0 if known is None else known.next

    def finish(self) -> int:
        """Wait until all is acknowledged, look at what was kept; gives what came twice."""
        self._thread.join(120)
        assert not self._thread.is_alive()
        twin, record = self.twin, self.record
        found = list(twin.packets.account().values())
        assert sum(one.difference for one in found) == 0
        assert sum(one.used + one.waiting for one in found) == len(record)
        assert sum(one.late + one.refused for one in found) == 0
        assert self.kept == len(record)
        assert twin.numbers(self.source)["s"].gaps == []
        twin.seal()
        station = twin.inbox.station
        assert station is not None
        rows = twin.inbox.packet(station, 0, len(record))
        # All but those that late samples are waited for.
        assert len(record) - 5 <= len(rows.time) < len(record)
        np.testing.assert_array_equal(rows.readings, record.readings[: len(rows.time)])
        return sum(one.duplicate for one in found)


def disturbed(relay: Relay, feeding: Feeding, seen: Callable[[], Any]) -> None:
    """Let nothing arrive for a while in the middle, from when something has."""
    waited_for(lambda: feeding.kept >= 10)
    relay.become("half open")
    waited_for(seen)
    time.sleep(AWAY)
    before = feeding.kept
    assert before < len(feeding.record)
    relay.become("whole")


@pytest.fixture
def behind(mosquitto: Mosquitto, measured_bridge: dict[str, Any], tmp_path: Path) -> Iterator[Any]:
    """The network between a broker and a service, and the twin that takes from it."""
    with relay_to(mosquitto.port) as relay:
        url = f"mqtt://127.0.0.1:{relay.port}"
        source = f'kind = "mqtt"\nurl = "{url}"\ntopics = ["{TOPIC}"]\nclock = {{ check = false }}'
        write_service(tmp_path, measured_bridge, source=source)
        (settings,) = read_configuration(tmp_path / "serve.toml").twin
        twin = ServedTwin(settings, tmp_path / "data" / "east", ServiceClock())
        broker = twin.sources()["mqtt"]
        broker.start()
        waited_for(lambda: broker.fault is None)
        yield relay, twin, broker
        broker.stop()
        twin.close()


@pytest.mark.parametrize("is_half_open", [False, True])
def test_the_probe_finds_a_broker_that_brings_nothing(
    mosquitto: Mosquitto, behind: Any, record: Record, is_half_open: bool
) -> None:
    relay, twin, broker = behind
    relay.delay = 0.02
    feeding = Feeding(record, BrokerSender(f"{mosquitto.url}/{TOPIC}"), twin, "mqtt")
    if is_half_open:
        disturbed(relay, feeding, lambda: broker.fault)
        waited_for(lambda: broker.fault is None)
    feeding.finish()
    # A network that is slow alone is no fault.
    assert (relay.lost > 0) == is_half_open
    assert broker.fault is None


@pytest.fixture
def door(measured_bridge: dict[str, Any], tmp_path: Path) -> Iterator[Any]:
    """The network between a logger and a service that listens, and its twin."""
    write_service(tmp_path, measured_bridge)
    configuration = read_configuration(tmp_path / "serve.toml")
    service = Service(configuration)
    server = server_of(app_of(service), configuration.service)
    listening = listening_socket(configuration.service)
    thread = Thread(target=server.run, args=([listening],), daemon=True)
    thread.start()
    waited_for(lambda: server.started)
    with relay_to(int(configuration.service.listen.rpartition(":")[2])) as relay:
        yield relay, service.twins["east"]
    server.should_exit = True
    thread.join()
    service.stop()


@pytest.mark.parametrize("is_half_open", [False, True])
def test_a_sender_whose_answers_are_lost_sends_again(
    door: Any, record: Record, is_half_open: bool
) -> None:
    relay, twin = door
    relay.delay = 0.02
    feeding = Feeding(record, HttpSender(f"http://127.0.0.1:{relay.port}/east"), twin, "http")
    if is_half_open:
        disturbed(relay, feeding, lambda: relay.lost)
    assert feeding.finish() <= relay.lost
