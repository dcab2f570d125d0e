"""A bridge whose contexts are all measured, records of it, and twins that have taken them in."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rga
from live_streams import SETTINGS, sinking
from rga.model import Model, read_model
from rga.records import Record
from rga.twin import Settings
from stored_runs import server

__all__ = ["server"]

Given = tuple[Model, Record]
#: rows of a record whose diagnosis has proposed something, and of which some are still to come
PROPOSED_BY = 90


@pytest.fixture(scope="session")
def sound(measured_bridge: dict[str, Any], measured_record: Callable[..., Record]) -> Given:
    """A model, and a record in which nothing happens."""
    model = read_model(measured_bridge, "measured bridge")
    return model, sinking(model, measured_record, 100, sinks=False)


@pytest.fixture(scope="session")
def sinks(sound: Given, measured_record: Callable[..., Record]) -> Given:
    """The same, with a bearing that sinks."""
    return sound[0], sinking(sound[0], measured_record, 100)


@pytest.fixture
def taken_in(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """A directory of a live twin that has taken rows in and is closed, for one test alone."""

    def directory(given: Given, rows: int, **more: Any) -> Path:
        wanted = Settings.model_validate(SETTINGS.model_dump() | more)
        key = (given[1].sha256, rows, wanted.model_dump_json())
        if key not in _TAKEN_IN:
            place = tmp_path_factory.mktemp("taken in")
            with rga.live(given[0], place, settings=wanted) as twin:
                twin.feed(given[1].rows(slice(0, rows)))
                twin.play()
            _TAKEN_IN[key] = place
        copy = tmp_path / f"twin {len(list(tmp_path.iterdir()))}"
        shutil.copytree(_TAKEN_IN[key], copy)
        return copy

    return directory


_TAKEN_IN: dict[tuple[str, int, str], Path] = {}


@pytest.fixture(scope="session")
def ended(sound: Given, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of the record in which nothing happens, done."""
    place = tmp_path_factory.mktemp("ended")
    with rga.live(sound[0], place, settings=SETTINGS) as twin:
        twin.feed(sound[1])
        twin.end()
    return place
