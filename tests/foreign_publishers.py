"""Loggers of others, each in the few lines that somebody writes for one."""

import json
from collections.abc import Callable, Iterable, Sequence
from datetime import UTC, datetime
from urllib.request import Request, urlopen

from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

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
