"""Tails of the noise at the end of a record, beside a shift there."""

import tempfile
from dataclasses import replace
from pathlib import Path

import pytest

from rga.diagnosis import diagnose
from rga.findings import Findings
from rga.model import load_model
from rga.records import load_record
from rga_bench.diagnosis.design import Draw

#: a null twin with heavy tails, a channel of it, and how late and how far it is shifted
NULL, CHANNEL, LATE, SHIFT = "101-single-22-null", 1, 20, 4.0


def diagnosed(shifted: bool) -> tuple[str, float, Findings]:
    """Channel, moment, and findings of the record with or without the shift."""
    with tempfile.TemporaryDirectory() as folder:
        Draw.parse(NULL).case().write(folder)
        model = load_model(Path(folder) / "model.json")
        record = load_record(Path(folder) / "record.csv", model)
    sensor = record.sensors[CHANNEL]
    readings = record.readings.copy()
    readings[-LATE:, CHANNEL] += SHIFT * (model.sensors[sensor].noise or 0.0) * shifted
    moment = float(record.origin + record.time[-LATE])
    return sensor, moment, diagnose(model, replace(record, readings=readings))


def test_tails_at_the_end_of_a_record_are_no_cause() -> None:
    assert Draw.parse(NULL).circumstance.null == "Student t3"
    *_, findings = diagnosed(shifted=False)
    assert findings.verdict == "nothing_wrong"


def test_a_late_shift_is_found_in_spite_of_tails() -> None:
    sensor, moment, findings = diagnosed(shifted=True)
    (cause,) = findings.causes
    assert cause.effect["kind"] == "sensor_bias"
    assert cause.effect["sensor"] == sensor
    assert cause.onset == pytest.approx(moment)


def test_one_reading_under_a_rare_load_is_no_cause(tmp_path: Path) -> None:
    # One reading is fifteen times the noise away, at one of the few rows of a load near the end.
    Draw.parse("2033-single-58-null").case().write(str(tmp_path))
    model = load_model(tmp_path / "model.json")
    record = load_record(tmp_path / "record.csv", model)
    assert diagnose(model, record).verdict == "nothing_wrong"
    readings = record.readings.copy()
    readings[-40:, record.sensors.index("N-e03")] *= 0.5
    (cause,) = diagnose(model, replace(record, readings=readings)).causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_gain", "N-e03")
