"""Loggers that start from zeros of their own, or are zeroed again: told, and put right."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.preparation.undeclared_zeros import with_own_zeros
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.model import Model, read_effect
from rga.records import Record
from rga.simulation import Simulator


@pytest.fixture
def zeroed(
    model: Model,
    prepared: PreparedRecord,
    measured_record: Callable[..., Record],
    monkeypatch: pytest.MonkeyPatch,
) -> Callable[[np.ndarray], tuple[Record, list[str]]]:
    """The record off by so much; of causes settlements alone, as few channels tell all apart."""
    record = measured_record(model)

    def settlements(*arguments: Any) -> list[Hypothesis]:
        return [one for one in hypotheses(*arguments) if one.name == "support_settlement"]

    monkeypatch.setattr("rga.diagnosis.preparation.undeclared_zeros.hypotheses", settlements)

    def of(off: np.ndarray) -> tuple[Record, list[str]]:
        readings = record.readings + off
        data: Data = replace(prepared.data, readings=readings)
        return with_own_zeros(model, Simulator(model), replace(record, readings=readings), data)

    return of


def test_a_sound_record_is_left_alone(
    zeroed: Callable[[np.ndarray], tuple[Record, list[str]]], model: Model
) -> None:
    record, told = zeroed(np.zeros(len(model.sensors)))
    assert told == []
    assert record.zero is None


def test_offsets_of_all_channels_are_zeros_of_their_own(
    zeroed: Callable[[np.ndarray], tuple[Record, list[str]]], model: Model
) -> None:
    noise = np.array([sensor.noise for sensor in model.sensors.values()])
    off = 60 * noise * np.random.default_rng(3).standard_normal(len(noise))
    record, told = zeroed(off)
    assert "zeros of their own" in told[0]
    np.testing.assert_allclose(record.readings.mean(0), 0.0, atol=1e-9)
    assert record.zero == (record.time[0], record.time[-1])


def test_an_offset_of_one_channel_is_left_to_the_search(
    zeroed: Callable[[np.ndarray], tuple[Record, list[str]]], model: Model
) -> None:
    off = np.zeros(len(model.sensors))
    off[0] = 5.0
    assert zeroed(off)[1] == []


def test_what_a_settlement_does_to_all_channels_is_no_zero(
    zeroed: Callable[[np.ndarray], tuple[Record, list[str]]], model: Model
) -> None:
    low = {"kind": "support_settlement", "support": "east", "dof": "uz", "displacement": -0.01}
    contexts = {"time": np.zeros(1), **{name: np.full(1, 20.0) for name in model.context}}
    sunk = model.extended({"low": read_effect(low, "test")})
    off = Simulator(sunk).predict(contexts) - Simulator(model).predict(contexts)
    assert np.abs(off).max() > 1
    assert zeroed(off[0])[1] == []


def test_a_logger_that_is_zeroed_again_keeps_its_longer_part(
    zeroed: Callable[[np.ndarray], tuple[Record, list[str]]], model: Model, prepared: PreparedRecord
) -> None:
    row = 30
    shown = prepared.data.readings[row]
    off = np.where(np.arange(len(prepared.data.readings))[:, None] >= row, -shown, 0.0)
    record, told = zeroed(off)
    assert "zeroed anew" in told[0]
    assert "after" in told[0]
    missing = np.isnan(record.readings).all(1)
    assert missing[:25].all()
    assert not missing[35:].any()
