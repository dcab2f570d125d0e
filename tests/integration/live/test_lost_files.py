"""A file of a twin that is lost is told of; rows that lack something are taken as they are."""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from sqlite3 import connect
from typing import Any

import numpy as np
import pytest

import rga as package
from live_streams import SETTINGS, assert_same, history
from rga import LiveTwin
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin import Exclude

Given = tuple[Model, Record]


def test_a_repository_that_is_lost_is_told_of(sound: Given, taken_in: Callable[..., Path]) -> None:
    place = taken_in(sound, 50)
    for file in place.glob("twin.sqlite*"):
        file.unlink()
    with (
        LiveTwin(place) as twin,
        pytest.raises(InputError, match="row 0 was taken in before, and the repository does not"),
    ):
        twin.play()
    assert not (place / "twin.sqlite").exists()


def test_an_inbox_that_is_lost_is_told_of(
    sound: Given, taken_in: Callable[..., Path], rga: Callable[..., Any]
) -> None:
    place = taken_in(sound, 50)
    assert "inbox" not in rga("replay", place, "--check").out
    for file in place.glob("inbox.sqlite*"):
        file.unlink()
    assert "inbox.sqlite is not there" in rga("replay", place, "--check").out
    with package.live(sound[0], place, settings=SETTINGS) as twin:
        with pytest.raises(InputError, match="not those that the twin began with"):
            twin.feed(sound[1].rows(slice(50, 100)))
        # Nothing of them is kept.
        assert twin.feed(sound[1].rows(slice(0, 60))).new == 60
        twin.play()
        assert len(history(twin).record) == 60


def test_a_damaged_inbox_is_told_of(
    sound: Given, taken_in: Callable[..., Path], rga: Callable[..., Any]
) -> None:
    place = taken_in(sound, 50)
    with LiveTwin(place) as twin:
        twin.feed(sound[1].rows(slice(50, 80)))
    assert rga("replay", place, "--check").code == 0
    with closing(connect(place / "inbox.sqlite")) as connection, connection:
        connection.execute("UPDATE row SET time = time + 1 WHERE number = 70")
    said = "an entry of row number 70 is not what was"
    with LiveTwin(place) as twin, pytest.raises(InputError, match=said):
        twin.play()
    done = rga("replay", place, "--check")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "an entry of row number 70 of the inbox" in done.err


def test_it_is_proved_whole_where_nothing_can_be_written(
    sound: Given,
    taken_in: Callable[..., Path],
    rga: Callable[..., Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    place = taken_in(sound, 50)
    files = {file.name: file.read_bytes() for file in place.glob("*.sqlite*")}
    monkeypatch.setattr("rga.twin.repository.sqlite.os.access", lambda path, mode: False)
    done = rga("replay", place, "--check")
    assert (done.code, done.err) == (0, "")
    assert "The repository is whole" in done.out
    assert {file.name: file.read_bytes() for file in place.glob("*.sqlite*")} == files


def test_all_rows_may_be_fed_again_into_a_new_inbox(
    sound: Given, taken_in: Callable[..., Path], tmp_path: Path
) -> None:
    place = taken_in(sound, 50)
    for file in place.glob("inbox.sqlite*"):
        file.unlink()
    with package.live(sound[0], place, settings=SETTINGS) as twin:
        twin.feed(sound[1])
        twin.play()
        with LiveTwin(taken_in(sound, 100)) as other:
            assert_same(history(twin), history(other))


def test_a_twin_that_has_not_begun_says_so(sound: Given, tmp_path: Path) -> None:
    with (
        package.live(sound[0], tmp_path, settings=SETTINGS) as twin,
        pytest.raises(InputError, match="it has not begun"),
    ):
        assert twin.twin


@pytest.mark.parametrize("how", ["empty", "absent"])
def test_a_channel_that_a_frame_lacks_is_missing(
    how: str, sound: Given, taken_in: Callable[..., Path]
) -> None:
    _model, record = sound
    frame = record.rows(slice(50, 60)).to_frame()
    dead = record.sensors[2]
    frame = frame.drop(dead) if how == "absent" else frame.with_columns(**{dead: None})
    with LiveTwin(taken_in(sound, 50)) as twin:
        for row in frame.iter_slices(1):
            assert twin.feed(row).new == 1
        twin.play()
        found = twin.twin.record.readings
    assert np.isnan(found[50:60, 2]).all()
    others = [number for number in range(len(record.sensors)) if number != 2]
    np.testing.assert_array_equal(found[50:60, others], record.readings[50:60, others])


@pytest.mark.parametrize("first", [None, 1e6])
def test_the_last_sensor_cannot_be_excluded(
    first: float | None, sound: Given, taken_in: Callable[..., Path]
) -> None:
    """Neither now nor at a time at which all others are out of use."""
    with LiveTwin(taken_in(sound, 50)) as twin:
        for number, name in enumerate(sound[1].sensors):
            twin.ask(Exclude(who="Ada", sensor=name, since=None if number else first))
        twin.play()
        outcomes = [one.outcome for one in twin.twin.commands()]
    assert ["refused" in one for one in outcomes] == [False] * (len(outcomes) - 1) + [True]
    assert "no sensor would be left" in outcomes[-1]


def test_a_time_with_a_zone_is_no_time_of_rows_without(
    sound: Given, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, Any] = {**vars(sound[1]), "start": "2026-03-01T00:00:00"}
    record = Record(**given | {"time_format": "iso"})
    with package.live(sound[0], tmp_path, settings=SETTINGS) as twin:
        twin.feed(record)
        twin.ask(Exclude(who="Ada", sensor="D1", since="2026-03-01T09:00:00+01:00"))
        twin.play()
        (command,) = twin.twin.commands()
    assert "refused: the rows have no time zone" in command.outcome


@pytest.mark.parametrize("dead", [slice(2, 3), slice(None)], ids=["one", "all"])
@pytest.mark.parametrize("how", ["csv", "parquet", "frame", "record"])
def test_a_channel_without_a_reading_is_missing_however_it_is_fed(
    how: str, dead: slice, sound: Given, taken_in: Callable[..., Path], tmp_path: Path
) -> None:
    row = sound[1].rows(slice(50, 51))
    readings = row.readings.copy()
    readings[:, dead] = np.nan
    given: Any = replace(row, readings=readings)
    if how == "frame":
        given = given.to_frame()
    elif how != "record":
        given.write(tmp_path / f"row.{how}")
        given = tmp_path / f"row.{how}"
    with LiveTwin(taken_in(sound, 50)) as twin:
        assert twin.feed(given).new == 1
        twin.feed(sound[1].rows(slice(51, 60)))
        twin.play()
        found = twin.twin.record.readings[50:51]
    np.testing.assert_array_equal(found, readings)
