"""A service in a process of its own, which can be killed."""

import json
import signal
import socket
import subprocess
import sys
import time
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from rga.errors import InputError
from rga_bench.operation.process_usage import Usage, usage_of

#: how long an answer is waited for [s]
ANSWER = 30.0


class ServiceProcess:
    """`rga serve` in a process of its own, which can be killed and started again.

    Args:
        folder: of the service, with its `serve.toml`.
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
        """Start it, and wait until it answers.

        Raises:
            InputError: it ends instead.
        """
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
            except (OSError, HTTPException):
                time.sleep(0.05)
        said = (self.folder / "service.log").read_text("utf-8", "replace")
        raise InputError(f"the service ended: {said[-500:]}", str(self.folder), "mend what it says")

    @property
    def usage(self) -> Usage:
        """What it and its workers take of the machine since it was started.

        Raises:
            InputError: it was not started, or the system does not tell.
        """
        if self._process is None:
            raise InputError("the service was not started", str(self.folder), "start it")
        return usage_of(self._process.pid)

    def get(self, path: str) -> Any:
        """What it answers."""
        with urlopen(f"{self.address}{path}", timeout=ANSWER) as answer:
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


def free_port() -> int:
    """A port on which nothing listens."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])
