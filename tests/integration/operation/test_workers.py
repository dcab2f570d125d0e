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
from rga.model import read_model
from rga.operation.workers import MOST_ENDS, Workers
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
def room(tmp_path: Path) -> Path:
    """A file that is there as long as workers are to find room on the disk."""
    found = tmp_path / "room"
    found.touch()
    return found


@pytest.fixture
def playing(room: Path) -> Iterator[Callable[[list[Path]], Workers]]:
    """Workers that play, until the test ends."""
    begun: list[Workers] = []

    def play(places: list[Path]) -> Workers:
        begun.append(Workers(places, None, room.exists))
        begun[-1].start()
        return begun[-1]

    yield play
    for one in begun:
        one.stop()


def is_played(place: Path) -> bool:
    with rga.LiveTwin(place) as twin:
        return twin.waiting == (0, 0) and twin.twin.status().stage == "watch"


def stage_of(place: Path) -> str:
    with rga.LiveTwin(place) as twin:
        return twin.twin.status().stage


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
    for kind in ("watch", "heavy", "watch")[: MOST_ENDS - 1]:
        waited_for(lambda: workers.at)
        kill(kind)
    waited_for(lambda: is_played(place))
    assert workers.failed == {}
    with rga.LiveTwin(place) as twin:
        assert_same(history(twin), expected)


def test_long_steps_wait_for_room_and_go_on_by_themselves(
    begun: Callable[[str], Path], playing: Callable[[list[Path]], Workers], room: Path
) -> None:
    place, alone = begun("place"), begun("alone")
    with rga.LiveTwin(place) as twin:
        twin.play(lambda running: running.stage == "initialise")
    room.unlink()
    workers = playing([place])
    # Short steps go on up to the first long one.
    waited_for(lambda: stage_of(place) == "calibrate")
    waited_for(lambda: workers.at.get("heavy") == place)
    waited_for(lambda: "heavy" not in workers.at)
    assert stage_of(place) == "calibrate"
    assert workers.failed == {}
    room.touch()
    waited_for(lambda: is_played(place))
    with rga.LiveTwin(place) as twin, rga.LiveTwin(alone) as other:
        other.play()
        assert_same(history(twin), history(other))


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
