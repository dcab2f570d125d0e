"""Variables of a server of OPC UA: what it remembers since they were last read, and what changes.

A subscription loses what happens while the connection is away, and servers differ in what they
send again. So after every connect the history is read from where it was read to, beside a
subscription that has begun before, and once more when it has caught up: nothing is lost that the
server remembers. What comes twice is of the same moment, and counts once.
"""

import asyncio
import time
from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from threading import Event, Thread
from typing import Any

from asyncua.client.client import Client
from asyncua.common.node import Node
from asyncua.ua.uaerrors import UaError

from rga.errors import InputError
from rga.operation.packets.packet import EPOCH
from rga.operation.packets.readings import SensorReading
from rga.operation.sources.secrets import credentials_of
from rga.operation.sources.settings import OpcUaSource
from rga.operation.sources.source import Inlet
from rga.operation.sources.written import payloads_of
from rga.records.record import LARGEST

#: how long to wait before connecting again, at first and at most [s]
FIRST_WAIT, LONGEST_WAIT = 1.0, 60.0
#: how long an answer is waited for [s]
ANSWER = 10.0
#: by which the history may lag behind the values that a server shows [s]
HISTORY_LAG = 30.0
_MICROSECOND = timedelta(microseconds=1)


class OpcUaServer:
    """Takes what variables of a server are.

    Args:
        name: of the thread.
        settings: of the source.
        inlet: keeps what comes.

    Raises:
        InputError: the credentials cannot be read.
    """

    def __init__(self, name: str, settings: OpcUaSource, inlet: Inlet) -> None:
        self._settings, self._inlet = settings, inlet
        self._credentials = (
            None if settings.credentials is None else credentials_of(settings.credentials)
        )
        self._kept: dict[str, int] = dict(inlet.cursor())
        self._channels: dict[Node, str] = {}
        self._changes: list[SensorReading] = []
        self._lost = False
        self._last: dict[str, SensorReading] = {}
        self._came: set[SensorReading] = set()
        self._ending = Event()
        self._thread = Thread(target=lambda: asyncio.run(self._work()), name=name, daemon=True)
        self.fault: str | None = "not connected yet"

    def start(self) -> None:
        """Connect, as often as it takes, and take values."""
        self._thread.start()

    def stop(self) -> None:
        """Take no more values."""
        self._ending.set()
        if self._thread.ident is not None:
            self._thread.join()

    def datachange_notification(self, node: Node, value: Any, data: Any) -> None:
        """Take a value in: the server says that it is another."""
        channel = self._channels.get(node)
        if channel is not None:
            self._changes += _points_of(channel, [data.monitored_item.Value])

    def status_change_notification(self, status: Any) -> None:
        """Connect anew: the server has ended the subscription."""
        self._lost = True

    async def _work(self) -> None:
        wait = FIRST_WAIT
        while not self._ending.is_set():
            try:
                await self._session()
                wait = FIRST_WAIT
            except Exception as error:  # A thread that ends would take nothing more, and say so.
                said = str(error) or type(error).__name__
                if self.fault is None:
                    wait = FIRST_WAIT
                self.fault = f"the server is away: {said}"
            await self._rest(wait)
            wait = min(2 * wait, LONGEST_WAIT)

    async def _session(self) -> None:
        """Take values until the end, or until the connection is lost."""
        client = Client(self._settings.url, timeout=ANSWER)
        if self._credentials is not None:
            client.set_user(self._credentials[0])
            client.set_password(self._credentials[1])
        async with client:
            addresses = self._settings.nodes
            self._channels = {client.get_node(one): name for name, one in addresses.items()}
            self._changes, self._lost = [], False
            self._came = set(self._last.values())
            subscribed = await self._subscribe(client)
            begins, since = self._begins(), time.monotonic()
            await self._keep(await self._history(begins))
            while not self._ending.is_set():
                await client.check_connection()
                if self._lost:
                    raise ConnectionError("it has ended the subscription")
                if not subscribed:
                    self._changes += await self._values()
                if begins and time.monotonic() - since > HISTORY_LAG:
                    self._changes += await self._history(begins)
                    begins = {}
                changes, self._changes = self._changes, []
                await self._keep(changes)
                if not begins:
                    self._came = set(self._last.values())
                self.fault = None
                await self._rest(self._settings.poll)

    async def _subscribe(self, client: Client) -> bool:
        """Be told of changes; False: the server does not tell them."""
        try:
            subscription = await client.create_subscription(1000 * self._settings.poll / 2, self)
            await subscription.subscribe_data_change(list(self._channels), queuesize=1000)
        except UaError:
            return False
        return True

    def _begins(self) -> dict[str, datetime]:
        """From where the history of each channel is read."""
        first = datetime.now(UTC) - timedelta(seconds=self._settings.clock.backlog)
        lag = timedelta(seconds=HISTORY_LAG)
        return {
            channel: EPOCH + self._kept[channel] * _MICROSECOND - lag
            if channel in self._kept
            else first
            for channel in self._settings.nodes
        }

    async def _history(self, begins: Mapping[str, datetime]) -> list[SensorReading]:
        """What the server remembers of each channel since a moment."""
        points: list[SensorReading] = []
        end = datetime.now(UTC) + timedelta(days=1)
        for node, channel in self._channels.items():
            try:
                found = await node.read_raw_history(begins[channel], end)
            except UaError:
                # It remembers nothing of this variable.
                continue
            points += _points_of(channel, found)
        return points

    async def _values(self) -> list[SensorReading]:
        points: list[SensorReading] = []
        for node, channel in self._channels.items():
            points += _points_of(channel, [await node.read_data_value(raise_on_bad_status=False)])
        return points

    async def _keep(self, points: list[SensorReading]) -> None:
        """Keep values that are new, with how far each variable was read."""
        new = [one for one in points if one not in self._came]
        if not new:
            return
        kept = {one.channel: self._kept.get(one.channel, one.moment) for one in new}
        for one in new:
            kept[one.channel] = max(kept[one.channel], one.moment)
        payloads = [(self._settings.url, one) for one in payloads_of(new, self._settings.url)]
        while True:
            try:
                await asyncio.to_thread(self._inlet.receive, payloads, kept)
                break
            except InputError as error:
                # Nothing can be written for now, and nothing is taken meanwhile.
                self.fault = str(error)
                if await self._rest(FIRST_WAIT):
                    return
        self._kept |= kept
        self._came.update(new)
        # A subscription begins with the value that is there.
        self._last |= {one.channel: one for one in new}

    async def _rest(self, seconds: float) -> bool:
        """Wait; whether this is the end."""
        return await asyncio.to_thread(self._ending.wait, seconds)


def _points_of(channel: str, values: Any) -> list[SensorReading]:
    """Values as readings, of those that are numbers and have a time."""
    points = []
    for one in values:
        stamp = one.SourceTimestamp
        value = one.Value.Value if one.Value is not None else None
        if stamp is None or isinstance(value, bool) or not isinstance(value, (int, float)):
            continue
        if one.StatusCode is not None and not one.StatusCode.is_good():
            continue
        if abs(value) <= LARGEST:
            moment = (stamp.replace(tzinfo=UTC) if stamp.tzinfo is None else stamp) - EPOCH
            points.append(SensorReading(channel, moment // _MICROSECOND, float(value)))
    return points
