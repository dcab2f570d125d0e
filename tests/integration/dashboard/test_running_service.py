"""`rga serve` as a process: killed between decisions, and asked by commands."""

import json
import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest

from rga.dashboard.access import tables
from rga.dashboard.access.tokens import Tokens
from rga.dashboard.access.users import Users
from rga.operation.service_file import service_file

EAST = "/api/v1/twins/east"
#: how long anything is waited for [s]
PATIENCE = 120.0
PASSWORD = "four words of mine"


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

    def outcome(self, number: int) -> Any:
        path = f"{EAST}/commands/{number}"
        until(lambda: self.get(path)["state"] != "waiting")
        return self.get(path)


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.1)


@pytest.fixture
def running(folder: Path) -> Iterator[Running]:
    found = Running(folder)
    yield found
    if found.process.poll() is None:
        found.kill()


def test_decisions_at_once_and_a_kill_in_between(running: Running, rga: Callable[..., Any]) -> None:
    draw = random.Random(3)
    with ThreadPoolExecutor(2) as pool:
        numbers = list(pool.map(running.ask, [{"kind": "accept"}] * 2))
    time.sleep(draw.uniform(0.0, 1.0))
    running.kill()
    running.start()
    states = [running.outcome(number) for number in numbers]
    assert sorted(one["state"] for one in states) == ["done", "refused"]
    state = running.get(EAST)["now"]
    versions = running.get(f"{EAST}/versions")
    assert state["version"] == 2
    assert [one["number"] for one in versions if one["in_force"]] == [2]
    assert state["undecided"] is None
    told = [one["words"] for one in running.get(f"{EAST}/events") if one["kind"] == "command"]
    assert len(told) == 2
    assert "is accepted" in told[0]
    assert "refused" in told[1]
    # Commands of this machine ask it too.
    place = f"{running.url}/east"
    done = rga("rollback", place, "--to", "1", "--why", "to compare")
    assert (done.code, done.err) == (0, "")
    assert "Version 1 is in force again" in done.out
    assert "Model version 1 is in force" in rga("status", place).out
    assert "to compare" in rga("replay", place).out
    found = rga("whatif", place, "--set", "temperature=30")
    assert found.code == 0
    assert "D1" in found.out
    for wrong in (f"{running.url}/north", running.url, "http://127.0.0.1:9/east"):
        refused = rga("status", wrong)
        assert refused.code == 2
        assert refused.err.startswith("error: ")
    check_a_stream_ends_with(running)


def check_a_stream_ends_with(running: Running) -> None:
    """A stream tells what has happened, and ends when the service does."""
    asked = Request(f"{running.url}{EAST}/stream", headers={"Last-Event-ID": "1.0"})
    with urlopen(asked, timeout=PATIENCE) as stream:
        lines = []
        while not lines or not lines[-1].startswith("id: "):
            lines.append(stream.readline().decode())
        assert "event: event\n" in lines
        assert stream.headers["Content-Type"].startswith("text/event-stream")
        running.process.send_signal(signal.SIGTERM)
        stream.read()
    assert running.process.wait(PATIENCE) in (0, -signal.SIGTERM, 128 + signal.SIGTERM)


def test_users_tokens_and_secrets(
    folder: Path, rga: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with service_file(folder / "data", tables.metadata) as file:
        Users(file).add("Ada", "operator", PASSWORD)
        tokens = {
            (twin, purpose): Tokens(file).make(f"{twin} {purpose}", purpose, twin)
            for twin in ("east", "west")
            for purpose in ("read", "operate")
        }
    running = Running(folder)
    try:
        with pytest.raises(HTTPError, match="401"):
            running.get(EAST)
        assert running.get(EAST, tokens["east", "read"])["name"] == "east"
        for token in (tokens["west", "read"], tokens["west", "operate"]):
            with pytest.raises(HTTPError, match="403"):
                running.get(EAST, token)
        with pytest.raises(HTTPError, match="403"):
            running.ask({"kind": "note"}, tokens["east", "read"])
        assert running.ask({"kind": "note"}, tokens["east", "operate"]) > 0
        assert [one["name"] for one in running.get("/api/v1/twins", tokens["west", "read"])] == [
            "west"
        ]
        place = f"{running.url}/east"
        assert "RGA_TOKEN" in rga("status", place).err
        monkeypatch.setenv("RGA_TOKEN", tokens["east", "read"])
        assert rga("status", place).code == 0
        form = f"name={PASSWORD}&password={PASSWORD}".replace(" ", "+").encode()
        with pytest.raises(HTTPError, match="401"):
            urlopen(Request(f"{running.url}/login", form, {"Origin": running.url}))
    finally:
        running.kill()
    assert PASSWORD not in (folder / "said.txt").read_text("utf-8")
    assert PASSWORD.encode() not in (folder / "data" / "service.sqlite").read_bytes()
