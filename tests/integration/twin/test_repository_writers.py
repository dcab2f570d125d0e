"""Who writes a repository: one at a time, and what is acknowledged survives a kill."""

import json
import os
import random
import signal
import sqlite3
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from rga.errors import InputError
from rga.twin.repository import Identity, Repository

IDENTITY = Identity("a" * 64, "b" * 64, 3, json.dumps({"level": "C"}))
KILLS = 25


def test_one_writer_at_a_time(place: str) -> None:
    Repository.open(place).close()
    holder = subprocess.Popen(
        [sys.executable, __file__, "hold", place], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    with holder, Repository.open(place) as second:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        # A server does not say who else is there.
        who = "another process" if "://" in place else f"process {holder.pid} of"
        with pytest.raises(InputError, match=f"{who}.* writes"):
            second.run(IDENTITY)
        assert len(second.runs()) == 1
        holder.kill()
        holder.wait()
        assert second.run(IDENTITY).steps == 0


def test_what_is_acknowledged_survives_a_kill(place: str) -> None:
    generator = random.Random(1)
    helper = subprocess.Popen(
        [sys.executable, __file__, "kill", place],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    steps = 0
    with helper:
        assert helper.stdin is not None
        assert helper.stdout is not None
        for kill in range(KILLS):
            # Every other time while the repository is being opened, perhaps for the first time.
            acknowledged = "opening" if kill % 2 == 0 else "writing"
            print(acknowledged, generator.uniform(0, 0.06), file=helper.stdin, flush=True)
            steps = check_whole(place, max(steps, int(helper.stdout.readline())))
        helper.stdin.close()
    assert steps >= KILLS // 2


def check_whole(place: str, acknowledged: int) -> int:
    """The number of steps that are there, each of them whole."""
    if acknowledged:
        with Repository.open(place, read_only=True) as repository:
            assert repository.runs()[0].steps >= acknowledged
    if "://" not in place:
        with sqlite3.connect(place) as connection:
            assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
            assert connection.execute("PRAGMA foreign_key_check").fetchall() == []
        connection.close()
    with Repository.open(place) as repository:
        run = repository.run(IDENTITY)
        steps = run.steps
        assert acknowledged <= steps <= acknowledged + 1
        if steps:
            measured, simulated = run.measured(), run.simulated()
            assert_array_equal(measured.rows, np.arange(3 * steps))
            assert_array_equal(measured.readings[:, 83], np.repeat(np.arange(1, steps + 1), 3))
            assert_array_equal(simulated.contexts[:, 1], np.repeat(np.arange(1, steps + 1), 2))
            assert_array_equal(run.gaps().rows, np.arange(3 * steps))
            assert [message.body["step"] for message in run.messages()] == [*range(1, steps + 1)]
            assert run.kept("state") == b"%d" % steps
            assert run.row == 3 * steps - 1
        return steps


def hold(place: str) -> None:
    """Be the writer until the end."""
    Repository.open(place).run(IDENTITY)
    print("held", flush=True)  # noqa: T201
    sys.stdin.read()


def write_steps(place: str, acknowledged: int) -> None:
    """Write steps, and the number of each into a pipe once it is acknowledged."""
    run = Repository.open(place).run(IDENTITY)
    while True:
        with run.step() as step:
            n, first = step.number, 3 * (step.number - 1)
            step.message(kind="Q5", row=first, body={"step": n})
            step.measured(first, np.arange(first, first + 3), np.full((3, 84), n), np.zeros((3, 1)))
            step.simulated(1, "novel", first, np.full((2, 3), n), np.zeros((2, 84)))
            step.gaps(first, np.zeros((3, 84)), np.zeros((3, 84)), version=1)
            step.keep("state", b"%d" % n, first)
        os.write(acknowledged, b"%d\n" % n)


def kill_writers(place: str) -> None:
    """For each line "opening | writing, delay": kill a writer, and print its last step."""
    import time

    for line in sys.stdin:
        when, delay = line.split()
        receiving, sending = os.pipe()
        writer = os.fork()
        if not writer:
            write_steps(place, sending)
        os.close(sending)
        with os.fdopen(receiving) as pipe:
            first = pipe.readline() if when == "writing" else ""
            time.sleep(float(delay))
            os.kill(writer, signal.SIGKILL)
            os.waitpid(writer, 0)
            steps = [first, *pipe]
        print(max((int(step) for step in steps if step), default=0), flush=True)  # noqa: T201


if __name__ == "__main__":
    {"hold": hold, "kill": kill_writers}[sys.argv[1]](sys.argv[2])
