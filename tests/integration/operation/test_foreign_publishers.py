"""Senders of others: the same rows bit for bit, whatever format and way they take."""

import json
import time
from collections.abc import Callable, Iterable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.request import Request, urlopen

import numpy as np
import pytest
import uvicorn
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from live_streams import SETTINGS
from rga.dashboard.app import app_of
from rga.operation.configuration import read_configuration
from rga.operation.inbox.account import Account
from rga.operation.served_twin import ServedTwin
from rga.operation.service import Service
from rga.twin.hardware.inbox import Inbox
from rga_bench.operation.broker import Mosquitto
from served.brokers import mosquitto

__all__ = ["mosquitto"]

#: seconds since 1970, and what each sensor reads
Reading = tuple[float, dict[str, float]]
Writer = Callable[[Sequence[Reading]], str]


def native(rows: Sequence[Reading]) -> str:
    """A packet of rga's own: the time of the first row, and seconds since."""
    names = _names(rows)
    return json.dumps({
        "v": 1, "t0": stamp(rows[0][0]), "t": [time - rows[0][0] for time, _ in rows],
        "channels": names, "values": [[values.get(one) for one in names] for _, values in rows],
    })  # fmt: skip


def senml(rows: Sequence[Reading]) -> str:
    """SenML: a base name and a base time, and records after it."""
    records = [
        {"n": name, "t": time - rows[0][0], "v": value}
        for time, values in rows
        for name, value in values.items()
    ]
    return json.dumps([{"bn": "east/", "bt": rows[0][0], **records[0]}, *records[1:]])


def data_array(rows: Sequence[Reading]) -> str:
    """SensorThings: a data array for each data stream."""
    return json.dumps([
        {
            "Datastream": {"@iot.id": 1, "name": f"east/{name}"},
            "components": ["phenomenonTime", "result"],
            "dataArray": [[stamp(time), values[name]] for time, values in rows if name in values],
        }
        for name in _names(rows)
    ])  # fmt: skip


def line_protocol(rows: Sequence[Reading]) -> str:
    """Line protocol of InfluxDB, in nanoseconds."""
    return "\n".join(
        f"east,sensor={name} value={value!r} {round(time * 1000)}000000"
        for time, values in rows
        for name, value in values.items()
    )


WRITERS: dict[str, tuple[Writer, str, str | None]] = {
    "native": (native, "{channel}", "application/json"),
    "senml": (senml, "east/{channel}", "application/senml+json"),
    "sensorthings": (data_array, "east/{channel}", None),
    "line_protocol": (line_protocol, "east {channel} value", "text/plain"),
}


def _names(rows: Sequence[Reading]) -> list[str]:
    return sorted({name for _, values in rows for name in values})


def stamp(time: float) -> str:
    """ISO 8601, to the millisecond."""
    return datetime.fromtimestamp(time, UTC).isoformat(timespec="milliseconds")


def publish(port: int, topic: str, payloads: Iterable[str]) -> None:
    """Send payloads to a broker: that is all that a sender of others does."""
    client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5)
    client.connect("127.0.0.1", port)
    client.loop_start()
    for payload in payloads:
        client.publish(topic, payload, qos=1).wait_for_publish(20)
    client.disconnect()
    client.loop_stop()


def post(url: str, content_type: str | None, payloads: Iterable[str]) -> list[bytes]:
    """Send payloads to a service, and what it answers."""
    headers = {"Content-Type": content_type} if content_type else {}
    answers = []
    for payload in payloads:
        with urlopen(Request(url, payload.encode(), headers, method="POST"), timeout=20) as answer:
            answers.append(answer.read())
    return answers


#: 2026-11-23T00:00:00Z [s since 1970]
MIDNIGHT = 1_795_392_000.0
CHANNELS = ("D1", "D2", "temperature")
TWIN = """
[[twin]]
name = "{name}"
model = "model.json"
settings = "settings.json"
rows = {{ every = "60 s", lateness = "60 s" }}
[[twin.source]]
mapping = "{name}.toml"
clock = {{ check = false }}
"""


def readings() -> list[list[Reading]]:
    """Of 10 minutes at 4 Hz, some at a time; every sensor lacks one now and then."""
    draw = np.random.default_rng(3)
    rows = [
        (
            MIDNIGHT + k / 4,
            {name: float(draw.normal()) for name in CHANNELS if draw.random() > 0.02},
        )
        for k in range(2400)
    ]
    return [rows[k : k + 40] for k in range(0, len(rows), 40)]


