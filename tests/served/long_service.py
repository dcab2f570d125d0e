"""A service on one core behind a broker that is fed for long, and what it takes."""

import json
import logging
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl

from rga.operation.feeding.senders import BrokerSender
from rga.operation.packets.packet import Number
from rga.twin.versions import written
from rga_bench.endless.stream import Stream
from rga_bench.operation.broker import Mosquitto
from rga_bench.operation.one_core import one_core
from rga_bench.operation.process_usage import Usage, stored
from rga_bench.operation.service_folder import TOPIC, by_broker, write_service
from rga_bench.operation.service_process import ServiceProcess

#: how long what waits may take to be played, and how often it is looked [s]: looking costs too
LONGEST, LOOK = 900.0, 0.5
EAST = "/api/v1/twins/east"


@dataclass(frozen=True)
class Mark:
    """What a service took since it was started, and stored, until so many rows were played."""

    rows: int
    usage: Usage
    stored: int

    def cost_since(self, before: "Mark") -> float:
        """Time of the processor for a row [s]."""
        return (self.usage.processor - before.usage.processor) / (self.rows - before.rows)


class LongService:
    """A service of one twin; it is to be stopped.

    Args:
        folder: of its files.
        broker: that it is behind.
        stream: of the model and the settings of its twin.
        every: length of a row [s].
        late: rows by which samples may come after others of later times.
    """

    def __init__(
        self, folder: Path, broker: Mosquitto, stream: Stream, every: int, late: int
    ) -> None:
        model: dict[str, Any] = json.loads(written(stream.model)[0])
        source = by_broker(broker.url)
        address = write_service(
            folder, model, stream.settings, source=source, every=every, lateness=late * every
        )
        self._data, self._process = folder / "data", ServiceProcess(folder, address)
        self._sender, self._packet = BrokerSender(f"{broker.url}/{TOPIC}"), stream.settings.packet
        self._late, self.sent = late, 0
        self.start()

    def start(self) -> None:
        """Start it."""
        with one_core():
            self._process.start()

    def kill(self) -> None:
        """End it at once."""
        self._process.kill()

    def stop(self) -> None:
        """End it."""
        self._process.stop()

    def send(self, payload: bytes) -> None:
        """Send the packet of the next row."""
        self._sender.send(payload, Number("s", self.sent))
        self.sent += 1

    @property
    def now(self) -> dict[str, Any]:
        """Where the twin stands."""
        return self._process.get(EAST)["now"] or {"rows": 0}

    def mark(self) -> Mark:
        """What it took until now."""
        mark = Mark(self.now["rows"], self._process.usage, stored(self._data))
        logging.getLogger(__name__).info("%s", mark)
        return mark

    def played(self) -> Mark:
        """What it took until all was played that was sent."""
        # The last rows wait for what may be late, and the twin for the others of its packet.
        due = (self.sent - 1 - self._late) // self._packet * self._packet
        until = time.monotonic() + LONGEST
        while self.now["rows"] < due:
            assert time.monotonic() < until, "it does not come"
            time.sleep(LOOK)
        return self.mark()

    def end(self, export: Callable[..., Any]) -> pl.DataFrame:
        """Wait until all is acknowledged and accounted for; gives the rows that were made of it.

        Args:
            export: runs the command line.
        """
        self._sender.finish()
        account = self._process.get(f"{EAST}/account")["mqtt"]
        self.stop()
        assert account["difference"] == account["refused"] == account["late"] == 0
        assert account["used"] + account["waiting"] == self.sent
        assert account["streams"] == {"s": {"next": self.sent, "missing": []}}
        file = self._data / "record.parquet"
        assert export("export", self._data / "east", "-o", file).code == 0
        rows = pl.read_parquet(file)
        assert self.sent - 1 - self._late - self._packet < len(rows) <= account["used"]
        return rows
