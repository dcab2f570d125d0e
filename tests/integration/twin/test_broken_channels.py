"""Channels that are broken from the first row, on the sample of the footbridge."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rga
from documentation import ROOT
from rga.errors import InputError
from rga.model.io import read_model
from rga.records import Record
from rga.twin import Outcome, Settings

SAMPLE = ROOT / "examples" / "footbridge"
pytestmark = pytest.mark.usefixtures("without_reports")
#: rows of the sample before its abutment settles
BEFORE = 80
#: thresholds of false alarms that come more often are found from shorter streams
SETTINGS = Settings(arl0=2000.0)


@pytest.fixture(scope="module")
def sample() -> tuple[rga.Model, Record]:
    model = rga.load_model(SAMPLE / "model.json")
    return model, rga.load_record(SAMPLE / "record.csv", model)


def spoilt(record: Record, sensor: str, *, times: float = 1.0, plus: float = 0.0) -> Record:
    readings = record.readings.copy()
    readings[:, record.sensors.index(sensor)] *= times
    readings[:, record.sensors.index(sensor)] += plus
    return replace(record, readings=readings)


def words(outcome: Outcome, kind: str) -> list[str]:
    return [event.words for event in outcome.history.events if event.kind == kind]


def test_a_channel_that_stands_still_hides_nothing(
    sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    model, record = sample
    broken = spoilt(record, "w3", times=0.0, plus=15.0)
    outcome = rga.run(model, broken, tmp_path, settings=SETTINGS)
    history = outcome.history
    (calibration,) = words(outcome, "calibration")
    assert "w3 is left out: 100% of its readings repeat the one before" in calibration
    (recalibration,) = words(outcome, "recalibration")
    assert recalibration.startswith("measured contexts do not explain rows")
    named = next(event for event in history.events if event.kind == "version")
    assert "settlement of abutment" in named.words
    assert named.row < 0.65 * len(record)
    still = record.sensors.index("w3")
    assert np.isnan(history.gaps[:, still]).all()
    assert np.isnan(history.noise[still])
    assert np.isfinite(np.delete(history.noise, still)).all()


def test_a_channel_that_stands_still_is_no_change(
    sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    model, record = sample
    broken = spoilt(record.rows(slice(0, BEFORE)), "w3", times=0.0, plus=15.0)
    outcome = rga.run(model, broken, tmp_path, settings=SETTINGS)
    assert {event.kind for event in outcome.history.events} == {"calibration", "diagnosis"}
    causes = [cause.effect for cause in outcome.findings.causes]
    assert causes == [{"kind": "sensor_fault", "sensor": "w3", "mode": "stuck"}]


def test_a_gap_that_hides_changes_is_never_calm(
    sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    model, record = sample
    outcome = rga.run(model, spoilt(record, "w3", times=1000.0), tmp_path, settings=SETTINGS)
    (calibration,) = words(outcome, "calibration")
    assert "wrong from the beginning" in calibration
    (recalibration,) = words(outcome, "recalibration")
    assert "a change hides in it; the model is in doubt" in recalibration
    assert any("settlement of abutment" in one for one in words(outcome, "version"))


def test_nothing_is_calibrated_where_all_channels_stand_still(
    sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    model, record = sample
    still = replace(record, readings=np.full_like(record.readings, 3.0))
    with pytest.raises(InputError, match="none of the channels works"):
        rga.run(model, still, tmp_path, settings=SETTINGS)


def test_a_channel_that_comes_later_stops_nothing(
    sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    model, record = sample
    readings = record.rows(slice(0, BEFORE)).readings.copy()
    readings[:40, record.sensors.index("w3")] = np.nan
    outcome = rga.run(
        model,
        replace(record.rows(slice(0, BEFORE)), readings=readings),
        tmp_path,
        settings=SETTINGS,
    )
    assert not outcome.findings.causes
    assert len(outcome.history.versions) == 1


@pytest.mark.parametrize("measured", ["always", "late", "never"])
def test_a_calibration_says_of_which_contexts_no_value_came(
    measured: str, sample: tuple[rga.Model, Record], tmp_path: Path
) -> None:
    record = sample[1]
    content = json.loads((SAMPLE / "model.json").read_text("utf-8"))
    content["context"]["rain"] = {"range": [0.0, 3.0], "unit": "kN/m"}
    rain = np.full(len(record), 0.5)
    if measured == "late":
        rain[: BEFORE // 2] = np.nan
    contexts = dict(record.contexts) | ({} if measured == "never" else {"rain": rain})
    some = replace(record, contexts=contexts).rows(slice(0, BEFORE))
    outcome = rga.run(read_model(content, "sample"), some, tmp_path, settings=SETTINGS)
    (calibration,) = words(outcome, "calibration")
    assert ("; all contexts are measured" in calibration) == (measured == "always")
    lacking = "contexts are measured, but no value came of rain"
    assert (lacking in calibration) == (measured != "always")
