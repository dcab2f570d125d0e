"""A sensor that somebody takes out of use: nothing reads it, and its readings are kept."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, history, kinds, with_readings
from rga.model import Model
from rga.records import Record, load_record
from rga.twin import Exclude, Recalibrate, Settings
from rga.twin.history import History

Given = tuple[Model, Record]
#: the row from which on a sensor is broken, and how far it is off [its unit]
BROKEN, FAR = 70, 50.0
SENSOR = "D2"
BY_THE_CLOCK = {"policy": "time", "interval": 20, "settle": 20}


def broken(record: Record, off: float = FAR) -> Record:
    """The record with a sensor that is off from a row on."""
    readings = record.readings.copy()
    readings[BROKEN:, record.sensors.index(SENSOR)] += off
    return with_readings(record, readings)


def excluded(
    model: Model, record: Record, place: Path, command: Exclude | None, **more: Any
) -> History:
    """What is left of a stream in which a command is given before the sensor is broken."""
    settings = Settings.model_validate(SETTINGS.model_dump() | more)
    with rga.live(model, place, settings=settings) as twin:
        twin.feed(record.rows(slice(0, BROKEN)))
        twin.play()
        if command is not None:
            twin.ask(command)
        twin.feed(record)
        twin.play()
        return history(twin)


def test_an_excluded_sensor_raises_no_alarm(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    command = Exclude(who="Ada", why="it fell off", sensor=SENSOR)
    left = excluded(model, broken(record), tmp_path / "excluded", command)
    used = excluded(model, broken(record), tmp_path / "used", None, level="B", settle=60)
    assert next(one.row for one in used.events if one.kind == "alarm") >= BROKEN
    assert kinds(left.events) == ["calibration", "command"]


@pytest.mark.parametrize(
    "off", [FAR, pytest.param(-3 * FAR, marks=pytest.mark.thorough), float("nan")]
)
def test_what_an_excluded_sensor_reads_changes_nothing(
    off: float, sound: Given, tmp_path: Path
) -> None:
    model, record = sound
    command = Exclude(who="Ada", sensor=SENSOR, since=600.0 * BROKEN, given_at="now")
    found = excluded(model, broken(record, off), tmp_path / "off", command, **BY_THE_CLOCK)
    expected = excluded(model, record, tmp_path / "sound", command, **BY_THE_CLOCK)
    assert kinds(found.events).count("recalibration") == 3
    assert found.events == expected.events
    np.testing.assert_array_equal(found.simulated, expected.simulated)
    np.testing.assert_array_equal(found.gaps, expected.gaps)
    column = record.sensors.index(SENSOR)
    assert np.isnan(found.gaps[BROKEN:, column]).all()
    assert np.isfinite(found.gaps[:BROKEN, column]).all()


@pytest.mark.thorough
def test_nor_where_contexts_are_inferred_from_the_others(
    small_stream: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small_stream(drifts=False, sinks=False, rows=100)
    model = rga.load_model(folder / "model.json")
    record = load_record(folder / "record.csv", model)
    kept = Settings.model_validate_json((folder / "settings.json").read_text("utf-8"))
    wanted = kept.model_dump() | {"inference": "joint"} | BY_THE_CLOCK | {"interval": 30}
    command = Exclude(who="Ada", sensor=SENSOR, since=600.0 * BROKEN, given_at="now")
    found = excluded(model, broken(record), tmp_path / "off", command, **wanted)
    expected = excluded(model, record, tmp_path / "sound", command, **wanted)
    used = excluded(model, record, tmp_path / "used", None, **wanted)
    assert kinds(found.events).count("recalibration") == 2
    assert found.events == expected.events
    for name in ("inferred", "spread", "simulated"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
        np.testing.assert_array_equal(getattr(found, name)[:BROKEN], getattr(used, name)[:BROKEN])
    # Who knows less is less sure.
    assert found.spread[BROKEN:].mean() > used.spread[BROKEN:].mean()


def test_the_diagnosis_does_not_see_it(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, BROKEN)))
        twin.play()
        twin.ask(Exclude(who="Ada", sensor=SENSOR))
        twin.feed(broken(record))
        outcome = twin.end()
    assert outcome.findings.verdict == "nothing_wrong"
    assert outcome.findings.causes == []
    since = record.time_label(float(record.time[BROKEN - 1]))
    said = f"no reading of {SENSOR} is used from {since} on, as was asked for"
    assert said in outcome.findings.warnings


def test_its_readings_stay_in_the_record(
    sound: Given, tmp_path: Path, rga: Callable[..., Any]
) -> None:
    model, record = sound
    given = broken(record)
    excluded(model, given, tmp_path / "twin", Exclude(who="Ada", sensor=SENSOR))
    assert rga("export", tmp_path / "twin", "-o", tmp_path / "out.csv").code == 0
    back = load_record(tmp_path / "out.csv", model)
    np.testing.assert_array_equal(back.readings, given.readings)


def test_it_is_used_again_afterwards(sound: Given, tmp_path: Path) -> None:
    """Between two dates, the first of which is out of use and the last of which is not."""
    model, record = sound
    start = "2026-03-29T00:00:00+01:00"
    given = replace(record, start=start, time_format="iso")
    out = slice(80, 90)
    command = Exclude(
        who="Ada", sensor=SENSOR, since=given.time_label(48000.0), until="2026-03-29T14:00:00Z"
    )
    found = excluded(model, given, tmp_path, command)
    column = record.sensors.index(SENSOR)
    gone = np.isnan(found.gaps[:, column])
    assert gone.sum() == 10
    assert gone[out].all()


def test_rows_that_were_followed_stay_as_they_are(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    command = Exclude(who="Ada", sensor=SENSOR, since=0.0)
    found = excluded(model, record, tmp_path / "out", command)
    expected = excluded(model, record, tmp_path / "used", None)
    (event,) = [one for one in found.events if one.kind == "command"]
    assert event.words.endswith("rows that were followed stay as they are")
    np.testing.assert_array_equal(found.gaps[:BROKEN], expected.gaps[:BROKEN])
    assert np.isnan(found.gaps[BROKEN:, record.sensors.index(SENSOR)]).all()


def test_it_stays_out_of_use_when_the_twin_is_taken_up_again(sound: Given, tmp_path: Path) -> None:
    model, record = sound
    given = broken(record)
    with rga.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(given.rows(slice(0, BROKEN)))
        twin.play()
        twin.ask(Exclude(who="Ada", sensor=SENSOR))
        twin.play()
    for end in (80, 90, 100):
        with rga.LiveTwin(tmp_path) as twin:
            twin.feed(given.rows(slice(0, end)))
            twin.play()
            twin.ask(Recalibrate(who="Ada"))
            twin.play()
            found = history(twin)
    assert kinds(found.events).count("recalibration") == 3
    assert "alarm" not in kinds(found.events)
    assert "diagnosis" not in kinds(found.events)
