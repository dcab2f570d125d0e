"""Whoever feeds and whoever plays may be killed: every acknowledged row is there once."""

import os
from multiprocessing import get_context
from pathlib import Path
from random import Random

import pytest

import rga
from live_streams import (
    SETTINGS,
    acknowledged,
    arrived_in,
    assert_same,
    feed_from,
    history,
    play_until,
)
from rga.model import Model
from rga.model.io import model_text
from rga.records import Record
from rga.twin import Settings
from rga.twin.runner import Running

#: `RGA_TEST_KILLS=200` makes the test of killed runs as long as the acceptance wants it
KILLS = int(os.environ.get("RGA_TEST_KILLS", "6"))


def test_killed_at_random_it_loses_nothing_and_ends_the_same(
    sound: tuple[Model, Record], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    context = get_context("forkserver")
    context.set_forkserver_preload([feed_from.__module__, Running.__module__])
    wanted = {"policy": "time", "interval": 20, "settle": 20}
    settings = Settings.model_validate(SETTINGS.model_dump() | wanted)
    (tmp_path / "model.json").write_text(model_text(sound[0]), encoding="utf-8")
    sound[1].write(tmp_path / "record.csv")
    model = rga.load_model(tmp_path / "model.json")
    record = rga.load_record(tmp_path / "record.csv", model)
    with rga.live(model, tmp_path / "whole", settings=settings) as twin:
        twin.feed(record)
        twin.play()
        expected = history(twin)
    draw, kills, number, waiting = Random(7), 0, 0, 2.0
    while kills < KILLS:
        folder = tmp_path / f"run {number}"
        number += 1
        rga.live(model, folder, settings=settings).close()
        for name in ("model.json", "record.csv"):
            (folder / name).write_bytes((tmp_path / name).read_bytes())
        said, left = 0, 2
        for _ in range(1000):
            both = [
                context.Process(target=feed_from, args=(folder,)),
                context.Process(target=play_until, args=(folder, len(record))),
            ]
            for process in both:
                process.start()
            draw.shuffle(both)
            left = 0
            for process in both:
                # The last of all are left to end.
                process.join(draw.uniform(0.0, waiting) if kills < KILLS else None)
                if process.exitcode is None:
                    process.kill()
                    process.join()
                    kills, left = kills + 1, left + 1
                else:
                    assert process.exitcode == 0
            before, said = said, acknowledged(folder)
            assert arrived_in(folder) >= said
            if not left:
                break
            # A machine that is slow to start is granted more.
            waiting = waiting * 1.2 if said == before else max(2.0, waiting / 1.2)
        assert (left, said) == (0, len(record))
        with rga.LiveTwin(folder) as twin:
            assert twin.play() == []
            assert_same(history(twin), expected)
