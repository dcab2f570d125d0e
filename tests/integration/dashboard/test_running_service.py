"""`rga serve` as a process: killed between decisions, and asked by commands."""

import os
import random
import signal
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
from served.running_service import EAST, PATIENCE, Running

PASSWORD = "four words of mine"


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
    said, alarms = rga("status", place).out, running.get(f"{EAST}/alarms")
    assert "Model version 1 is in force" in said
    assert len(alarms) == 0 or f"{len(alarms)} alarm" in said
    assert ("No alarm is open." in said) == (len(alarms) == 0)
    assert "to compare" in rga("replay", place).out
    found = rga("whatif", place, "--set", "temperature=30")
    assert found.code == 0
    assert "D1" in found.out
    for wrong in (f"{running.url}/north", running.url, "http://127.0.0.1:9/east"):
        refused = rga("status", wrong)
        assert refused.code == 2
        assert refused.err.startswith("error: ")
    check_a_stream_ends_with(running)


@pytest.mark.parametrize("after", [0.0, 3.0])
def test_a_terminal_that_interrupts_all_of_it_ends_it_in_a_word(
    running: Running, after: float
) -> None:
    time.sleep(after)
    os.killpg(running.process.pid, signal.SIGINT)
    assert running.process.wait(PATIENCE) == 128 + signal.SIGINT
    said = (running.folder / "said.txt").read_text("utf-8")
    assert "Traceback" not in said
    assert "interrupted" in said


def test_a_client_that_leaves_a_stream_is_no_error(running: Running) -> None:
    asked = Request(f"{running.url}{EAST}/stream", headers={"Last-Event-ID": "0.0"})
    for read in range(12):
        with urlopen(asked, timeout=PATIENCE) as stream:
            for _ in range(read % 4):
                stream.readline()
    time.sleep(1.0)
    assert running.get("/healthz") == {"state": "up"}
    assert "Traceback" not in (running.folder / "said.txt").read_text("utf-8")


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
        assert running.ask({"kind": "note", "why": "greased"}, tokens["east", "operate"]) > 0
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
