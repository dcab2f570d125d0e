"""Rows that several threads feed while another plays."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from itertools import chain
from pathlib import Path
from threading import Barrier

import numpy as np

import rga
from live_streams import SETTINGS, assert_same, history, pieces
from rga.model import Model
from rga.records import Record
from rga.twin import Note
from rga.twin.history import History

Given = tuple[Model, Record]
CUTS = range(5, 100, 5)


def at_once(given: Given, place: Path) -> History:
    with rga.live(given[0], place, settings=SETTINGS) as twin:
        twin.feed(given[1])
        twin.play()
        return history(twin)


def test_one_feeds_and_another_plays(sound: Given, tmp_path: Path) -> None:
    expected = at_once(sound, tmp_path / "once")
    with rga.live(sound[0], tmp_path, settings=SETTINGS) as twin, ThreadPoolExecutor(2) as pool:
        feeding = pool.submit(lambda: [twin.feed(one).new for one in pieces(sound[1], CUTS)])
        events = []
        while not feeding.done():
            events += pool.submit(twin.play).result()
        events += twin.play()
        assert feeding.result() == [5] * 20
        assert tuple(events) == expected.events
        assert_same(history(twin), expected)


def test_all_feed_the_same_at_once(sound: Given, tmp_path: Path) -> None:
    """Each row is new to one of them."""
    expected = at_once(sound, tmp_path / "once")
    meet = Barrier(3)
    with rga.live(sound[0], tmp_path, settings=SETTINGS) as twin, ThreadPoolExecutor(4) as pool:

        def feed() -> list[rga.LiveTwin]:
            meet.wait()
            return [twin.feed(one).new for one in pieces(sound[1], CUTS)]

        feeders = [pool.submit(feed) for _ in range(3)]
        players = [pool.submit(twin.play) for _ in range(2)]
        said = np.array([one.result() for one in feeders])
        for one in players:
            one.result()
        twin.play()
        assert (said.sum(axis=0) == 5).all()
        assert_same(history(twin), expected)


def test_first_rows_from_two_sides_keep_one_clock(sound: Given, tmp_path: Path) -> None:
    """Whoever comes second is measured from the first row of whoever came first."""
    model, record = sound
    for attempt in range(10):
        meet, place = Barrier(2), tmp_path / str(attempt)
        with rga.live(model, place, settings=SETTINGS) as twin, ThreadPoolExecutor(2) as pool:

            def feed(first: int, twin: rga.LiveTwin = twin, meet: Barrier = meet) -> int:
                part = record.rows(slice(first, first + 50))
                meet.wait()
                return twin.feed(part).new

            early, late = pool.map(feed, (0, 50))
            twin.play()
            with twin.twin as stored:
                back = stored.record
        assert late == 50
        assert early in (0, 50)
        clock = back.origin + back.time
        kept = (early + late) // 10 * 10
        np.testing.assert_array_equal(clock, record.time[100 - early - late :][:kept])


def test_a_loop_of_asyncio_feeds_plays_and_asks(sound: Given, tmp_path: Path) -> None:
    expected = at_once(sound, tmp_path / "once")

    async def stream(twin: rga.LiveTwin) -> None:
        for piece in pieces(sound[1], CUTS):
            await asyncio.to_thread(twin.feed, piece)

    async def play(twin: rga.LiveTwin, feeding: "asyncio.Task[None]") -> list[rga.twin.Event]:
        events = []
        while not feeding.done():
            events.append(await asyncio.to_thread(twin.play))
        return list(chain(*events, await asyncio.to_thread(twin.play)))

    async def both() -> list[rga.twin.Event]:
        with rga.live(sound[0], tmp_path, settings=SETTINGS) as twin:
            feeding = asyncio.create_task(stream(twin))
            events = await play(twin, feeding)
            assert_same(history(twin), expected)
            await asyncio.to_thread(twin.ask, Note(who="Ada"))
            return events + await asyncio.to_thread(twin.play)

    events = asyncio.run(both())
    assert tuple(events[:-1]) == expected.events
    assert events[-1].kind == "command"
