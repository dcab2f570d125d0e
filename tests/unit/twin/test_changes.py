"""What a change is diagnosed on: a corrected twin, its scatter, and its sensors."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from made_findings import cause, findings
from rga.findings.criteria import Criteria
from rga.inference import Joint, Rows, Unknowns
from rga.model import Model, read_model
from rga.records import Record
from rga.twin.calibration.correction import Correction
from rga.twin.changes import diagnose_change

ROWS, CALIBRATED = 40, 25


@pytest.fixture
def model(small_bridge: dict[str, Any]) -> Model:
    return read_model(small_bridge, "small bridge")


def calibrated(model: Model, gain: float, offset: float) -> Joint:
    """A calibration that found the structure as it is, and one sensor otherwise."""
    unknowns, sensors = Unknowns(model), len(model.sensors)
    gains, offsets = np.ones(sensors), np.zeros(sensors)
    gains[1], offsets[1] = gain, offset
    parameters = len(unknowns.centre) + 2 * sensors
    return Joint(
        unknowns=unknowns,
        values=unknowns.centre,
        gains=gains,
        offsets=offsets,
        independent=np.eye(parameters),
        pulled=np.zeros((sensors, parameters)),
        noise=np.ones(sensors),
        variance=np.ones(sensors),
        uncertainty=np.zeros((sensors, sensors)),
        rows=Rows(np.zeros((0, len(model.context))), np.zeros((0, sensors))),
        source=np.zeros((1, len(model.context))),
    )


def asked(
    model: Model, told: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> tuple[Record, list[tuple[Record, Record]]]:
    """The record, and records with calm rows that a change is diagnosed on."""
    found, sensors = calibrated(model, 1.05, 0.4), tuple(model.sensors)
    readings = np.random.default_rng(2).normal(20.0, 5.0, (ROWS, len(sensors)))
    record = Record(np.arange(ROWS, dtype=float), 0.0, "seconds", sensors, readings)
    given: list[tuple[Record, Record]] = []

    def diagnosed(corrected: Model, record: Record, *, calm: Record, **_: Any) -> Any:
        given.append((record, calm))
        return SimpleNamespace(
            causes=findings(cause(told)).causes, account=SimpleNamespace(extended=corrected)
        )

    monkeypatch.setattr("rga.twin.changes.diagnose", diagnosed)
    zero = dict.fromkeys(sensors, 3.0)
    late = diagnose_change(
        model,
        record,
        found,
        Correction.of(found, zero),
        since=float(CALIBRATED - 1),
        criteria=Criteria(),
        seed=0,
        progress=lambda stage, done: None,
    )
    assert late is None
    return record, given


def test_the_scatter_is_that_of_sensors_as_they_read(
    model: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    sensor = list(model.sensors)[1]
    later = {"kind": "sensor_bias", "sensor": sensor, "offset": 1.0, "onset": 30.0}
    record, ((sound, calm),) = asked(model, later, monkeypatch)
    others = np.arange(record.readings.shape[1]) != 1
    np.testing.assert_array_equal(calm.time, record.time[:CALIBRATED])
    np.testing.assert_allclose(calm.readings[:, others], record.readings[:CALIBRATED, others])
    np.testing.assert_allclose(calm.readings[:, 1], record.readings[:CALIBRATED, 1] - 0.4)
    np.testing.assert_allclose(sound.readings[:, others], record.readings[:, others])
    # The zero of the logger is read through the gain, and stays in the record.
    read = (record.readings[:, 1] - 0.4 + 3.0) / 1.05 - 3.0
    np.testing.assert_allclose(sound.readings[:, 1], read)


def test_a_sensor_that_was_corrected_wrongly_is_taken_as_it_reads(
    model: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, wrong, other, *_ = list(model.sensors)
    always = {"kind": "sensor_bias", "sensor": wrong, "offset": 1.0}
    record, given = asked(model, always, monkeypatch)
    (sound, calm), (again, as_before) = given
    assert not np.array_equal(sound.readings[:, 1], record.readings[:, 1])
    np.testing.assert_array_equal(again.readings[:, 1], record.readings[:, 1])
    np.testing.assert_array_equal(as_before.readings, calm.readings)
    # One that was not corrected is diagnosed once.
    _, given = asked(model, always | {"sensor": other}, monkeypatch)
    assert len(given) == 1
