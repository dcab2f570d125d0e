"""Ways in which a logger sends: to the service itself, through a broker, or into a folder."""

import json
import ssl
import time
from collections import OrderedDict
from collections.abc import Callable
from http.client import HTTPException
from pathlib import Path
from threading import Lock
from typing import Any, Protocol
from urllib.error import HTTPError, URLError
from urllib.parse import SplitResult, urlsplit
from urllib.request import Request, urlopen

from paho.mqtt.client import Client, MQTTMessage, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from rga.errors import InputError
from rga.operation.packets.packet import Number
from rga.operation.sources.broker_client import address_of

#: how long a logger waits for an answer, and before it tries again [s]
ANSWER, AGAIN = 30.0, 1.0
#: how long it waits for any packet to be acknowledged end to end before it sends them again [s]
UNACKNOWLEDGED = 5.0
#: how long nobody answers before that is told [s]
SILENT = 5.0
#: packets that are on their way at most: mosquitto as it comes drops what waits beyond a thousand,
#: and each of these may wait there twice, the first of them more often
MOST_OPEN = 400
#: times that the first is sent again at that pace, before it is sent ever more seldom
OFTEN = 10


class Sender(Protocol):
    """Sends payloads, as often as it takes."""

    def send(self, payload: bytes, number: Number | None) -> None:
        """Send a payload; it may be on its way when this returns."""

    def finish(self) -> None:
        """Wait until everything is acknowledged."""


class _Silence:
    """Tells once when nobody has answered for a while, and again once somebody has meanwhile.

    Args:
        told: takes the words.
    """

    def __init__(self, told: Callable[[str], None]) -> None:
        self._told, self._said, self._since = told, False, time.monotonic()

    def heard(self) -> None:
        """Somebody has answered."""
        self._said, self._since = False, time.monotonic()

    def tell(self, words: str) -> None:
        """Say what keeps anybody from answering, if that has lasted, and was not said."""
        if not self._said and time.monotonic() - self._since > SILENT:
            self._said = True
            self._told(words)


def _nothing_told(words: str) -> None:
    """Nobody wants to hear it."""


class HttpSender:
    """Sends to the API of a service; an answer says that the payload is on its disk.

    Args:
        url: of the service and the twin, http://host:port/twin.
        token: that lets it send; None: the service asks for none.
        told: takes in words that nobody answers.

    Raises:
        InputError: the address names no host.

    Attributes:
        refused: packets that the service keeps aside, with the reason; garbage is meant to be.
    """

    def __init__(
        self, url: str, token: str | None = None, told: Callable[[str], None] = _nothing_told
    ) -> None:
        parts, self._place, self._silence = _parts_of(url), url, _Silence(told)
        self._told = told
        self.refused: dict[Number, str] = {}
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
        self._silence.heard()
        while True:
            try:
                asked = Request(self._url, payload, self._headers, method="POST")
                with urlopen(asked, timeout=ANSWER) as answer:
                    self._hear(answer.read(), number)
                    return
            except HTTPError as error:
                if error.code not in (429, 503, 507):
                    said = error.read(500).decode(errors="replace")
                    raise InputError(
                        f"the service answers {error.code}: {said}", self._url, _remedy(error.code)
                    ) from None
                self._silence.tell(
                    f"the service at {self._place} takes nothing now ({error.code}); "
                    "it is tried again until it does"
                )
            # A service that is killed may leave an answer half said.
            except (URLError, OSError, HTTPException) as error:
                reason = getattr(error, "reason", error)
                self._silence.tell(
                    f"nobody answers at {self._place} ({reason}); it is tried again until "
                    "somebody does"
                )
            time.sleep(AGAIN)

    def finish(self) -> None:
        """Nothing is on its way."""

    def _hear(self, answer: bytes, number: Number | None) -> None:
        """Remember that a packet was refused, and tell it the first time."""
        if number is None or not (refused := json.loads(answer)["refused"]):
            return
        if not self.refused:
            self._told(f"the service keeps packet {number.sequence} aside: {refused[0]}")
        self.refused[number] = refused[0]


def _parts_of(url: str) -> SplitResult:
    """The parts of an address that names a host."""
    parts = urlsplit(url)
    try:
        is_one = bool(parts.hostname) and parts.port != 0
    except ValueError:
        is_one = False
    if not is_one:
        raise InputError(
            "the address names no host and port",
            url,
            "write http://host:8471/TWIN or mqtt://host:1883/rga/v1/TWIN/data/LOGGER",
        )
    return parts


def _remedy(code: int) -> str:
    """What mends an answer of a service."""
    if code in (401, 403):
        return "give in RGA_TOKEN a token of the role ingest for this twin: rga user CONFIG token"
    return "check the address" if code == 404 else "mend what it says"


