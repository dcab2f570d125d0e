"""Ways in which a logger sends: to the service itself, through a broker, or into a folder."""

import json
import ssl
import time
from collections import OrderedDict
from pathlib import Path
from threading import Lock
from typing import Protocol
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from paho.mqtt.client import Client, MQTTMessage, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from rga.errors import InputError
from rga.operation.packets.packet import Number

#: how long a logger waits for an answer, and before it tries again [s]
ANSWER, AGAIN = 30.0, 1.0
#: how long it waits for a packet to be acknowledged end to end before it sends it again [s]
UNACKNOWLEDGED = 5.0
#: packets that are on their way at most: mosquitto as it comes drops what waits beyond a thousand,
#: and what is sent again comes behind the others, too late for its row
MOST_OPEN = 1_000


class Sender(Protocol):
    """Sends payloads, as often as it takes."""

    def send(self, payload: bytes, number: Number | None) -> None:
        """Send a payload; it may be on its way when this returns."""

    def finish(self) -> None:
        """Wait until everything is acknowledged."""


class HttpSender:
    """Sends to the API of a service; an answer says that the payload is on its disk.

    Args:
        url: of the service and the twin, http://host:port/twin.
        token: that lets it send; None: the service asks for none.
    """

    def __init__(self, url: str, token: str | None = None) -> None:
        parts = urlsplit(url)
        twin = parts.path.strip("/")
        self._url = f"{parts.scheme}://{parts.netloc}/api/v1/twins/{twin}/packets"
        self._headers = {"Content-Type": "application/octet-stream"}
        if token is not None:
            self._headers["Authorization"] = f"Bearer {token}"

    def send(self, payload: bytes, number: Number | None) -> None:
        """Send a payload until the service says what became of it.

        Raises:
            InputError: the service says that it never will.
        """
        while True:
            try:
                asked = Request(self._url, payload, self._headers, method="POST")
                with urlopen(asked, timeout=ANSWER):
                    return
            except HTTPError as error:
                if error.code not in (429, 503, 507):
                    said = error.read(500).decode(errors="replace")
                    raise InputError(
                        f"the service answers {error.code}: {said}", self._url, "check the address"
                    ) from None
            except (URLError, OSError):
                pass
            time.sleep(AGAIN)

    def finish(self) -> None:
        """Nothing is on its way."""


class BrokerSender:
    """Sends through a broker, and again what the service does not acknowledge.

    Args:
        url: of the broker and the topic, mqtt://host:port/rga/v1/twin/data/logger.
        source: of the twin, of which the service says what it has.
        credentials: user and password; None: the broker asks for none.

    Raises:
        InputError: the topic names no twin.
    """

    def __init__(
        self, url: str, source: str = "mqtt", credentials: tuple[str, str] | None = None
    ) -> None:
        parts = urlsplit(url)
        self._topic = parts.path.strip("/")
        root, twin = self._topic.split("/")[:2], self._topic.split("/")[2:3]
        if root != ["rga", "v1"] or not twin:
            raise InputError(
                "the topic names no twin", url, "write mqtt://host:1883/rga/v1/TWIN/data/LOGGER"
            )
        self._open: OrderedDict[Number, tuple[bytes, float]] = OrderedDict()
        self._lock = Lock()
        self._client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5)
        if credentials is not None:
            self._client.username_pw_set(*credentials)
        if parts.scheme == "mqtts":
            self._client.tls_set_context(ssl.create_default_context())
        acknowledged = f"rga/v1/{twin[0]}/ack/{source}"
        self._client.on_connect = lambda client, *_: client.subscribe(acknowledged, 1)
        self._client.on_message = self._told
        port = parts.port or (8883 if parts.scheme == "mqtts" else 1883)
        self._client.connect_async(parts.hostname or "", port)
        self._client.loop_start()

    def send(self, payload: bytes, number: Number | None) -> None:
        """Send a payload, and what was sent before and is not acknowledged.

        It waits for the broker: what is sent as the connection begins may overtake what has waited
        for it.
        """
        while not self._client.is_connected():
            time.sleep(AGAIN / 10)
        if number is not None:
            with self._lock:
                self._open[number] = payload, time.monotonic()
        self._client.publish(self._topic, payload, qos=1)
        self._send_again()
        while len(self._open) >= MOST_OPEN:
            time.sleep(AGAIN / 10)
            self._send_again()

    def finish(self) -> None:
        """Wait until everything is acknowledged."""
        while self._open:
            time.sleep(AGAIN / 10)
            self._send_again()
        self._client.disconnect()
        self._client.loop_stop()

    def _send_again(self) -> None:
        now = time.monotonic()
        with self._lock:
            late = [
                (number, payload)
                for number, (payload, sent) in self._open.items()
                if now - sent > UNACKNOWLEDGED
            ]
            for number, payload in late:
                self._open[number] = payload, now
        for _, payload in late:
            self._client.publish(self._topic, payload, qos=1)

    def _told(self, _client: Client, _data: object, message: MQTTMessage) -> None:
        told = json.loads(message.payload)
        missing = [range(first, last + 1) for first, last in told["missing"]]
        with self._lock:
            for number in list(self._open):
                here = number.stream == told["stream"] and number.sequence < told["next"]
                if here and not any(number.sequence in one for one in missing):
                    del self._open[number]


class FolderSender:
    """Writes each payload as a file into a folder.

    Args:
        folder: that a service looks at.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._count = folder, 0

    def send(self, payload: bytes, number: Number | None) -> None:
        """Write a file that is whole when it can be seen."""
        self._count += 1
        draft = self._folder / f".{self._count:08d}"
        draft.write_bytes(payload)
        draft.rename(self._folder / f"{self._count:08d}.packet")

    def finish(self) -> None:
        """Nothing is on its way."""
