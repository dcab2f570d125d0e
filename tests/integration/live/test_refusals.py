"""What a live twin cannot take, in words that say what and how to mend it; nothing is half done."""

import os
from collections.abc import Callable
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, arrived_in, assert_same, commands, history, kinds, play_until
from rga.errors import InputError
from rga.jobs.live import Fed
from rga.model import Model, read_model
from rga.records import Record
from rga.twin import Note, Settings, carry_out
from rga.twin.repository import Identity, Repository
from rga.twin.repository.sqlite import SQLite

Given = tuple[Model, Record]


@pytest.mark.parametrize("absent", ["calibration_rows", "packet", "settle", "interval"])
def test_what_takes_no_share_is_to_be_stated(absent: str, sound: Given, tmp_path: Path) -> None:
    stated = SETTINGS.model_dump() | {"policy": "hybrid", "interval": 40}
    settings = Settings.model_validate(stated | {absent: None})
    with pytest.raises(InputError, match=absent) as refused:
        rga.live(sound[0], tmp_path / "twin", settings=settings)
    others = {"calibration_rows", "packet", "settle", "interval"} - {absent}
    assert not any(other in str(refused.value) for other in others)
    assert not (tmp_path / "twin").exists()
    rga.live(sound[0], tmp_path / "twin", settings=Settings.model_validate(stated)).close()


def test_without_settings_all_are_named(sound: Given, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="calibration_rows, packet, settle"):
        rga.live(sound[0], tmp_path)


def test_a_context_that_moves_along_a_line_is_refused(
    measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    loads = {**measured_bridge["context"]["west load"], "law": "linear", "rate": [0.0, 1.0]}
    moving = {**measured_bridge, "context": {**measured_bridge["context"], "west load": loads}}
    with pytest.raises(InputError, match="west load moves along a line"):
        rga.live(read_model(moving, "moving"), tmp_path, settings=SETTINGS)


def test_a_zero_is_refused(measured_bridge: dict[str, Any], sound: Given, tmp_path: Path) -> None:
    zeroed = {n: {**one, "zero": [0.0, 600.0]} for n, one in measured_bridge["sensors"].items()}
    with pytest.raises(InputError, match=r"zero of D1, .* is that of rows in a record"):
        rga.live(read_model({**measured_bridge, "sensors": zeroed}, "z"), tmp_path / "model")
    with rga.live(sound[0], tmp_path / "rows", settings=SETTINGS) as twin:
        with pytest.raises(InputError, match="a zero was taken off them"):
            twin.feed(replace(sound[1], zero=(0.0, 600.0)))
        assert twin.feed(sound[1]).new == 100


def without(record: Record, context: str) -> Record:
    """The record without a context."""
    kept = {name: column for name, column in record.contexts.items() if name != context}
    return replace(record, contexts=kept)


@pytest.mark.parametrize(
    ("first", "later", "words"),
    [
        (lambda r: r.channels(r.sensors[1:]), lambda r: r, "the first rows had no D1"),
        (lambda r: without(r, "west load"), lambda r: r, "the first rows had no west load"),
        (
            lambda r: r,
            lambda r: replace(r, start="2026-03-01T12:00:00", time_format="iso"),
            "write time otherwise than the first did",
        ),
        (
            lambda r: replace(r, start="2026-03-01T12:00:00", time_format="iso"),
            lambda r: replace(r, start="2026-03-02T12:00:00+01:00", time_format="iso"),
            "some times have a time zone and some have none",
        ),
        (
            lambda r: r,
            lambda r: replace(r, sensors=("D9", *r.sensors[1:])),
            "the model has no sensor 'D9'",
        ),
    ],
)
def test_later_rows_are_like_the_first(
    first: Callable[[Record], Record],
    later: Callable[[Record], Record],
    words: str,
    sound: Given,
    tmp_path: Path,
) -> None:
    model, record = sound
    head, tail = record.rows(slice(0, 50)), record.rows(slice(50, None))
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(first(head))
        with pytest.raises(InputError, match=words):
            twin.feed(later(tail))
        assert arrived_in(tmp_path) == 50
        assert twin.feed(first(record)).new == 50


def test_the_first_rows_are_of_the_model(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        with pytest.raises(InputError, match="the model has no sensor 'D9'"):
            twin.feed(replace(record, sensors=("D9", *record.sensors[1:])))
        with pytest.raises(InputError, match="the rows hold no sensor"):
            twin.feed(record.channels(()))
        assert twin.play() == []
        assert twin.feed(record).new == 100


def with_value(record: Record, name: str, value: float) -> Record:
    """The record with another value of a sensor or a context in its third row."""
    if name in record.contexts:
        column = record.contexts[name].copy()
        column[2] = value
        return replace(record, contexts={**record.contexts, name: column})
    readings = record.readings.copy()
    readings[2, record.sensors.index(name)] = value
    return replace(record, readings=readings)


def with_time(record: Record, value: float) -> Record:
    """The record with another time of its third row."""
    time = record.time.copy()
    time[2] = value
    return replace(record, time=time)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda r: with_value(r, "D2", np.inf), "D2 is inf in row 2"),
        (lambda r: with_value(r, "D2", -1e100), "D2 is -1e.100 in row 2"),
        (lambda r: with_value(r, "west load", -np.inf), "west load is -inf in row 2"),
        (lambda r: with_time(r, r.time[1]), "the times do not rise"),
        (lambda r: with_time(r, r.time[0] - 1.0), "the times do not rise"),
        (lambda r: with_time(r, np.nan), "the times do not rise"),
        (lambda r: replace(r, readings=r.readings[:-1]), "its shape is"),
        (lambda r: replace(r, readings=r.readings[:, :-1]), "its shape is"),
    ],
)
def test_a_record_that_would_spoil_the_twin_is_not_taken(
    made: Callable[[Record], Record], words: str, sound: Given, tmp_path: Path
) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, 50)))
        with pytest.raises(InputError, match=words):
            twin.feed(made(record.rows(slice(50, 100))))
        assert arrived_in(tmp_path) == 50
        assert twin.feed(record).new == 50
        twin.play()


