"""Workers take leases on twins in turn; what one begins another goes on with."""

import shutil
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path

import pytest

import rga
from live_streams import SETTINGS, assert_same, history
from rga import LiveTwin, Worker
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin.repository import InUse

Given = tuple[Model, Record]


def fed(given: Given, place: Path) -> Path:
    with rga.live(given[0], place, settings=SETTINGS) as twin:
        twin.feed(given[1])
    return place


def test_a_worker_plays_all_twins(sound: Given, sinks: Given, tmp_path: Path) -> None:
    places = [fed(sound, tmp_path / "sound"), fed(sinks, tmp_path / "sinks")]
    happened = Worker(places).round()
    assert happened.keys() == set(places)
    assert any(event.kind == "alarm" for event in happened[places[1]])
    assert Worker(places).round() == {}
    with rga.live(sound[0], tmp_path / "alone", settings=SETTINGS) as alone:
        alone.feed(sound[1])
        alone.play()
        with LiveTwin(places[0]) as twin:
            assert_same(history(twin), history(alone))


def test_short_and_long_steps_are_left_to_workers_of_their_own(
    sound: Given, tmp_path: Path
) -> None:
    place = fed(sound, tmp_path / "sound")
    watch, heavy = Worker([place], kinds=["watch"]), Worker([place], kinds=["heavy"])
    assert watch.round() == {}, "a run begins with a long step"
    assert heavy.round() == {}
    assert watch.round() == {}, "rows are gathered up to the calibration"
    (calibration, *_) = heavy.round()[place]
    assert calibration.kind == "calibration"
    watch.round()
    with LiveTwin(place) as twin:
        assert twin.twin.status().rows == len(sound[1])


def test_a_twin_of_which_nothing_is_due_is_not_looked_at_for_a_while(
    sound: Given, tmp_path: Path
) -> None:
    place = fed(sound, tmp_path / "sound")
    # The inbox is open as in a service, or the last to close it would tidy up.
    with LiveTwin(place):
        worker, looked = Worker([place]), list[Path | None]()
        while worker.round():
            pass
        worker.round(looked.append)
        assert looked == [None]


def test_a_twin_that_another_plays_is_left_to_it(sound: Given, tmp_path: Path) -> None:
    place = fed(sound, tmp_path / "sound")
    with LiveTwin(place) as twin:
        twin.play(lambda running: running.stage == "initialise")
        worker = Worker([place])
        assert worker.round() == {}
        assert worker.failed == {}
        with pytest.raises(InUse, match="writes there"):
            LiveTwin(place, patience=0.0).play()
    assert worker.round()[place][0].kind == "calibration"


def test_what_fails_stops_no_other_and_is_left_alone_after_a_while(
    sound: Given, tmp_path: Path
) -> None:
    broken, place = tmp_path / "broken", fed(sound, tmp_path / "sound")
    broken.mkdir()
    worker = Worker([broken, place])
    assert worker.round()[place][0].kind == "calibration"
    assert "no live twin" in worker.failed[broken]
    worker.round()
    worker.round()
    fed(sound, broken)
    assert worker.round() == {}, "it has failed three times"
    assert Worker([broken]).round()[broken][0].kind == "calibration"


def _rounds(places: list[Path]) -> None:
    worker = Worker(places)
    while True:
        worker.round()


def test_a_worker_that_is_killed_loses_its_leases(
    sound: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sound, 60)
    with LiveTwin(place) as twin:
        twin.feed(sound[1])
    process = get_context("forkserver").Process(target=_rounds, args=([place],))
    process.start()
    process.join(1.0)
    process.kill()
    process.join()
    Worker([place]).round()
    with LiveTwin(place) as twin:
        assert twin.twin.status().rows == len(sound[1])
    shutil.rmtree(place)


def test_twins_share_a_database(sound: Given, sinks: Given, tmp_path: Path, server: str) -> None:
    places = []
    for name, given in (("sound", sound), ("sinks", sinks)):
        place = tmp_path / name
        with rga.live(given[0], place, settings=SETTINGS, name=name, repository=server) as twin:
            twin.feed(given[1])
        places.append(place)
    happened = Worker(places, repository=server).round()
    assert any(event.kind == "alarm" for event in happened[places[1]])
    assert not (places[0] / "twin.sqlite").exists()
    for place, given in zip(places, (sound, sinks), strict=True):
        with rga.live(given[0], tmp_path / f"{place.name} alone", settings=SETTINGS) as alone:
            alone.feed(given[1])
            alone.play()
            with LiveTwin(place, repository=server) as twin:
                assert_same(history(twin), history(alone))
    with rga.Twin.open(server, "live:sound") as twin:
        assert twin.status().rows == len(sound[1])
    with pytest.raises(InputError, match="no 'live:other' has run here"):
        rga.Twin.open(server, "live:other")
