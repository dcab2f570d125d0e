"""Whoever tells of alarms is killed at any time: every notice arrives, known by its id."""

import os
import random
import signal
import sqlite3
import time
from contextlib import closing
from multiprocessing import get_context
from multiprocessing.context import ForkServerProcess
from pathlib import Path

from rga.operation.service_file import FILE_NAME
from served import notices_to_kill
from served.notice_server import NoticeServer, notice_server

#: `RGA_TEST_KILLS=200` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "4"))
MOODS = ("takes", "fails", "takes and fails", "takes")


def test_every_notice_arrives_once_by_its_id(tmp_path: Path) -> None:
    draw = random.Random(3)
    with notice_server() as server:
        (tmp_path / "mail.secret").write_text(server.url, "utf-8")
        for _ in range(KILLS):
            told_until_it_is_killed(tmp_path, server, draw)
        server.mood = "takes"
        run(tmp_path, 40).join()
        with closing(sqlite3.connect(tmp_path / FILE_NAME)) as file:
            transitions = [one for (one,) in file.execute("SELECT number FROM transition")]
            told = file.execute("SELECT transition, message FROM notice").fetchall()
            fates = dict(file.execute("SELECT id, fate FROM message"))
    assert len(transitions) > 40
    # One notice a transition, each in one message, and each message has arrived.
    assert sorted(number for number, _ in told) == transitions
    messages = {message for _, message in told} - {None}
    assert set(fates) == messages
    assert {id for id, fate in fates.items() if fate == "delivered"} <= set(server.taken)
    # All but those of the last minute are told of.
    assert sum(message is None for _, message in told) <= 1
    assert [fate for fate in fates.values() if fate != "delivered"] == []


def told_until_it_is_killed(folder: Path, server: NoticeServer, draw: random.Random) -> None:
    """Run for a while, with a server that changes its mind."""
    process, before = run(folder, -1), len(server.sent)
    while process.is_alive() and len(server.sent) < before + 3:
        time.sleep(0.01)
    for _ in range(5):
        server.mood = draw.choice(MOODS)  # type: ignore[assignment]
        time.sleep(draw.uniform(0, 0.1))
    process.kill()
    process.join()
    assert process.exitcode == -signal.SIGKILL
    server.mood = "takes"


def run(folder: Path, rounds: int) -> ForkServerProcess:
    """A process that tells of alarms; what it needs is imported once for all of them."""
    context = get_context("forkserver")
    context.set_forkserver_preload(["served.notices_to_kill"])
    process = context.Process(target=notices_to_kill.main, args=(folder, rounds))
    process.start()
    return process
