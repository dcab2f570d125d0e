"""Contexts in coarse steps: what they hide is no fault of the one channel that goes with them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rga.diagnosis import diagnose
from rga.model import Model, load_model
from rga.records import Record, load_record
from rga.samples import sample_files
from rga.simulation import Simulator

STEPS = {"people": 5.0, "air": 5.0}
#: the channel that alone goes with the warmth of the air
ALONE = "joint"


@pytest.fixture(scope="module")
def bridge(tmp_path_factory: pytest.TempPathFactory) -> tuple[Model, Record]:
    """The sample's footbridge, and a record in which nothing is hidden."""
    folder: Path = tmp_path_factory.mktemp("footbridge")
    for name, content in sample_files("footbridge").items():
        (folder / name).write_bytes(content)
    model = load_model(folder / "model.json")
    record = load_record(folder / "logger.csv", model)
    noise = np.array([model.sensors[name].noise for name in record.sensors], dtype=float)
    simulated = Simulator(model).predict({"time": record.time, **record.contexts})
    white = np.random.default_rng(3).standard_normal(simulated.shape)
    return model, replace(record, readings=simulated + noise * white)


def coarse(record: Record) -> Record:
    rounded = {name: step * np.round(record.contexts[name] / step) for name, step in STEPS.items()}
    return replace(record, contexts={**record.contexts, **rounded})


def test_a_channel_that_works_is_not_accused(bridge: tuple[Model, Record]) -> None:
    model, record = bridge
    findings = diagnose(model, coarse(record))
    assert findings.verdict != "named", findings.sentence()
    assert any("people as measured differs" in one for one in findings.warnings)


def test_one_that_does_not_work_is_named(bridge: tuple[Model, Record]) -> None:
    model, record = bridge
    readings = record.readings.copy()
    column = readings[:, record.sensors.index(ALONE)]
    column += 3.0 * column.std() * np.random.default_rng(4).standard_normal(len(column))
    findings = diagnose(model, replace(coarse(record), readings=readings))
    assert findings.verdict == "named"
    (cause,) = findings.causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_fault", ALONE)
