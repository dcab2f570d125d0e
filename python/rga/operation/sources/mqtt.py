"""A broker that loggers send to: a message is acknowledged when its packet is on the disk."""

import json
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event, Thread
from typing import Any

from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.subscribeoptions import SubscribeOptions

from rga.operation.inbox.numbers import Numbers
from rga.operation.sources.broker_client import address_of, broker_client
from rga.operation.sources.source import Inlet, attempt

#: messages that are kept together
MOST_MESSAGES = 256
#: messages that the broker sends before the first of them is acknowledged
RECEIVE_MAXIMUM = 100
#: how long the broker keeps what is sent while the service is away [s]
SESSION = 7 * 86_400
#: how often the way through the broker is tried [s], and after how long it is broken
PROBE, BROKEN = 30.0, 90.0
#: how long the broker may say nothing at all, or not let the service in, before it is left [s]
KEEP_ALIVE = 20
#: least time between two acknowledgements end to end [s]
ACKNOWLEDGE = 1.0
#: gaps that are told at once
MOST_TOLD = 100
#: how long to wait before writing is tried again [s]
AGAIN = 1.0


class Broker:
    """Takes packets from a broker.

    Nothing is acknowledged before it is kept, so that the broker holds back what the disk has no
    room for. Where packets are numbered, the topic `ack` says up to which number they are kept,
    and which are missing: a sender that reads it loses nothing, whatever the broker does.

    Args:
        url: mqtt:// or mqtts://, host and port.
        topics: that hold data.
        twin, source: names, for the topics of the service.
        credentials: file of two lines, user and password.
        inlet: keeps what came.

    Raises:
        InputError: the credentials cannot be read.
    """

    def __init__(
        self,
        url: str,
        topics: Sequence[str],
        twin: str,
        source: str,
        credentials: Path | None,
        inlet: Inlet,
    ) -> None:
        self._host, self._port = address_of(url)
        self._topics, self._inlet = tuple(topics), inlet
        self._probe = f"rga/v1/{twin}/probe/{source}"
        self._ack = f"rga/v1/{twin}/ack/{source}"
        self._status = f"rga/v1/{twin}/status"
        # Each with the number of the connection that it came by.
        self._waiting: SimpleQueue[tuple[int, MQTTMessage]] = SimpleQueue()
        self._connection = 0
        self._ending = Event()
        self._probed = self._answered = time.monotonic()
        self._told = 0.0
        self._untold: dict[str, Numbers] = {}
        self._client = self._made(broker_client(f"rga-{twin}-{source}", url, credentials))
        self._thread = Thread(target=self._work, name=f"broker of {twin}", daemon=True)
        self.fault: str | None = "not connected yet"

    def start(self) -> None:
        """Connect, as often as it takes, and take packets."""
        properties = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]
        properties.SessionExpiryInterval = SESSION
        properties.ReceiveMaximum = RECEIVE_MAXIMUM
        self._client.connect_async(
            self._host, self._port, KEEP_ALIVE, clean_start=False, properties=properties
        )
        self._client.loop_start()
        self._thread.start()

    def stop(self) -> None:
        """Keep what has come, and let the broker hold what comes."""
        self._ending.set()
        if self._thread.ident is None:
            return
        self._thread.join()
        self._client.publish(self._status, "offline", qos=1, retain=True)
        self._client.disconnect()
        self._client.loop_stop()

    def _made(self, client: Client) -> Client:
        client.manual_ack_set(True)
        client.will_set(self._status, "offline", qos=1, retain=True)
        client.on_connect, client.on_disconnect = self._connected, self._disconnected
        client.on_message, client.on_connect_fail = self._came, self._unanswered
        return client

    def _connected(self, client: Client, _: Any, flags: Any, reason: Any, *__: Any) -> None:
        if reason.is_failure:
            self.fault = f"the broker refuses: {reason}"
            return
        self.fault = None
        self._connection += 1
        if flags.session_present:
            # The broker sends again what is not acknowledged: nothing is to wait here twice.
            self._waiting = SimpleQueue()
        options = SubscribeOptions(qos=1)
        client.subscribe([(topic, options) for topic in (*self._topics, self._probe)])
        client.publish(self._status, "online", qos=1, retain=True)
        self._answered = time.monotonic()

    def _unanswered(self, _client: Client, _: Any) -> None:
        self.fault = f"nobody answers at {self._host}:{self._port}"

    def _disconnected(self, _client: Client, _: Any, __: Any, reason: Any, *___: Any) -> None:
        self.fault = f"the broker is away: {reason}"

    def _came(self, client: Client, _: Any, message: MQTTMessage) -> None:
        if message.topic == self._probe:
            self._answered = time.monotonic()
            client.ack(message.mid, message.qos)
        else:
            self._waiting.put((self._connection, message))

    def _work(self) -> None:
        """Keep what comes, in batches, until the end."""
        batch: list[tuple[int, MQTTMessage]] = []
        while not self._ending.is_set():
            # While nothing can be kept, the broker sends nothing more, and that is no fault of it.
            wrong = None if batch else attempt(self._try_the_way)
            batch = batch or self._batch()
            if batch and not (wrong := attempt(partial(self._keep_batch, batch))):
                batch = []
            self._acknowledge()
            if wrong:
                # What is not kept is not acknowledged, and is tried again.
                self.fault = wrong
                self._ending.wait(AGAIN)

    def _batch(self) -> list[tuple[int, MQTTMessage]]:
        """What has come meanwhile: the more there is, the more is kept at once."""
        batch: list[tuple[int, MQTTMessage]] = []
        try:
            batch.append(self._waiting.get(timeout=ACKNOWLEDGE / 4))
            while len(batch) < MOST_MESSAGES:
                batch.append(self._waiting.get_nowait())
        except Empty:
            pass
        return batch

    def _keep_batch(self, batch: Sequence[tuple[int, MQTTMessage]]) -> None:
        """Keep messages, then acknowledge them."""
        self._inlet.receive([(one.topic, bytes(one.payload)) for _, one in batch])
        self.fault, self._answered = None, time.monotonic()
        for connection, one in batch:
            # What an earlier connection brought comes again, and its number may be another's now.
            if connection == self._connection:
                self._client.ack(one.mid, one.qos)
        self._untold = self._inlet.numbers()

    def _acknowledge(self) -> None:
        """Tell senders what is kept, if that is news, and the last time is long enough ago."""
        now = time.monotonic()
        if not self._untold or now - self._told < ACKNOWLEDGE:
            return
        numbers, self._told, self._untold = self._untold, now, {}
        for stream, known in numbers.items():
            told, untold = known.gaps[:MOST_TOLD], known.gaps[MOST_TOLD:]
            # Whoever reads it takes what is below the next and not missing for kept.
            below = untold[0][0] if untold else known.next
            said = {"stream": stream, "seq": known.whole - 1, "next": below, "missing": told}
            self._client.publish(self._ack, json.dumps(said), qos=1, retain=True)

    def _try_the_way(self) -> None:
        """Send something through the broker: it may be connected and yet bring nothing."""
        now = time.monotonic()
        if not self._client.is_connected() or now - self._probed < PROBE:
            return
        self._probed = now
        if now - self._answered > BROKEN:
            self.fault = "the broker is connected and brings nothing"
            self._client.reconnect()
        self._client.publish(self._probe, b"", qos=1)