def test_after_the_end_nothing_is_fed(ended: Path, sound: Given) -> None:
    with rga.LiveTwin(ended) as twin:
        before = history(twin)
        with pytest.raises(InputError, match="it has ended"):
            twin.feed(sound[1])
        assert twin.play() == []
        # It is not ended twice.
        assert twin.end().findings.verdict == "nothing_wrong"
        assert_same(history(twin), before)


@pytest.mark.parametrize("rows", [0, 1, 39])
def test_with_too_few_rows_it_does_not_end(rows: int, sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, rows)))
        twin.play()
        with pytest.raises(InputError, match=f"the calibration wants 40 rows, and {rows} have"):
            twin.end()
        # It goes on when more of them come.
        assert twin.feed(record).new == 100 - rows
        twin.play()
        assert len(history(twin).record) == 100


@pytest.mark.parametrize(
    ("what", "more"),
    [
        ("settings", {"settings": Settings.model_validate(SETTINGS.model_dump() | {"packet": 5})}),
        ("name", {"name": "another"}),
        ("seed", {"seed": 1}),
    ],
)
def test_another_twin_in_the_directory_is_refused(
    what: str, more: dict[str, Any], sound: Given, tmp_path: Path
) -> None:
    model = sound[0]
    rga.live(model, tmp_path, settings=SETTINGS).close()
    with pytest.raises(InputError, match=f"a live twin that differs in {what} is here"):
        rga.live(model, tmp_path, **{"settings": SETTINGS} | more)
    stiffer = replace_area(model)
    with pytest.raises(InputError, match="a live twin that differs in model is here"):
        rga.live(stiffer, tmp_path, settings=SETTINGS)
    rga.live(model, tmp_path, settings=SETTINGS).close()


def test_a_run_of_a_record_and_a_twin_that_goes_on_do_not_share_a_directory(
    sound: Given, ended: Path, tmp_path: Path
) -> None:
    model, record = sound
    with pytest.raises(InputError, match="a twin that goes on is here"):
        rga.run(model, record, ended, settings=SETTINGS)
    with Repository.open(tmp_path) as repository:
        repository.run(Identity("model", "record", 1, "{}"))
    with pytest.raises(InputError, match="a run of a finished record is here"):
        rga.live(model, tmp_path, settings=SETTINGS)


def replace_area(model: Model) -> Model:
    """The same bridge of thicker bars."""
    content = model.model_dump(mode="json", exclude_none=True, by_alias=True)
    content["sections"]["bar"]["A"] = 0.005
    return read_model(content, "stiffer")


def test_a_directory_without_a_twin_is_left_as_it_is(ended: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such directory"):
        rga.LiveTwin(tmp_path / "nowhere")
    with pytest.raises(InputError, match="no live twin is here"):
        rga.LiveTwin(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_no_twin_stands_before_the_first_step(sound: Given, tmp_path: Path) -> None:
    with rga.live(sound[0], tmp_path, settings=SETTINGS) as twin:
        assert twin.play() == []
        with pytest.raises(InputError):
            _ = twin.twin


def test_one_process_plays_at_a_time(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, 60)))
        twin.play()
        with rga.LiveTwin(tmp_path) as other:
            # It may feed and ask all the same.
            assert other.feed(record).new == 40
            assert other.ask(Note(who="Ada")) == 1
            with pytest.raises(InputError, match=f"process {os.getpid()} of .* writes there"):
                other.play()
            with pytest.raises(InputError, match="ask the service or the program that plays it"):
                carry_out(tmp_path, Note(who="Ada"))
            twin.play()
            assert len(history(other).record) == 100
            twin.close()
            assert other.play() == []


