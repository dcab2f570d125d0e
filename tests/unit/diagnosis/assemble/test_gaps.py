"""Gaps by hand: before and after, by sensor and by group."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.assemble.gaps import gap, groups
from rga.diagnosis.data.held_out import Gain
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.findings.arrays import DiagnosisArrays
from rga.model import Model, read_effect


@pytest.fixture
def arrays(model: Model, prepared: PreparedRecord) -> DiagnosisArrays:
    """Readings off by two deviations before, by one after; the last channel rejected."""
    readings = prepared.record.readings
    rows, sensors = readings.shape
    rejected = np.arange(sensors) == sensors - 1
    held_out = np.arange(rows) % 5 == 0
    one = np.ones_like(readings)
    sigma = np.linspace(0.5, 1.5, sensors)
    before = np.where(held_out[:, None], readings + 99, readings - 2 * sigma)
    return DiagnosisArrays(
        model, model, prepared.record, held_out, rejected, before, readings + sigma, sigma,
        one * sigma,
    )  # fmt: skip


def test_gaps_are_mean_squares_of_the_fitted_rows(arrays: DiagnosisArrays) -> None:
    found = gap(arrays, Gain(5.0, 2.0, (2.5, 3.5)))
    assert (found.before, found.after) == (pytest.approx(4.0), pytest.approx(1.0))
    assert (found.held_out.gain, found.held_out.gain_ci90) == (3.0, (2.5, 3.5))
    names = list(arrays.record.sensors)
    assert list(found.by_sensor) == names[:-1]
    assert found.by_sensor["D1"].before == pytest.approx(4.0)
    assert found.by_sensor["D1"].after == pytest.approx(1.0)


def test_a_channel_without_a_reading_has_no_gap(arrays: DiagnosisArrays) -> None:
    readings = arrays.record.readings.copy()
    readings[:, 0] = np.nan
    silent = replace(arrays, record=replace(arrays.record, readings=readings))
    assert "D1" not in gap(silent, Gain(1.0, 1.0, (0.0, 0.0))).by_sensor


def test_groups_are_off_by_percent(arrays: DiagnosisArrays) -> None:
    readings = arrays.record.readings
    scaled = replace(arrays, before=readings / 1.25, after=readings / 0.9)
    (group,) = groups(scaled, {"west": ["D1", "D2"]})
    assert group.sensors == ["D1", "D2"]
    assert group.before_percent == pytest.approx(25)
    assert group.after_percent == pytest.approx(-10)
    silent = replace(arrays, before=np.zeros_like(readings))
    assert groups(silent, {"west": ["D1"]})[0].before_percent == 0.0


def test_percents_of_a_late_cause_are_over_the_rows_from_its_onset_on(
    arrays: DiagnosisArrays,
) -> None:
    record, row = arrays.record, 30
    late = np.arange(len(record))[:, None] >= row
    begun = record.origin + float(record.time[row])
    bias = {"kind": "sensor_bias", "sensor": "D1", "offset": 1.0, "onset": begun}
    always = {name: one for name, one in bias.items() if name != "onset"}
    before = np.where(late, record.readings / 1.25, record.readings)
    other = arrays.model.extended({"cause": read_effect(bias, "test")})
    (told,) = groups(replace(arrays, extended=other, before=before), {"west": ["D1"]})
    assert told.before_percent == pytest.approx(25)
    assert told.since == record.time_label(float(record.time[row]))
    other = arrays.model.extended({"cause": read_effect(always, "test")})
    (told,) = groups(replace(arrays, extended=other, before=before), {"west": ["D1"]})
    assert 0 < told.before_percent < 25
    assert told.since is None