class BrokerSender:
    """Sends through a broker, and again what the service does not acknowledge.

    A broker that was killed has forgotten messages that it had taken, and what is sent again behind
    later packets comes too late for its row. So after each break, and where nothing is acknowledged
    any more, the first packet is sent until the service has it, then all that come after it. What a
    service that is away or slow has not fetched waits in the broker all the same: all are sent
    again only where the service has fetched what was sent again before.

    Args:
        url: of the broker and the topic, mqtt://host:port/rga/v1/twin/data/logger.
        source: of the twin, of which the service says what it has.
        credentials: user and password; None: the broker asks for none.
        told: takes in words that nobody answers.

    Raises:
        InputError: the address names no host, or the topic no twin.
    """

    def __init__(
        self,
        url: str,
        source: str = "mqtt",
        credentials: tuple[str, str] | None = None,
        told: Callable[[str], None] = _nothing_told,
    ) -> None:
        self._parts, self._credentials = _parts_of(url), credentials
        self._topic = self._parts.path.strip("/")
        root, twin = self._topic.split("/")[:2], self._topic.split("/")[2:3]
        if root != ["rga", "v1"] or not twin or "+" in self._topic:
            raise InputError(
                "the topic names no twin", url, "write mqtt://host:1883/rga/v1/TWIN/data/LOGGER"
            )
        self._acknowledged = f"rga/v1/{twin[0]}/ack/{source}"
        self._away, self._unheard = _Silence(told), _Silence(told)
        self._awaited = f"the source {source!r} of twin {twin[0]!r}"
        self._open: OrderedDict[Number, bytes] = OrderedDict()
        # Sent for the first time since all was sent again, and whether that has been fetched.
        self._later: set[Number] = set()
        self._fetched = True
        self._lock, self._heard = Lock(), time.monotonic()
        self._refused: str | None = None
        self._client = self._new_client()

    def send(self, payload: bytes, number: Number | None) -> None:
        """Send a payload, and what was sent before and is not acknowledged.

        Raises:
            InputError: the broker refuses the connection.
        """
        self._stay_in_touch()
        if number is not None:
            with self._lock:
                if not self._open:
                    self._heard = time.monotonic()
                    self._unheard.heard()
                self._open[number] = payload
                self._later.add(number)
        self._client.publish(self._topic, payload, qos=1)
        while len(self._open) >= MOST_OPEN:
            time.sleep(AGAIN / 10)
            self._stay_in_touch()

    def finish(self) -> None:
        """Wait until everything is acknowledged.

        Raises:
            InputError: the broker refuses the connection.
        """
        while self._open:
            time.sleep(AGAIN / 10)
            self._stay_in_touch()
        self._client.disconnect()
        self._client.loop_stop()

    @property
    def _address(self) -> str:
        return self._parts._replace(path="").geturl()

    def _new_client(self) -> Client:
        client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5, reconnect_on_failure=False)
        if self._credentials is not None:
            client.username_pw_set(*self._credentials)
        if self._parts.scheme == "mqtts":
            client.tls_set_context(ssl.create_default_context())
        client.on_connect, client.on_message = self._connected, self._told
        return client

    def _stay_in_touch(self) -> None:
        """Connect anew, as often as it takes, if the connection has broken; send again."""
        if not self._client.is_connected():
            self._away.heard()
        while not self._client.is_connected():
            # What the client itself has not sent yet would come before what the broker has lost.
            self._client.loop_stop()
            self._client = self._new_client()
            if self._connects():
                self._unheard.heard()
                self._send_the_first()
                self._send_all()
            else:
                self._away.tell(
                    f"nobody answers at {self._address}; it is tried again until somebody does"
                )
                time.sleep(AGAIN / 10)
        if self._open and time.monotonic() - self._heard > UNACKNOWLEDGED:
            self._send_the_first()
            heard = self._heard
            time.sleep(AGAIN)
            if self._fetched and self._heard == heard:
                self._send_all()

    def _connects(self) -> bool:
        """Whether the broker takes a connection."""
        try:
            self._client.connect(*address_of(self._parts.geturl()))
        except OSError:
            return False
        self._client.loop_start()
        until = time.monotonic() + ANSWER
        while not self._client.is_connected() and time.monotonic() < until:
            if self._refused is not None:
                raise InputError(
                    f"the broker refuses the connection: {self._refused}",
                    self._address,
                    "check user and password",
                )
            time.sleep(AGAIN / 100)
        return self._client.is_connected()

    def _send_the_first(self) -> None:
        """Send the first that is not acknowledged until it is, at last more seldom."""
        with self._lock:
            first = next(iter(self._open.items()), None)
        count = 0
        while first is not None and first[0] in self._open and self._client.is_connected():
            self._client.publish(self._topic, first[1], qos=1)
            self._unheard.tell(
                f"the broker takes packets, and no service says that they are kept: "
                f"{self._awaited} is waited for"
            )
            count += 1
            until = time.monotonic() + AGAIN * max(1.0, count / OFTEN)
            while first[0] in self._open and time.monotonic() < until:
                time.sleep(AGAIN / 100)

    def _send_all(self) -> None:
        """Send what is not acknowledged once more, in order."""
        with self._lock:
            again = list(self._open.values())
            self._later.clear()
            self._fetched, self._heard = not again, time.monotonic()
        for payload in again:
            self._client.publish(self._topic, payload, qos=1)

    def _connected(self, client: Client, _: object, __: object, reason: Any, *___: object) -> None:
        self._refused = str(reason) if reason.is_failure else None
        client.subscribe(self._acknowledged, 1)

    def _told(self, _client: Client, _data: object, message: MQTTMessage) -> None:
        told = json.loads(message.payload)
        missing = [range(first, last + 1) for first, last in told["missing"]]
        with self._lock:
            for number in list(self._open):
                here = number.stream == told["stream"] and number.sequence < told["next"]
                if here and not any(number.sequence in one for one in missing):
                    del self._open[number]
                    # A broker hands out in order: what was sent before has been fetched.
                    self._fetched |= number in self._later
                    self._later.discard(number)
                    self._heard = time.monotonic()
                    self._unheard.heard()


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
