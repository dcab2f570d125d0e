"""Faults of a logger and of contexts that no effect may explain: rows are left aside, and said."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.preparation.logger_faults import repeated_rows
from rga.diagnosis.preparation.prepare import PreparedRecord, prepare
from rga.findings.criteria.records import RecordCriteria
from rga.model import Model
from rga.records import Record

LIMITS = RecordCriteria()


@pytest.fixture
def record(model: Model, measured_record: Callable[..., Record]) -> Record:
    return measured_record(model)


def ready(model: Model, record: Record) -> PreparedRecord:
    return prepare(model, record, lambda done: None)


def test_a_memory_that_is_sent_again_is_left_aside(model: Model, record: Record) -> None:
    readings = record.readings.copy()
    readings[40:60] = readings[10:30]
    found = ready(model, replace(record, readings=readings))
    assert not found.data.observed[40:60].any()
    assert found.data.observed[:40].all()
    assert found.data.observed[60:].all()
    assert "in 20 rows, the first of them row 40, all channels read" in " ".join(found.doubts)


def test_a_logger_that_stands_still_is_left_aside(model: Model, record: Record) -> None:
    readings = record.readings.copy()
    readings[70:] = readings[69]
    found = ready(model, replace(record, readings=readings))
    assert found.data.observed[:70].all()
    assert found.data.observed.sum() == 70 * len(record.sensors)
    assert "all channels read to the last digit" in " ".join(found.doubts)


def test_few_rows_and_coarse_readings_may_repeat() -> None:
    readings = np.random.default_rng(0).normal(size=(60, 6))
    short = readings.copy()
    short[30 : 30 + LIMITS.repeated_rows - 1] = short[5 : 5 + LIMITS.repeated_rows - 1]
    assert not repeated_rows(short, LIMITS).any()
    coarse = np.round(np.cumsum(0.1 * readings, axis=0))
    coarse[30:45] = coarse[29]
    assert not repeated_rows(coarse, LIMITS).any()
    assert not repeated_rows(np.full((60, 6), np.nan), LIMITS).any()


def test_channels_that_end_are_said_and_many_of_them_are_a_doubt(
    model: Model, record: Record
) -> None:
    readings, many = record.readings.copy(), len(record.sensors) // 2
    readings[80:, :many] = np.nan
    found = ready(model, replace(record, readings=readings))
    assert f"{many} of {len(record.sensors)} channels have no reading" in " ".join(found.doubts)
    assert "the first from row 80" in " ".join(found.doubts)
    readings = record.readings.copy()
    readings[80:, 0] = np.nan
    found = ready(model, replace(record, readings=readings))
    assert found.doubts == []
    assert "from row 80: D1" in " ".join(found.warnings)


def test_a_context_in_another_unit_from_the_middle_on_is_no_context(
    model: Model, record: Record
) -> None:
    warmth = record.contexts["temperature"].copy()
    warmth[50:] += 273.15
    contexts = {**record.contexts, "temperature": warmth}
    found = ready(model, replace(record, contexts=contexts))
    assert not found.data.observed[50:].any()
    assert found.data.observed[:50].all()
    assert "temperature lies far outside its range" in " ".join(found.doubts)


def test_readings_of_one_unit_that_are_off_are_said_by_themselves(
    model: Model, record: Record
) -> None:
    moved = [model.sensors[name].unit == "mm" for name in record.sensors]
    assert 1 < sum(moved) < len(moved)
    readings = np.where(moved, 0.001 * record.readings, record.readings)
    said = " ".join(ready(model, replace(record, readings=readings)).warnings)
    assert "the readings in mm go with the simulation and are about 0.001 times as large" in said


def test_readings_of_one_unit_that_are_turned_round_are_said(model: Model, record: Record) -> None:
    strains = [model.sensors[name].unit == "microstrain" for name in record.sensors]
    readings = np.where(strains, -record.readings, record.readings)
    said = " ".join(ready(model, replace(record, readings=readings)).warnings)
    assert "the readings in microstrain go against the simulation: check the sign" in said
    assert "in mm go against" not in said
    assert "times as large" not in said
