"""`rga serve` as a process, asked by its API and killed."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

EAST = "/api/v1/twins/east"
#: how long anything is waited for [s]
PATIENCE = 120.0


class Running:
    """A service that runs, and can be killed and started again."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = int(free.getsockname()[1])
        self.folder, self.url = folder, f"http://127.0.0.1:{self.port}"
        path = folder / "serve.toml"
        listen = f'[service]\nlisten = "127.0.0.1:{self.port}"\n'
        path.write_text(path.read_text("utf-8").replace("[service]\n", listen), "utf-8")
        self.start()

    def start(self) -> None:
        """Start, and wait until it answers."""
        with (self.folder / "said.txt").open("a", encoding="utf-8") as said:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "rga", "serve", "serve.toml"],
                cwd=self.folder, stdout=said, stderr=said, start_new_session=True,
            )  # fmt: skip
        until(lambda: self.get("/healthz", none_if_away=True) is not None)

    def kill(self) -> None:
        """Kill it, and the workers that it has begun."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()

    def get(self, path: str, token: str | None = None, none_if_away: bool = False) -> Any:
        headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        try:
            with urlopen(Request(self.url + path, headers=headers), timeout=PATIENCE) as answer:
                return json.load(answer)
        except HTTPError:
            raise
        except OSError:
            if none_if_away:
                return None
            raise

    def ask(self, command: dict[str, Any], token: str | None = None) -> int:
        headers = {"Content-Type": "application/json"}
        if token is not None:
            headers["Authorization"] = f"Bearer {token}"
        body = json.dumps(command).encode()
        asked = Request(f"{self.url}{EAST}/commands", body, headers, method="POST")
        with urlopen(asked, timeout=PATIENCE) as answer:
            return int(json.load(answer)["number"])

    def outcome(self, number: int, token: str | None = None) -> Any:
        path = f"{EAST}/commands/{number}"
        until(lambda: self.get(path, token)["state"] != "waiting")
        return self.get(path, token)


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.1)
