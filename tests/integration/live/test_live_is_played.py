"""A live twin is what `rga.run` makes of the same rows, however they arrive."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, assert_same, history, kinds, pieces
from rga.model import Model
from rga.records import Record
from rga.twin import Settings
from rga.twin.history import History
from rga.twin.runner import taken_up

Given = tuple[Model, Record]


def played(model: Model, record: Record, settings: Settings, place: Path) -> History:
    """What a run leaves behind before its closing diagnosis."""
    with taken_up(model, record, place, settings, 0) as running:
        while running.stage != "close":
            running.step()
        return running.history()


@pytest.mark.thorough
def test_a_stream_in_pieces_ends_as_its_record_does(
    small_stream: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small_stream(drifts=False, rows=130)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    settings = Settings.model_validate_json((folder / "settings.json").read_text("utf-8"))
    with rga.live(model, tmp_path / "live", settings=settings) as twin:
        happened = []
        for piece in pieces(record, [1, 7, 39, 40, 95, 111, 113, 129]):
            twin.feed(piece)
            happened += twin.play()
        outcome = twin.end()
        with twin.twin as stored:
            stored.record.write(tmp_path / "again.csv")
    again = rga.load_record(tmp_path / "again.csv", model)
    with taken_up(model, again, tmp_path / "played.sqlite", settings, 0) as running:
        while running.stage != "report":
            running.step()
        expected, findings = running.history(), running.findings()
    assert {"alarm", "recalibration", "diagnosis", "version"} < set(kinds(happened))
    assert tuple(happened) == outcome.history.events[: len(happened)]
    assert_same(outcome.history, expected)
    assert [one.effect for one in outcome.findings.causes] == [
        one.effect for one in findings.causes
    ]
    for name in ("findings.json", "model.json", "report.html"):
        assert (tmp_path / "live" / name).exists()


@pytest.mark.parametrize(
    "start", [0.0, 1e9 + 0.3, "2026-03-29T01:30:00+01:00", "2026-03-29T01:30:00.123457"]
)
def test_odd_times_are_those_of_the_record(
    start: str | float, sound: Given, tmp_path: Path
) -> None:
    model, record = sound
    dated = isinstance(start, str)
    draw = np.random.default_rng(6)
    time = np.cumsum(draw.uniform(0.1, 2000.0, len(record)))
    time = np.round(time - time[0], 6) if dated else time - time[0]
    readings = record.readings.copy()
    readings[draw.random(readings.shape) < 0.05] = np.nan
    given = replace(
        record,
        time=time,
        start=start,
        time_format="iso" if dated else "seconds",
        readings=readings,
        contexts={
            n: np.where(draw.random(100) < 0.05, np.nan, v) for n, v in record.contexts.items()
        },
    )
    given.write(tmp_path / "given.csv")
    given = rga.load_record(tmp_path / "given.csv", model)
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        for piece in pieces(given, draw.choice(np.arange(1, 100), 12, replace=False)):
            twin.feed(piece)
            twin.play()
        found = history(twin)
    assert kinds(found.events) == ["calibration"]
    found.record.write(tmp_path / "again.csv")
    again = rga.load_record(tmp_path / "again.csv", model)
    np.testing.assert_array_equal(again.time, found.record.time)
    assert_same(found, played(model, again, SETTINGS, tmp_path / "played.sqlite"))
    np.testing.assert_array_equal(found.record.readings, given.readings)


def test_rows_arrive_as_files_and_data_frames_too(sound: Given, tmp_path: Path) -> None:
    import polars as pl

    model, record = sound
    record.write(tmp_path / "record.csv")
    table = pl.read_csv(tmp_path / "record.csv")
    table[:30].write_csv(tmp_path / "first.csv")
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        assert twin.feed(tmp_path / "first.csv").new == 30
        for first, count in ((30, 1), (31, 1), (32, 68)):
            assert twin.feed(table[first : first + count]).new == count
        twin.play()
        found = history(twin)
    assert_same(found, played(model, record, SETTINGS, tmp_path / "played.sqlite"))


def test_a_channel_that_is_left_out_is_missing(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    silent = record.readings.copy()
    silent[60:80, 2] = np.nan
    whole = replace(record, readings=silent)
    others = [name for name in record.sensors if name != record.sensors[2]]
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        first, second, third = pieces(record, [60, 80])
        for piece in (first, second.channels(others), third):
            twin.feed(piece)
        twin.play()
        found = history(twin)
    assert_same(found, played(model, whole, SETTINGS, tmp_path / "played.sqlite"))


@pytest.mark.parametrize("row", [79, 75, 0])
def test_a_packet_without_a_context_is_taken_up_again(
    row: int, sound: Given, tmp_path: Path
) -> None:
    model, record = sound
    contexts = {name: column.copy() for name, column in record.contexts.items()}
    contexts["west load"][row] = np.nan
    given = replace(record, contexts=contexts)
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(given.rows(slice(0, 80)))
        twin.play()
    with rga.LiveTwin(tmp_path) as twin:
        twin.feed(given)
        twin.play()
        found = history(twin)
    assert np.isnan(found.simulated).any(axis=1).nonzero()[0].tolist() == [row]
    assert_same(found, played(model, given, SETTINGS, tmp_path / "played.sqlite"))


def test_settings_are_kept_with_the_twin(sound: Given, tmp_path: Path) -> None:
    """Whoever goes on needs the directory alone."""
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS, name="east bank", seed=5) as twin:
        twin.feed(record)
        twin.play()
        begun = history(twin)
    with rga.LiveTwin(tmp_path) as again:
        assert (again.name, again.model.name) == ("east bank", model.name)
        assert again.play() == []
        assert_same(history(again), begun)
    with rga.Twin.open(tmp_path) as stored:
        settings = json.loads(stored._view.identity.settings)
    assert Settings.model_validate(settings) == SETTINGS
