"""What a real broker is told of a twin: all of it, once where nothing fails, and again after."""

import json
import shutil
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from paho.mqtt.client import Client, MQTTMessage, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

import rga
from live_streams import SETTINGS, sinking
from rga.model import read_model
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.configuration import read_configuration
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.service import Service
from rga.twin import Reject
from rga_bench.operation.broker import Mosquitto
from served.bridges import packets_of, played
from served.brokers import mosquitto
from served.made_service import waited_for, write_service

__all__ = ["mosquitto"]

START = datetime(2026, 11, 23, tzinfo=UTC)
#: packets that the twin has taken in before anybody listens
KNOWN = 70
ABOVE = "rga/v1/east/"
SOURCE = """kind = "mqtt"
url = "mqtt://127.0.0.1:{port}"
topics = ["rga/v1/east/data"]
clock = {{ check = false }}
tell = true"""


class Listener:
    """Somebody who listens to all that is told of a twin."""

    def __init__(self, port: int) -> None:
        self.told: list[tuple[str, Any, bool]] = []
        self._client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5)
        self._client.on_connect = lambda client, *_: client.subscribe(f"{ABOVE}#", 1)
        self._client.on_subscribe = lambda *_: self._subscribed.append(True)
        self._client.on_message = self._came
        self._subscribed: list[bool] = []
        self._client.connect("127.0.0.1", port)
        self._client.loop_start()
        waited_for(lambda: self._subscribed)

    def _came(self, _: Any, __: Any, message: MQTTMessage) -> None:
        content = json.loads(message.payload) if message.payload else None
        self.told.append((message.topic.removeprefix(ABOVE), content, bool(message.retain)))

    def of(self, topic: str) -> list[Any]:
        return [content for found, content, _ in self.told if found == topic]

    def close(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()


@pytest.fixture(scope="module")
def lived_folder(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Any],
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[Path, list[bytes]]:
    """Folder of a service whose twin has lived through most of a record, and the packets of it."""
    folder = tmp_path_factory.mktemp("told")
    write_service(folder, measured_bridge, source=SOURCE.format(port=1))
    settings = SETTINGS.model_copy(update={"adopt": "ask"}).model_dump_json()
    (folder / "settings.json").write_text(settings, "utf-8")
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, 120)
    packets = packets_of(record, START)
    service = Service(read_configuration(folder / "serve.toml"))
    take(service, packets[:KNOWN])
    service.stop()
    return folder, packets


@pytest.fixture
def folder(lived_folder: tuple[Path, list[bytes]], mosquitto: Mosquitto, tmp_path: Path) -> Path:
    """A copy of it, whose source is the broker that runs."""
    found = Path(shutil.copytree(lived_folder[0], tmp_path / "served"))
    path = found / "serve.toml"
    text = path.read_text("utf-8").replace('127.0.0.1:1"', f'127.0.0.1:{mosquitto.port}"')
    path.write_text(text, "utf-8")
    return found


@pytest.fixture
def listener(mosquitto: Mosquitto) -> Iterator[Listener]:
    found = Listener(mosquitto.port)
    yield found
    found.close()


def take(service: Service, packets: list[bytes]) -> None:
    """Let the twin take packets in and play them."""
    for payload in packets:
        service.twins["east"].receive("mqtt", [("rga/v1/east/data", payload)])
    played(service.twins["east"])


def telling(folder: Path) -> Service:
    """The service, of which nothing runs but what tells the broker."""
    service = Service(read_configuration(folder / "serve.toml"))
    service._tellers["east", "mqtt"].start()
    return service


def see(service: Service, twin: str, *words: str) -> None:
    """Raise an alarm of a twin, or clear it where nothing is said."""
    key = ConditionKey(twin, "gap", "alarm", "twin")
    found = tuple(Condition(key, one, datetime.now(UTC)) for one in words)
    service.alarms.observe(twin, Observation(found, frozenset({"gap"})))


