"""Loggers that start from zeros of their own, or are zeroed again: reported, and put right."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.preparation.zeros.undeclared_zeros import OwnZeros, with_own_zeros
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
) -> Callable[..., OwnZeros]:
    """The record off by so much; of causes those of one kind, as few channels tell all apart."""
    record = measured_record(model)

    def of(off: np.ndarray, kind: str = "support_settlement") -> OwnZeros:
        def of_kind(*arguments: Any) -> list[Hypothesis]:
            return [one for one in hypotheses(*arguments) if one.name == kind]

        monkeypatch.setattr("rga.diagnosis.preparation.zeros.levels.hypotheses", of_kind)
        readings = record.readings + off
        data: Data = replace(prepared.data, readings=readings)
        return with_own_zeros(model, Simulator(model), replace(record, readings=readings), data)

    return of


def test_a_sound_record_is_left_alone(zeroed: Callable[..., OwnZeros], model: Model) -> None:
    found = zeroed(np.zeros(len(model.sensors)))
    assert found.warnings == found.doubts == []
    assert found.record.zero is None


def test_offsets_of_all_channels_are_zeros_of_their_own(
    zeroed: Callable[..., OwnZeros], model: Model
) -> None:
    noise = np.array([sensor.noise for sensor in model.sensors.values()])
    off = 60 * noise * np.random.default_rng(3).standard_normal(len(noise))
    found = zeroed(off)
    record, warnings = found.record, found.warnings
    assert found.doubts == []
    assert "zeros of their own" in warnings[0]
    np.testing.assert_allclose(record.readings.mean(0), 0.0, atol=1e-9)
    assert record.zero == (record.time[0], record.time[-1])


def test_an_offset_of_one_channel_is_left_to_the_search(
    zeroed: Callable[..., OwnZeros], model: Model
) -> None:
    off = np.zeros(len(model.sensors))
    off[0] = 5.0
    assert zeroed(off).warnings == zeroed(off).doubts == []


def made_by(model: Model, *causes: dict[str, Any]) -> np.ndarray:
    """What causes do to all channels under loads that rest, float[sensors]."""
    contexts = {"time": np.zeros(1), **{name: np.full(1, 20.0) for name in model.context}}
    effects = {f"cause {k}": read_effect(one, "test") for k, one in enumerate(causes)}
    off = Simulator(model.extended(effects)).predict(contexts) - Simulator(model).predict(contexts)
    return np.asarray(off[0])


def test_what_a_settlement_does_to_all_channels_is_no_zero(
    zeroed: Callable[..., OwnZeros], model: Model
) -> None:
    low = {"kind": "support_settlement", "support": "east", "dof": "uz", "displacement": -0.01}
    off = made_by(model, low)
    assert np.abs(off).max() > 1
    assert zeroed(off).warnings == zeroed(off).doubts == []


@pytest.mark.parametrize(("kind", "warnings"), [("dead_load", 0), ("support_settlement", 1)])
def test_what_two_loads_that_are_much_alike_do_together_is_no_zero(
    zeroed: Callable[..., OwnZeros], model: Model, kind: str, warnings: int
) -> None:
    """They take most of each other off, and what is left resembles neither of them."""
    loads = {"bottom chord": 100e3, "top chord": -140e3}
    off = made_by(
        model,
        *(
            {"kind": "dead_load", "group": group, "force_per_length": size}
            for group, size in loads.items()
        ),
    )
    assert len(zeroed(off, kind).warnings) == warnings


@pytest.mark.parametrize(("zero", "warnings"), [(0.0, 0), (100.0, 1)])
def test_a_load_that_is_greater_than_was_measured_is_no_zero(
    model: Model,
    prepared: PreparedRecord,
    measured_record: Callable[..., Record],
    monkeypatch: pytest.MonkeyPatch,
    zero: float,
    warnings: int,
) -> None:
    """Its responses have a mean, and follow the load: here one that grows without any noise."""
    monkeypatch.setattr("rga.diagnosis.preparation.zeros.levels.hypotheses", lambda *of: [])
    simulator, belief = Simulator(model), prepared.data.belief
    load = np.sort(belief.table["west load"])
    data = replace(prepared.data, belief=belief.with_values({"west load": load}))
    readings = data.predict(simulator, {"west load": 3 * load}) + zero
    record = replace(measured_record(model), readings=readings)
    found = with_own_zeros(model, simulator, record, replace(data, readings=readings))
    assert len(found.warnings) == warnings


def test_a_logger_that_is_zeroed_again_keeps_its_longer_part(
    zeroed: Callable[..., OwnZeros], model: Model, prepared: PreparedRecord
) -> None:
    row = 30
    shown = prepared.data.readings[row]
    off = np.where(np.arange(len(prepared.data.readings))[:, None] >= row, -shown, 0.0)
    found = zeroed(off)
    record, warnings = found.record, found.warnings
    assert found.doubts == []
    assert "zeroed anew" in warnings[0]
    assert "after" in warnings[0]
    missing = np.isnan(record.readings).all(1)
    assert missing[:25].all()
    assert not missing[35:].any()


@pytest.mark.parametrize(("doubted", "warnings"), [(True, 0), (False, 1)])
def test_channels_in_another_unit_say_nothing_of_a_zero(
    model: Model,
    prepared: PreparedRecord,
    measured_record: Callable[..., Record],
    monkeypatch: pytest.MonkeyPatch,
    doubted: bool,
    warnings: int,
) -> None:
    """They read next to nothing of a load that comes, as if they had been set to zero there."""
    monkeypatch.setattr("rga.diagnosis.preparation.zeros.levels.hypotheses", lambda *of: [])
    if not doubted:
        none = np.zeros(len(model.sensors), dtype=bool)
        monkeypatch.setattr(
            "rga.diagnosis.preparation.zeros.levels.doubted_units", lambda *of: none
        )
    simulator, rows = Simulator(model), len(prepared.data.readings)
    load = np.where(np.arange(rows) < 40, 0.0, 100.0) + np.random.default_rng(6).normal(0, 3, rows)
    still = {name: np.full(rows, 20.0) for name in model.context} | {"west load": load}
    data = replace(prepared.data, belief=prepared.data.belief.with_values(still))
    noise = prepared.data.readings - prepared.data.predict(simulator)
    readings = 1e-3 * (data.predict(simulator) + noise)
    record = replace(measured_record(model), readings=readings)
    found = with_own_zeros(model, simulator, record, replace(data, readings=readings))
    assert sum("zeroed anew" in one for one in found.warnings) == warnings