def test_a_second_process_waits_for_the_first(sound: Given, tmp_path: Path) -> None:
    context = get_context("forkserver")
    context.set_forkserver_preload([play_until.__module__])
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record)
        twin.play()
        refused = context.Process(target=play_until, args=(tmp_path, 100))
        refused.start()
        refused.join()
        assert refused.exitcode == 1
        assert twin.play() == []
    allowed = context.Process(target=play_until, args=(tmp_path, 100))
    allowed.start()
    allowed.join()
    assert allowed.exitcode == 0


def test_a_full_disk_keeps_no_half(
    sound: Given, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows that do not fit are refused as a whole; with room again they are fed again."""
    model, record = sound
    with rga.live(model, tmp_path / "twin", settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, 10)))
        connect = SQLite._connect

        def small(self: SQLite) -> Any:
            connection = connect(self)
            pages = connection.execute("PRAGMA page_count").fetchone()[0]
            connection.execute(f"PRAGMA max_page_count = {pages + 1}")
            return connection

        with monkeypatch.context() as full:
            full.setattr(SQLite, "_connect", small)
            refused = pytest.raises(InputError, match="the disk of the repository is full")
            with rga.LiveTwin(tmp_path / "twin") as other, refused:
                other.feed(record)
        assert arrived_in(tmp_path / "twin") == 10
        assert twin.feed(record).new == 90
        twin.play()
        found = history(twin)
    with rga.live(model, tmp_path / "room", settings=SETTINGS) as twin:
        twin.feed(record)
        twin.play()
        assert_same(found, history(twin))


def test_a_step_that_finds_no_room_is_taken_when_there_is(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, 60)))
        twin.play()
        before = history(twin)
        twin.feed(record)
        running = twin._running
        assert running is not None
        connection = running._archive.run._connection
        with connection.begin():
            connection.exec_driver_sql("PRAGMA max_page_count = 1")
        with pytest.raises(InputError, match="the disk of the repository is full"):
            twin.play()
        stopped = history(twin)
        assert len(stopped.record) % 10 == 0
        assert stopped.events == before.events
        # It is played by a connection of its own then.
        twin.play()
        assert len(history(twin).record) == 100
        found = history(twin)
    with rga.live(model, tmp_path / "room", settings=SETTINGS) as twin:
        twin.feed(record)
        twin.play()
        assert_same(found, history(twin))


def test_a_command_that_finds_no_room_waits_and_is_not_refused(
    sound: Given, tmp_path: Path
) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record)
        twin.play()
        twin.ask(Note(who="Ada", why="long " * 2000))
        running = twin._running
        assert running is not None
        connection = running._archive.run._connection
        with connection.begin():
            connection.exec_driver_sql("PRAGMA max_page_count = 1")
        with pytest.raises(InputError, match="the disk of the repository is full"):
            twin.play()
        assert commands(tmp_path) == ()
        assert kinds(twin.play()) == ["command"]
    assert [one.outcome for one in commands(tmp_path)] == ["noted"]


def test_no_rows_are_no_fault(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        assert twin.feed(record.rows(slice(0, 0))) == Fed(0, 0)
        assert twin.feed(record) == Fed(100, 0)
        assert twin.feed(record) == Fed(0, 100)
        late = record.rows(np.arange(100) % 2 == 0)
        assert twin.feed(late) == Fed(0, 50)


def test_a_command_of_values_that_cannot_be_is_one_error() -> None:
    for given, said in (
        ({"who": "x" * 201}, "who: "),
        ({"who": ""}, "who: "),
        ({"who": "Ada", "why": "x" * 20_001}, "why: "),
        ({"who": "\udcff"}, "who: "),
        ({"who": "Ada", "to": 1}, "to: "),
        ({}, "who: "),
    ):
        with pytest.raises(InputError, match=said) as error:
            Note(**given)
        assert "\n" not in str(error.value)


@pytest.mark.parametrize("seed", [-1, 2**63])
def test_a_seed_that_no_repository_holds(seed: int, sound: Given, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is no seed"):
        rga.run(*sound, tmp_path / "out", seed=seed)
    assert not list(tmp_path.rglob("*.sqlite*"))