def test_what_happens_is_told(
    folder: Path, lived_folder: tuple[Path, list[bytes]], listener: Listener
) -> None:
    service = telling(folder)
    reading = TwinReading("east", service.twins["east"].directory, None)
    before = reading.now()
    assert before is not None
    first = waited_for(lambda: listener.of("state"))[0]
    assert (first["rows"], listener.of("event")) == (before.rows, [])
    take(service, lived_folder[1][KNOWN:])
    now, view = reading.now(), reading.view()
    assert now is not None
    assert view is not None
    assert now.undecided is not None
    waited_for(lambda: listener.of("state")[-1]["rows"] == now.rows)
    state = listener.of("state")[-1]
    assert (state["version"], state["stage"], state["gap"]) == (now.version, now.stage, now.gap)
    assert datetime.fromisoformat(state["time"]) == now.time
    words = [one.words for one in view.events(after=before.steps)]
    waited_for(lambda: len(listener.of("event")) >= len(words))
    assert [one["words"] for one in listener.of("event")] == words
    ids = [one["id"] for one in listener.of("event")]
    assert len({*ids}) == len(ids) > 3
    # Every row that has a gap, once, as the pages show it.
    series = reading.series(0.0, np.inf, 10_000)
    assert series is not None
    told = {one["time"]: one["sensors"] for one in listener.of("gap")}
    assert len(told) == len(listener.of("gap")) > 50
    for k, name in enumerate(series.sensors):
        gaps = [one[name] for one in told.values()]
        expected = series.gap.mean[-len(gaps) :, k]
        np.testing.assert_array_equal(np.array(gaps, dtype=float), expected)
    number = now.undecided.number
    (proposal,) = listener.of(f"proposal/{number}")
    assert (proposal["words"], proposal["decided"]) == (now.undecided.words, None)
    with rga.LiveTwin(service.twins["east"].directory) as live:
        live.ask(Reject(who="Ada", why="greased"))
        live.play()
    waited_for(lambda: len(listener.of(f"proposal/{number}")) == 3)
    assert listener.of(f"proposal/{number}")[1]["decided"] == "decided by Ada: reject"
    assert listener.of(f"proposal/{number}")[2] is None
    service.stop()


def test_alarms_are_told_until_they_are_closed(folder: Path, listener: Listener) -> None:
    service = telling(folder)
    waited_for(lambda: listener.of("state"))
    see(service, "west", "another twin is out of step")
    see(service, "east", "it is out of step")
    number = service.alarms.open()[-1].id
    topic = f"alarm/{number}"
    waited_for(lambda: listener.of(topic))
    service.alarms.acknowledge(number, "Ada")
    waited_for(lambda: len(listener.of(topic)) == 2)
    see(service, "east")
    waited_for(lambda: len(listener.of(topic)) == 4)
    *told, last = listener.of(topic)
    assert [one["state"] for one in told] == ["raised", "acknowledged", "closed"]
    assert last is None
    assert [one for one, _, _ in listener.told if one.startswith("alarm/")] == [topic] * 4
    service.stop()


def test_what_came_while_it_was_away_is_told_and_nothing_twice(
    folder: Path, lived_folder: tuple[Path, list[bytes]], listener: Listener
) -> None:
    service = telling(folder)
    waited_for(lambda: service._tellers["east", "mqtt"]._told)
    service.stop()
    (gap,) = listener.of("gap")
    service = Service(read_configuration(folder / "serve.toml"))
    reading = TwinReading("east", service.twins["east"].directory, None)
    before = reading.now()
    assert before is not None
    take(service, lived_folder[1][KNOWN:])
    see(service, "east", "it is out of step")
    now, view = reading.now(), reading.view()
    assert now is not None
    assert view is not None
    service.stop()
    service = telling(folder)
    waited_for(lambda: listener.of("state")[-1]["rows"] == now.rows > before.rows)
    words = [one.words for one in view.events(after=before.steps)]
    assert [one["words"] for one in listener.of("event")] == words
    times = [one["time"] for one in listener.of("gap")]
    assert times[0] == gap["time"]
    # The last is told again to a broker that may have lost it.
    assert times == [*sorted({*times}), times[-1]]
    assert listener.of("alarm/1")[0]["words"] == "it is out of step"
    service.stop()


def test_a_broker_that_has_forgotten_is_told_anew(folder: Path, mosquitto: Mosquitto) -> None:
    service = telling(folder)
    see(service, "east", "it is out of step")
    first = Listener(mosquitto.port)
    waited_for(lambda: {"state", "gap"} <= {one for one, _, _ in first.told})
    first.close()
    mosquitto.kill()
    teller = service._tellers["east", "mqtt"]
    waited_for(lambda: teller.fault)
    # What comes in does not wait for it.
    assert service.twins["east"].receive("mqtt", [("x", b"{}")])[0][0] == "refused"
    mosquitto.start()
    waited_for(lambda: teller.fault is None)
    second = Listener(mosquitto.port)
    waited_for(lambda: {"state", "gap", "alarm/1"} <= {one for one, _, _ in second.told})
    second.close()
    service.stop()
