"""A logger that sends through a broker: what the broker loses comes again, in order."""

import json
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import accumulate
from pathlib import Path
from typing import Any

import pytest
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from rga.errors import InputError
from rga.operation.feeding import senders
from rga.operation.feeding.senders import BrokerSender
from rga.operation.packets.packet import Number
from rga_bench.operation.broker import Mosquitto
from served.brokers import mosquitto
from served.made_service import waited_for

__all__ = ["mosquitto"]

TOPIC = "rga/v1/east/data/logger"


class Listener:
    """Stands for a service: it says what it has."""

    def __init__(self, port: int, source: str = "mqtt", *, answers: bool = True) -> None:
        self.came: list[int] = []
        self._answers, self._ack = answers, f"rga/v1/east/ack/{source}"
        self._client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5)
        self._client.on_message = self._take
        self._client.connect("127.0.0.1", port)
        self._client.subscribe(TOPIC, 1)
        self._client.loop_start()

    def stop(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def _take(self, _client: Client, _: Any, message: Any) -> None:
        self.came.append(int(message.payload))
        if not self._answers:
            return
        next_ = max(self.came) + 1
        missing = [(k, k) for k in range(next_) if k not in self.came]
        self.acknowledge(next_, missing)

    def acknowledge(self, next_: int, missing: Sequence[tuple[int, int]] = ()) -> None:
        """Say that all below a number is kept, but for what is missing."""
        said = {"stream": "s", "next": next_, "missing": missing}
        self._client.publish(self._ack, json.dumps(said), qos=1)


@pytest.mark.parametrize("later", [0.0, 1.5], ids=["before the logger", "after it"])
def test_what_a_broker_had_taken_and_lost_comes_before_anything_later(
    mosquitto: Mosquitto, later: float
) -> None:
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    # The broker takes these, and keeps none.
    witness = Listener(mosquitto.port, answers=False)
    for k in range(10):
        sender.send(str(k).encode(), Number("s", k))
    waited_for(lambda: len(witness.came) == 10)
    witness.stop()
    mosquitto.kill()
    mosquitto.start()
    with ThreadPoolExecutor() as pool:
        sending = pool.submit(sender.send, b"10", Number("s", 10))
        time.sleep(later)
        listener = Listener(mosquitto.port)
        sending.result()
    sender.finish()
    listener.stop()
    assert set(listener.came) == set(range(11))
    highest = accumulate(listener.came, max, initial=-1)
    assert all(number <= before + 1 for before, number in zip(highest, listener.came, strict=False))


def test_a_broker_that_refuses_is_told(mosquitto: Mosquitto, tmp_path: Path) -> None:
    mosquitto.kill()
    configuration = tmp_path / "broker" / "mosquitto.conf"
    text = configuration.read_text("utf-8")
    configuration.write_text(text.replace("allow_anonymous true", "allow_anonymous false"), "utf-8")
    mosquitto.start()
    with pytest.raises(InputError, match="refuses the connection"):
        BrokerSender(f"{mosquitto.url}/{TOPIC}").send(b"0", None)


@pytest.mark.parametrize(
    "url",
    ["mqtt:///rga/v1/east/data/x", "mqtt://h:99999/rga/v1/east/data/x", "mqtt://h/rga/v1/+/data"],
)
def test_an_address_that_is_none_is_told(url: str) -> None:
    with pytest.raises(InputError, match=r"names no (host and port|twin)"):
        BrokerSender(url)


def test_a_service_that_never_acknowledges_is_told_of_once(
    mosquitto: Mosquitto, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(senders, "SILENT", 0.2)
    monkeypatch.setattr(senders, "UNACKNOWLEDGED", 0.1)
    told: list[str] = []
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}", "logger", told=told.append)
    sender.send(b"0", Number("s", 0))
    with ThreadPoolExecutor() as pool:
        finishing = pool.submit(sender.finish)
        time.sleep(2.5)
        listener = Listener(mosquitto.port, "logger")
        finishing.result()
    listener.stop()
    assert len(told) == 1
    assert "the source 'logger' of twin 'east' is waited for" in told[0]


def test_a_slow_service_is_sent_nothing_many_times(
    mosquitto: Mosquitto, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A broker drops what waits there beyond a thousand, and be it sent for the first time."""
    monkeypatch.setattr(senders, "UNACKNOWLEDGED", 0.05)
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    listener = Listener(mosquitto.port, answers=False)
    for k in range(12):
        sender.send(str(k).encode(), Number("s", k))
    with ThreadPoolExecutor() as pool:
        finishing = pool.submit(sender.finish)
        for k in range(12):
            time.sleep(0.3)
            listener.acknowledge(k + 1)
        finishing.result()
    listener.stop()
    # Once, once more, and while it is the first of those that wait.
    copies = Counter(listener.came)
    assert set(copies) == set(range(12))
    assert max(copies.values()) <= 4


def test_what_waits_in_a_broker_is_bounded(
    mosquitto: Mosquitto, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A service that is killed again and again fetches a few between."""
    for name, value in (("UNACKNOWLEDGED", 0.1), ("AGAIN", 0.2), ("MOST_OPEN", 20)):
        monkeypatch.setattr(senders, name, value)
    packets, fetched, waiting, kept = 60, 0, [0], set[int]()
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    listener = Listener(mosquitto.port, answers=False)
    sender.send(b"0", Number("s", 0))
    with ThreadPoolExecutor() as pool:

        def feed() -> None:
            for k in range(1, packets):
                sender.send(str(k).encode(), Number("s", k))
            sender.finish()

        feeding = pool.submit(feed)
        while not feeding.done():
            time.sleep(0.4)
            waiting.append(len(listener.came) - fetched)
            kept |= set(listener.came[fetched : fetched + 8])
            fetched += min(8, waiting[-1])
            first_missing = next(k for k in range(packets + 1) if k not in kept)
            listener.acknowledge(first_missing)
        feeding.result()
    listener.stop()
    assert kept == set(range(packets))
    # Each twice, and the first once more every time that it is waited for.
    assert max(waiting) <= 2 * 20 + 5
