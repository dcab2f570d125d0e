"""A service for tests: the files of its folder, and the process that serves them."""

import json
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import numpy as np

from live_streams import SETTINGS
from rga.operation.feeding.sent_record import SentRecord
from rga.operation.packets.packet import MICROSECONDS
from rga.records import Record

#: 2026-11-23T00:00:00Z
MIDNIGHT = 1_795_392_000_000_000
#: of one twin whose readings come by HTTP, faster than they were measured
HTTP = 'kind = "http"\nclock = { check = false }'
CONFIGURATION = """
[service]
listen = "127.0.0.1:{port}"
[[twin]]
name = "{name}"
model = "model.json"
settings = "settings.json"
rows = {{ every = "10 min", lateness = "30 min" }}
[[twin.source]]
{source}
"""


def write_service(
    folder: Path, model: dict[str, Any], *, name: str = "east", source: str = HTTP
) -> str:
    """Write the files of a service of one twin; gives its address.

    Args:
        folder: that they are written to.
        model: content of the model file.
        name: of the twin.
        source: lines of its one source.
    """
    port = free_port()
    text = CONFIGURATION.format(port=port, name=name, source=source)
    (folder / "serve.toml").write_text(text, "utf-8")
    (folder / "model.json").write_text(json.dumps(model), "utf-8")
    (folder / "settings.json").write_text(SETTINGS.model_dump_json(), "utf-8")
    return f"http://127.0.0.1:{port}"


def free_port() -> int:
    """A port on which nothing listens."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


def sent_of(record: Record) -> SentRecord:
    """A record as a logger has it that began at midnight."""
    return SentRecord(
        (*record.sensors, *record.contexts),
        MIDNIGHT + np.rint(record.time * MICROSECONDS).astype(np.int64),
        np.column_stack([record.readings, *record.contexts.values()]),
        "s",
    )


class ServiceProcess:
    """`rga serve` in a process of its own, which can be killed and started again.

    Args:
        folder: of the service.
        address: of it.
    """

    def __init__(self, folder: Path, address: str) -> None:
        self.folder, self.address = folder, address
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "ServiceProcess":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def start(self) -> None:
        """Start it, and wait until it answers."""
        with (self.folder / "service.log").open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "rga", "serve", "serve.toml"],
                cwd=self.folder,
                stdout=log,
                stderr=log,
            )
        while self._process.poll() is None:
            try:
                self.get("/healthz")
                return
            except OSError:
                time.sleep(0.05)
        said = (self.folder / "service.log").read_text("utf-8", "replace")
        raise AssertionError(f"the service ended: {said}")

    def get(self, path: str) -> Any:
        """What it answers."""
        with urlopen(f"{self.address}{path}", timeout=30) as answer:
            return json.load(answer)

    def kill(self) -> None:
        """End it at once, as when power is lost."""
        self._end(signal.SIGKILL)

    def stop(self) -> None:
        """End it as a system does."""
        self._end(signal.SIGTERM)

    def _end(self, by: signal.Signals) -> None:
        if self._process is not None:
            self._process.send_signal(by)
            self._process.wait()


def waited_for(what: Callable[[], Any], longest: float = 120.0) -> Any:
    """What there is as soon as it is there."""
    until = time.monotonic() + longest
    while not (found := what()):
        assert time.monotonic() < until, "it does not come"
        time.sleep(0.02)
    return found
