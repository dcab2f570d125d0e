"""A broker that can be killed: mosquitto, where it is installed."""

import shutil
import socket
import subprocess
import time
from contextlib import suppress
from pathlib import Path

from rga.errors import InputError

#: of the broker; None: it is not installed
PROGRAM = shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin")


class Mosquitto:
    """A broker on a port of this machine that can be killed and started again.

    Args:
        folder: for its configuration and its store.
        lines: of the configuration.
    """

    def __init__(self, folder: Path, lines: str = "") -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self._configuration = folder / "mosquitto.conf"
        self._configuration.write_text(
            f"listener {self.port} 127.0.0.1\nallow_anonymous true\n{lines}\n", "utf-8"
        )
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """Address of the broker."""
        return f"mqtt://127.0.0.1:{self.port}"

    def start(self) -> None:
        """Start it, and wait until it answers.

        Raises:
            InputError: it is not installed, or does not answer.
        """
        if PROGRAM is None:
            raise InputError("mosquitto is not installed", "broker", "install it, as by apt-get")
        self._process = subprocess.Popen(
            [PROGRAM, "-c", str(self._configuration)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        until = time.monotonic() + 20
        while time.monotonic() < until:
            with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1):
                return
            time.sleep(0.05)
        raise InputError("mosquitto does not answer", self.url, "try again on an idle machine")

    def kill(self) -> None:
        """End it at once, as when power is lost."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
