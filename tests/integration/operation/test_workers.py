"""Processes that play twins: each that ends is followed by another, which loses nothing."""

import json
import multiprocessing
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import rga
from live_streams import SETTINGS, assert_same, history, sinking
from rga.jobs.worker import MOST_FAILURES
from rga.model import read_model
from rga.operation.workers import Workers
from rga.records import Record
from served.made_service import waited_for

ROWS = 100


@pytest.fixture
def begun(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> Callable[[str], Path]:
    """Makes twins that wait to be played, all of the same rows."""
    model_file = tmp_path / "model.json"
    model_file.write_text(json.dumps(measured_bridge), "utf-8")
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)

    def make(name: str) -> Path:
        with rga.live(model_file, tmp_path / name, settings=SETTINGS, name="east") as twin:
            twin.feed(record)
        return tmp_path / name

    return make


@pytest.fixture
def playing() -> Iterator[Callable[[list[Path]], Workers]]:
    """Workers that play, until the test ends."""
    begun: list[Workers] = []

    def play(places: list[Path]) -> Workers:
        begun.append(Workers(places, None))
        begun[-1].start()
        return begun[-1]

    yield play
    for one in begun:
        one.stop()


def is_played(place: Path) -> bool:
    with rga.LiveTwin(place) as twin:
        return twin.waiting == (0, 0) and twin.twin.status().stage == "watch"


def kill(kind: str) -> None:
    for process in multiprocessing.active_children():
        if process.name == kind:
            process.kill()


def test_workers_that_are_killed_are_followed_by_others(
    begun: Callable[[str], Path], playing: Callable[[list[Path]], Workers]
) -> None:
    alone, place = begun("alone"), begun("place")
    with rga.LiveTwin(alone) as twin:
        twin.play()
        expected = history(twin)
    workers = playing([place])
    # Short of as often as a twin is left alone for.
    for kind in ("watch", "heavy", "watch")[: MOST_FAILURES - 1]:
        waited_for(lambda: workers.at)
        kill(kind)
    waited_for(lambda: is_played(place))
    assert workers.failed == {}
    with rga.LiveTwin(place) as twin:
        assert_same(history(twin), expected)


@pytest.mark.thorough
def test_a_twin_at_which_workers_end_is_left_alone(
    begun: Callable[[str], Path], playing: Callable[[list[Path]], Workers]
) -> None:
    bad, good = begun("bad"), begun("good")
    workers = playing([bad, good])
    while bad not in workers.failed:
        at = waited_for(lambda: workers.at or workers.failed)
        for kind, place in at.items():
            if place == bad:
                kill(str(kind))
        time.sleep(0.05)
    assert "ended 3 times" in workers.failed[bad]
    waited_for(lambda: is_played(good))
    assert good not in workers.failed
