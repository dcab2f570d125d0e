"""However rows are cut, fed again and taken up again, the twin is the same bit for bit."""

import json
import os
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, assert_same, history
from rga.model import Model
from rga.records import Record
from rga.twin import Settings
from rga.twin.history import History

#: `RGA_TEST_CUTS=100` draws as many ways to feed and play
CUTS = int(os.environ.get("RGA_TEST_CUTS", "6"))


@dataclass(frozen=True)
class Stream:
    """A stream, how it is played, and what is left when it is played at once."""

    model: Model
    record: Record
    settings: Settings
    expected: History

    @classmethod
    def at_once(cls, model: Model, record: Record, settings: Settings, place: Path) -> "Stream":
        with rga.live(model, place, settings=settings) as twin:
            twin.feed(record)
            twin.play()
            return cls(model, record, settings, history(twin))


@pytest.fixture(scope="module")
def measured(sound: tuple[Model, Record], tmp_path_factory: pytest.TempPathFactory) -> Stream:
    """All contexts are measured, some of them not always."""
    model, given = sound
    draw = np.random.default_rng(8)
    gone = {n: draw.random(len(given)) < 0.02 for n in given.contexts}
    contexts = {n: np.where(gone[n], np.nan, column) for n, column in given.contexts.items()}
    wanted = {"policy": "time", "interval": 20, "settle": 20}
    settings = Settings.model_validate(SETTINGS.model_dump() | wanted)
    place = tmp_path_factory.mktemp("measured")
    return Stream.at_once(model, replace(given, contexts=contexts), settings, place)


@pytest.fixture(scope="module")
def latent(small_stream: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Stream:
    """Two of three contexts are inferred, and some of them are novel."""
    folder = small_stream(sinks=False, rows=100)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    kept: dict[str, Any] = json.loads((folder / "settings.json").read_text("utf-8"))
    settings = Settings.model_validate(
        kept | {"inference": "joint", "policy": "time", "interval": 50}
    )
    return Stream.at_once(model, record, settings, tmp_path_factory.mktemp("latent"))


def played_somehow(stream: Stream, place: Path, draw: Random) -> History:
    """The same stream, cut, fed again and played at random, by one twin after another."""
    model, record = stream.model, stream.record
    longest = draw.choice([3, 25, 70, len(record)])
    with ExitStack() as held:
        twin = held.enter_context(rga.live(model, place, settings=stream.settings))
        fed = 0
        while fed < len(record):
            first = draw.choice([fed, fed, max(0, fed - 20), 0])
            end = min(len(record), fed + draw.randint(1, longest))
            said = twin.feed(record.rows(slice(first, end)))
            assert (said.new, said.left_out) == (end - fed, fed - first)
            fed = end
            if draw.random() < 0.4:
                twin.play()
            if draw.random() < 0.3:
                # As when a step was taken and the next was not.
                twin.play(lambda running: draw.random() < 0.7)
            if draw.random() < 0.2:
                held.close()
                twin = held.enter_context(rga.LiveTwin(place))
        twin.play()
        return history(twin)


@pytest.mark.parametrize("seed", range(CUTS))
def test_cuts_and_restarts_change_nothing(seed: int, measured: Stream, tmp_path: Path) -> None:
    assert_same(played_somehow(measured, tmp_path, Random(seed)), measured.expected)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(max(1, CUTS // 10)))
def test_nor_do_they_where_contexts_are_inferred(seed: int, latent: Stream, tmp_path: Path) -> None:
    assert_same(played_somehow(latent, tmp_path, Random(seed)), latent.expected)


def test_these_streams_have_something_to_lose(measured: Stream, latent: Stream) -> None:
    found = {
        name: [one.kind for one in stream.expected.events]
        for name, stream in (("measured", measured), ("latent", latent))
    }
    assert found["measured"].count("recalibration") >= 2
    assert found["latent"].count("recalibration") >= 1
    assert "novel context" in found["latent"]
    assert np.isnan(measured.expected.simulated[40:]).any()
    assert np.isfinite(latent.expected.inferred).all()
