"""Killed or terminated at any time, the same command ends in the same files."""

import hashlib
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

#: `RGA_TEST_KILLS=100` makes it as long as the acceptance wants it
KILLS = int(os.environ.get("RGA_TEST_KILLS", "3"))
#: how long Python takes until it is told what to do with a signal [s]
BEGINS = 0.5
#: how long a command may take to end [s]
ENDS = 10.0
COMMANDS = ("run", "dataset", "diagnose-many")


@pytest.fixture(scope="module")
def commands(small_stream: Callable[..., Path], bridges: Path) -> dict[str, list[str | Path]]:
    """Each as it is given in the folder that it writes to."""
    stream = small_stream(rows=120)
    model = stream / "model.json"
    settings = ("--settings", stream / "settings.json", "-o", "out")
    return {
        "run": ["run", model, stream / "record.csv", *settings],
        "dataset": ["dataset", model, "-n", "400000", "-o", "out.parquet", "--workers", "2"],
        "diagnose-many": ["diagnose-many", bridges, "-o", "out", "--workers", "2"],
    }


def begun(words: list[str | Path], folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "rga", *map(str, words)],
        cwd=folder,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def written(folder: Path) -> dict[str, str]:
    """Of every file but the database, whose pages depend on when it was written: its hash."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not path.name.startswith("twin.sqlite")
    }


@pytest.mark.thorough
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
@pytest.mark.parametrize("command", COMMANDS)
def test_the_same_files_however_often_it_was_stopped(
    command: str, number: signal.Signals, commands: dict[str, list[str | Path]], tmp_path: Path
) -> None:
    whole = tmp_path / "whole"
    whole.mkdir()
    since = time.monotonic()
    process = begun(commands[command], whole)
    process.communicate()
    longest = time.monotonic() - since
    expected = (process.returncode, written(whole))
    draw, stopped, rounds = random.Random(9), 0, 0
    while stopped < KILLS:
        folder = tmp_path / f"round {rounds}"
        folder.mkdir()
        rounds += 1
        while stop(process := begun(commands[command], folder), number, draw, longest):
            stopped += 1
            if stopped == KILLS:
                process = begun(commands[command], folder)
                process.communicate()
                break
        assert (process.returncode, written(folder)) == expected


def stop(
    process: subprocess.Popen[str], number: signal.Signals, draw: random.Random, longest: float
) -> bool:
    """Whether a command that is stopped at any time has been stopped before its end."""
    try:
        process.communicate(timeout=BEGINS + draw.uniform(0.0, longest))
    except subprocess.TimeoutExpired:
        # A terminal signals all processes; a service manager or a person the first alone.
        draw.choice([os.kill, os.killpg])(process.pid, number)
        _, said = process.communicate(timeout=ENDS)
        if process.returncode == -signal.SIGKILL:
            return True
        if process.returncode == 143:
            told = [line for line in said.splitlines() if not line.startswith("warning: ")]
            assert len(told) == 1, said
            assert told[0].startswith("terminated")
            return True
    return False
