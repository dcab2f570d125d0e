"""A server of OPC UA: nothing is lost that it remembers, whoever was away."""

import asyncio
import socket
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

pytest.importorskip("asyncua", reason="asyncua is not installed")
from asyncua import Server, ua
from asyncua.server.history_sql import HistorySQLite
from asyncua.ua.uaerrors import UaError

from rga.errors import InputError
from rga.operation.packets.native import read_packet
from rga.operation.sources.opcua import OpcUaServer
from rga.operation.sources.settings import OpcUaSource
from rga.operation.sources.source import Outcome
from rga.operation.trial.listening import listened_to
from rga.records import RecordMapping

NODE = "ns=2;i=7"


class Plant:
    """A server with a variable whose values it remembers, in a thread of its own.

    Args:
        folder: of its history; None: it remembers nothing.
    """

    def __init__(self, folder: Path | None) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.url = f"opc.tcp://127.0.0.1:{free.getsockname()[1]}"
        self._folder = folder
        self._loop = asyncio.new_event_loop()
        Thread(target=self._loop.run_forever, daemon=True).start()
        self.count = 0

    def _do(self, work: Any) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(30)

    def start(self) -> None:
        self._do(self._start())

    async def _start(self) -> None:
        self._server = Server()
        self._server.set_endpoint(self.url)
        if self._folder is not None:
            history = HistorySQLite(str(self._folder / "history.sqlite"))
            await history.init()
            self._server.iserver.history_manager.set_storage(history)
        await self._server.init()
        await self._server.register_namespace("a test")
        self._node = await self._server.nodes.objects.add_variable(
            ua.NodeId.from_string(NODE), ua.QualifiedName("D1", 2), 0.0
        )
        await self._server.start()
        if self._folder is not None:
            await self._server.historize_node_data_change(self._node, period=None, count=0)

    def stop(self) -> None:
        self._do(self._server.stop())

    def end(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)

    def write(self, count: int = 1) -> None:
        """Set the variable to the numbers that follow."""
        for _ in range(count):
            self.count += 1
            value = ua.DataValue(
                ua.Variant(float(self.count), ua.VariantType.Double),
                SourceTimestamp=datetime.now(UTC),
            )
            self._do(self._server.write_attribute_value(self._node.nodeid, value))


class Kept:
    """Values that a twin has kept, and how far they were read."""

    def __init__(self) -> None:
        self.values: list[int] = []
        self.known: dict[str, Any] = {}
        self.full = False

    def receive(self, payloads: Any, cursor: Any = None) -> list[Outcome]:
        if self.full:
            raise InputError("the disk is full", "a test", "make room")
        for place, payload in payloads:
            packet = read_packet(payload, place)
            assert packet.channels == ("D1",)
            self.values += [int(one) for one in packet.values[:, 0] if one]
        self.known |= cursor or {}
        return []

    def receive_lines(self, where: str, head: bytes, lines: bytes, cursor: Any) -> list[Outcome]:
        raise AssertionError("no lines of files come here")

    def cursor(self) -> dict[str, Any]:
        return dict(self.known)

    def numbers(self) -> dict[str, Any]:
        return {}


def waited_for(what: Callable[[], Any], longest: float = 30.0) -> None:
    until = time.monotonic() + longest
    while not what():
        assert time.monotonic() < until, "it does not come"
        time.sleep(0.05)


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Plant]:
    made = Plant(tmp_path_factory.mktemp("plant"))
    made.start()
    yield made
    made.stop()
    made.end()


@pytest.fixture
def opened(
    plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[[Kept], OpcUaServer]]:
    """Sources that look at the plant."""
    monkeypatch.setattr("rga.operation.sources.opcua.HISTORY_LAG", 1.0)
    sources = []

    def source(kept: Kept) -> OpcUaServer:
        settings = OpcUaSource(kind="opcua", url=plant.url, nodes={"D1": NODE}, poll="100 ms")
        sources.append(OpcUaServer("a test", settings, kept))
        sources[-1].start()
        return sources[-1]

    yield source
    for one in sources:
        one.stop()


def test_what_changes_and_what_the_server_remembers_comes_once(
    plant: Plant, opened: Callable[[Kept], OpcUaServer]
) -> None:
    kept = Kept()
    plant.write(3)
    source = opened(kept)
    waited_for(lambda: source.fault is None)
    plant.write(2)
    waited_for(lambda: len(set(kept.values)) >= 5)
    kept.full = True
    plant.write(3)
    waited_for(lambda: "the disk is full" in str(source.fault))
    kept.full = False
    waited_for(lambda: len(set(kept.values)) >= 8)
    source.stop()
    # The service is away.
    plant.write(4)
    opened(kept)
    waited_for(lambda: set(kept.values) == set(range(1, 13)))


def test_nothing_is_lost_when_the_server_goes_away_and_returns(
    plant: Plant, opened: Callable[[Kept], OpcUaServer]
) -> None:
    kept = Kept()
    source = opened(kept)
    waited_for(lambda: source.fault is None)
    plant.write(3)
    waited_for(lambda: plant.count in kept.values)
    plant.stop()
    waited_for(lambda: source.fault is not None)
    assert "the server is away" in str(source.fault)
    plant.start()
    # Before the source is back, which waits for a second at least.
    plant.write(5)
    waited_for(lambda: source.fault is None)
    plant.write(2)
    waited_for(lambda: set(kept.values) == set(range(1, plant.count + 1)))


def test_a_server_that_remembers_nothing_is_followed(
    plant: Plant, opened: Callable[[Kept], OpcUaServer], monkeypatch: pytest.MonkeyPatch
) -> None:
    async def refuse(*_: Any) -> None:
        raise UaError("it remembers nothing")

    monkeypatch.setattr("asyncua.common.node.Node.read_raw_history", refuse)
    kept = Kept()
    source = opened(kept)
    waited_for(lambda: source.fault is None)
    plant.write(2)
    waited_for(lambda: len(kept.values) >= 3)
    assert kept.values == [plant.count - 2, plant.count - 1, plant.count]


def test_a_server_without_subscriptions_is_polled(
    plant: Plant, opened: Callable[[Kept], OpcUaServer], monkeypatch: pytest.MonkeyPatch
) -> None:
    async def refuse(*_: Any) -> None:
        raise UaError("it subscribes nothing")

    monkeypatch.setattr("asyncua.client.client.Client.create_subscription", refuse)
    kept = Kept()
    source = opened(kept)
    waited_for(lambda: source.fault is None)
    plant.write(1)
    waited_for(lambda: plant.count in kept.values)


def test_a_source_that_never_connects_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = OpcUaSource(kind="opcua", url="opc.tcp://127.0.0.1:1", nodes={"D1": NODE})
    source = OpcUaServer("a test", settings, Kept())
    assert source.fault == "not connected yet"
    source.start()
    waited_for(lambda: "the server is away" in str(source.fault))
    source.stop()


def test_a_check_hears_a_server(plant: Plant) -> None:
    plant.write(1)
    settings = OpcUaSource(kind="opcua", url=plant.url, nodes={"D1": NODE})
    heard = listened_to([("east", (), settings, RecordMapping())], 3.0)[0]
    assert heard.fault is None
    values = [value for _, one in heard.inlet.payloads for value in read_packet(one, "").values]
    assert plant.count in values
