"""Two operators decide at once, and the service is killed in between: never half is done."""

import os
import random
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from rga.dashboard.access import tables
from rga.dashboard.access.tokens import Tokens
from rga.dashboard.access.users import Users
from rga.operation.service_file import service_file
from rga.twin import Twin
from served.running_service import EAST, Running

#: `RGA_TEST_KILLS=200` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "1"))
#: within what time after both were asked for it is killed [s]
LATEST = 2.0
OPERATORS = ("Ada", "Eve")


@pytest.fixture
def tokens(folder: Path) -> list[str]:
    with service_file(folder / "data", tables.metadata) as file:
        Users(file).add("Admin", "admin", "four words of mine")
        return [Tokens(file).make(name, "operate", "east") for name in OPERATORS]


@pytest.fixture
def running(folder: Path, tokens: list[str]) -> Iterator[Running]:
    found = Running(folder)
    yield found
    if found.process.poll() is None:
        found.kill()


def standing(folder: Path) -> tuple[int, list[str]]:
    """The version in force, and what came of every decision, as the disk holds it."""
    with Twin.open(folder / "data" / "east") as twin:
        return twin.version, [one.outcome for one in twin.commands()]


def decided_at_once(
    running: Running,
    tokens: list[str],
    commands: list[dict[str, Any]],
    draw: random.Random,
    check: Callable[[int, list[str]], None],
) -> list[Any]:
    """What comes of what two ask for at once, where the service is killed a little later."""
    before = len(standing(running.folder)[1])
    with ThreadPoolExecutor(2) as pool:
        numbers = list(pool.map(running.ask, commands, tokens))
    time.sleep(draw.uniform(0.0, LATEST))
    running.kill()
    version, outcomes = standing(running.folder)
    check(version, outcomes[before:])
    running.start()
    found = [running.outcome(number, token) for number, token in zip(numbers, tokens, strict=True)]
    version, outcomes = standing(running.folder)
    check(version, outcomes[before:])
    assert len(outcomes) == before + 2
    # The log has both, with who asked.
    events = running.get(f"{EAST}/events", tokens[0])
    told = [one["words"] for one in events if one["kind"] == "command"][-2:]
    assert {name for name in OPERATORS if any(name in words for words in told)} == {*OPERATORS}
    assert running.get(EAST, tokens[0])["now"]["version"] == version
    return found


@pytest.mark.parametrize("second", ["rollback", pytest.param("reject", marks=pytest.mark.thorough)])
def test_a_proposal_is_decided_once(running: Running, tokens: list[str], second: str) -> None:
    commands = [{"kind": "accept"}, {"kind": second}]
    if second == "rollback":
        commands[1]["version"] = 1  # type: ignore[assignment]

    def check(version: int, outcomes: list[str]) -> None:
        assert version == (2 if any("is accepted" in one for one in outcomes) else 1)

    accepted, other = decided_at_once(running, tokens, commands, random.Random(second), check)
    states = (accepted["state"], other["state"])
    if second == "reject":
        assert sorted(states) == ["done", "refused"]
    else:
        # That version 1 stays is no decision against the proposal.
        assert states == ("done", "refused" if "meanwhile" in other["outcome"] else "done")


def test_of_two_that_roll_back_one_wins(running: Running, tokens: list[str]) -> None:
    draw = random.Random(5)
    running.outcome(running.ask({"kind": "accept"}, tokens[0]), tokens[0])
    seen = 2
    for _ in range(KILLS):
        to = 3 - seen
        commands = [{"kind": "rollback", "version": to, "version_seen": seen}] * 2

        def check(version: int, outcomes: list[str], seen: int = seen, to: int = to) -> None:
            done = [one for one in outcomes if "is in force again" in one]
            assert len(done) == (version == to)
            assert version in (seen, to)
            # Who comes second is told after the other was done.
            assert outcomes[:1] == done

        found = decided_at_once(running, tokens, commands, draw, check)
        assert sorted(one["state"] for one in found) == ["done", "refused"]
        (lost,) = [one["outcome"] for one in found if one["state"] == "refused"]
        assert f"version {to} has come into force meanwhile in place of {seen}" in lost
        seen = to