@pytest.fixture
def service(measured_bridge: dict[str, Any], tmp_path: Path) -> Callable[[str], Service]:
    """A service with a twin for each format; what its sources state is given."""

    def made(source: str) -> Service:
        for name, (_, header, _) in WRITERS.items():
            (tmp_path / f"{name}.toml").write_text(f'header = "{header}"\n', "utf-8")
        (tmp_path / "model.json").write_text(json.dumps(measured_bridge), "utf-8")
        (tmp_path / "settings.json").write_text(SETTINGS.model_dump_json(), "utf-8")
        twins = [TWIN.format(name=name) + source.format(name=name) for name in WRITERS]
        (tmp_path / "serve.toml").write_text("\n".join(twins), "utf-8")
        return Service(read_configuration(tmp_path / "serve.toml"))

    return made


def rows_of(twin: ServedTwin) -> np.ndarray:
    """The rows of a twin, all of them final."""
    for source in twin.source_names:
        twin._heard[source] -= 10_000
    twin.seal()
    inbox = Inbox(twin.directory)
    station = inbox.station
    assert station is not None
    assert station.start == "2026-11-23T00:00:00+00:00"
    packet = inbox.packet(station, 0, 1000)
    inbox.close()
    return np.column_stack([packet.time, packet.readings, packet.contexts])


def check(service: Service) -> None:
    """All twins have the same rows, which are the means of what was sent."""
    expected = rows_of(service.twins["native"])
    sent = [one for batch in readings() for one in batch]
    means = [
        [
            np.mean([one[name] for time, one in sent if time // 60 == minute and name in one])
            for name in CHANNELS
        ]
        for minute in np.unique([time // 60 for time, _ in sent])
    ]
    np.testing.assert_allclose(expected[:, [1, 2, -1]], means, rtol=1e-9, atol=1e-12)
    for name, twin in service.twins.items():
        np.testing.assert_array_equal(rows_of(twin), expected, err_msg=name)
        account = sum(twin.packets.account().values(), Account())
        assert account == Account(received=60, used=60), name


def test_the_same_rows_come_through_a_broker(
    mosquitto: Mosquitto, service: Callable[[str], Service]
) -> None:
    made = service(f'kind = "mqtt"\nurl = "{mosquitto.url}"\ntopics = ["plant/{{name}}/#"]\n')
    sources = [source for twin in made.twins.values() for source in twin.sources().values()]
    for source in sources:
        source.start()
    wait_for(lambda: all(source.fault is None for source in sources))
    for name, (write, *_) in WRITERS.items():
        publish(mosquitto.port, f"plant/{name}/logger", map(write, readings()))
    wait_for(lambda: all(received(twin) == 60 for twin in made.twins.values()))
    check(made)
    for source in sources:
        source.stop()
    made.stop()


def test_the_same_rows_come_through_http(service: Callable[[str], Service]) -> None:
    made = service('kind = "http"\n')
    server = uvicorn.Server(uvicorn.Config(app_of(made), port=0, log_level="error"))
    thread = Thread(target=server.run, daemon=True)
    thread.start()
    wait_for(lambda: server.started)
    port = server.servers[0].sockets[0].getsockname()[1]
    for name, (write, _, content_type) in WRITERS.items():
        url = f"http://127.0.0.1:{port}/api/v1/twins/{name}/packets"
        answers = post(url, content_type, map(write, readings()))
        assert {json.loads(one)["stored"] for one in answers} == {1}
    # What is none is told in the answer, by the format that the sender says.
    for content_type, words in (
        ("application/senml+json", "no SenML"),
        ("application/vnd.influx.line-protocol", "not of the line protocol"),
    ):
        (answer,) = post(url, content_type, ["{}"])
        assert words in json.loads(answer)["refused"][0]
    server.should_exit = True
    thread.join()
    for twin in made.twins.values():
        assert twin.remarks("http").refused == {}
    refused = sum(made.twins["line_protocol"].packets.account().values(), Account()).refused
    assert refused == 2
    expected = rows_of(made.twins["native"])
    for name, twin in made.twins.items():
        np.testing.assert_array_equal(rows_of(twin), expected, err_msg=name)
    made.stop()


def received(twin: ServedTwin) -> int:
    return sum(one.received for one in twin.packets.account().values())


def wait_for(what: Callable[[], Any]) -> None:
    until = time.monotonic() + 60
    while not what():
        assert time.monotonic() < until, "it does not come"
        time.sleep(0.05)
