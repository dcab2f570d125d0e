"""Packets through a real broker: each is acknowledged when it is kept, and loss is told."""

import json
import queue
import time
from typing import Any

import pytest
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from rga.errors import InputError
from rga.operation.inbox.numbers import Numbers
from rga.operation.sources.mqtt import Broker
from rga.operation.sources.source import Outcome
from rga_bench.operation.broker import Mosquitto
from served.brokers import mosquitto
from served.made_service import waited_for

__all__ = ["mosquitto"]

TOPIC = "rga/v1/east/data/logger"


class Sender:
    """A logger: what it sends, and what it is told of it."""

    def __init__(self, broker: Mosquitto) -> None:
        self.told: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        self._client = Client(CallbackAPIVersion.VERSION2, "logger", protocol=MQTTv5)
        self._client.on_connect = lambda client, *_: client.subscribe("rga/v1/east/ack/#", 1)
        self._client.on_message = lambda _, __, message: self.told.put(json.loads(message.payload))
        self._client.connect("127.0.0.1", broker.port)
        self._client.loop_start()

    def send(self, payload: bytes, waits: bool = True) -> None:
        sent = self._client.publish(TOPIC, payload, qos=1)
        if waits:
            sent.wait_for_publish(20)

    def close(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()


class Kept:
    """What a service has kept: payloads that are numbers, and how many of them are missing."""

    def __init__(self) -> None:
        self.payloads: list[bytes] = []
        self.known = Numbers()
        self.full = False

    def receive(self, payloads: Any, cursor: Any = None) -> list[Outcome]:
        if self.full:
            raise InputError("the disk is full", "a test", "make room")
        for _, payload in payloads:
            self.payloads.append(payload)
            self.known.take(int(payload))
        return []

    def receive_lines(self, where: str, head: bytes, lines: bytes, cursor: Any) -> list[Outcome]:
        raise AssertionError("no lines of files come here")

    def cursor(self) -> dict[str, Any]:
        return {}

    def numbers(self) -> dict[str, Numbers]:
        return {"s": self.known}


@pytest.fixture
def kept(mosquitto: Mosquitto) -> Any:
    """What a service keeps that takes packets from the broker."""
    keeper = Kept()
    broker = Broker(mosquitto.url, [f"{TOPIC}/#", TOPIC], "east", "mqtt", None, keeper)
    broker.start()
    waited_for(lambda: broker.fault is None)
    yield keeper
    broker.stop()


def test_what_is_kept_is_acknowledged_end_to_end(mosquitto: Mosquitto, kept: Kept) -> None:
    sender = Sender(mosquitto)
    for number in (0, 1, 3):
        sender.send(b"%d" % number)
    waited_for(lambda: kept.known.next == 4)
    # Two topics that overlap bring a message twice at most.
    assert set(kept.payloads) == {b"0", b"1", b"3"}
    sender.send(b"4")
    waited_for(lambda: kept.known.next == 5)
    told: dict[str, Any] = {"next": 0}
    while told["next"] < 5:
        told = sender.told.get(timeout=20)
    assert told == {"stream": "s", "seq": 1, "next": 5, "missing": [[2, 2]]}
    sender.close()


def test_what_cannot_be_written_waits(mosquitto: Mosquitto, kept: Kept) -> None:
    sender = Sender(mosquitto)
    kept.full = True
    for number in range(300):
        sender.send(b"%d" % number)
    time.sleep(1.0)
    assert kept.payloads == []
    kept.full = False
    waited_for(lambda: kept.known.next == 300)
    assert kept.known.gaps == []
    sender.close()


def test_a_service_that_was_away_gets_what_was_sent(mosquitto: Mosquitto) -> None:
    def broker(keeper: Kept) -> Broker:
        made = Broker(mosquitto.url, [TOPIC], "east", "mqtt", None, keeper)
        made.start()
        waited_for(lambda: made.fault is None)
        return made

    first, second = Kept(), Kept()
    sender = Sender(mosquitto)
    running = broker(first)
    sender.send(b"0")
    waited_for(lambda: first.payloads)
    running.stop()
    for number in range(1, 200):
        sender.send(b"%d" % number)
    running = broker(second)
    waited_for(lambda: second.known.next == 200)
    assert [int(one) for one in second.payloads] == list(range(1, 200))
    running.stop()
    sender.close()


def test_a_broker_that_was_killed_is_found_again(mosquitto: Mosquitto, kept: Kept) -> None:
    sender = Sender(mosquitto)
    sender.send(b"0")
    waited_for(lambda: kept.known.next == 1)
    mosquitto.kill()
    mosquitto.start()
    number = 0
    until = time.monotonic() + 30
    while kept.known.next < 3:
        assert time.monotonic() < until
        number += 1
        sender.send(b"%d" % number, waits=False)
        time.sleep(0.1)
    # What the broker confirmed and lost is told.
    missing = {n for first, last in kept.known.gaps for n in range(first, last + 1)}
    assert missing == set(range(kept.known.next)) - {int(one) for one in kept.payloads}
    sender.close()
