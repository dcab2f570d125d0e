"""Causes as effects of a model file: estimates, intervals, onsets, dead channels."""

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.assemble.effects import (
    cause_name,
    content,
    effects_of,
    estimated_effects,
    fault_effect,
    last_effect,
)
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.search.linearised import Problem
from rga.model import Model, read_effect

HALF_WIDTH = 1.6448536269514722


def off_by(noisy: Problem, kind: str, z: float, **place: str) -> Problem:
    change = change_of(noisy, candidate(noisy, kind, **place), z)
    return with_white_noise(noisy, noisy.residual(noisy.simulated) + change)


def test_an_estimate_has_the_interval_of_its_spread(
    noisy: Problem, prepared: PreparedRecord
) -> None:
    problem = off_by(noisy, "sensor_bias", 0.1, sensor="D1")
    found = found_with(problem, [candidate(noisy, "sensor_bias", sensor="D1")])
    (effect,) = estimated_effects(found.fit, prepared.record)
    written = content(effect)
    scale = 5.0
    half = HALF_WIDTH * scale * found.fit.spreads()[0]
    value = scale * found.fit.z[0]
    assert written["kind"] == "sensor_bias"
    assert written["sensor"] == "D1"
    assert written["offset"]["value"] == pytest.approx(value)
    assert written["offset"]["ci90"] == pytest.approx([value - half, value + half])
    assert "onset" not in written


def test_a_late_effect_has_its_onset_and_profile(noisy: Problem, prepared: PreparedRecord) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    moment, end = (float(noisy.data.time[row]) for row in (40, 70))
    found = found_with(noisy, [one.beginning(moment, "ramp", end)])
    written = last_effect(found.fit, prepared.record)
    label = prepared.record.time_label
    origin = prepared.record.origin
    assert written["onset"] == label(moment - origin)
    assert (written["profile"], written["end"]) == ("ramp", label(end - origin))


@pytest.mark.parametrize(("factor", "kind"), [(0.0, "sensor_fault"), (0.7, "sensor_gain")])
def test_a_gain_of_nothing_is_a_dead_channel(
    noisy: Problem, prepared: PreparedRecord, factor: float, kind: str
) -> None:
    gain = candidate(noisy, "sensor_gain", sensor="D1")
    problem = off_by(noisy, "sensor_gain", gain.priors["factor"].z(factor), sensor="D1")
    (effect,) = effects_of(found_with(problem, [gain]), prepared.record)
    assert effect.kind == kind
    assert effect.place["sensor"] == "D1"


def test_a_broken_channel_is_a_fault_from_its_row_on(prepared: PreparedRecord) -> None:
    always = fault_effect(BrokenChannel("D1", "stuck", "it is still", 9), prepared.record)
    assert content(always) == {"kind": "sensor_fault", "sensor": "D1", "mode": "stuck"}
    late = fault_effect(BrokenChannel("D1", "dead", "it reads 0", 9, 25), prepared.record)
    assert late.onset == prepared.record.time_label(float(prepared.record.time[25]))


def test_a_cause_has_a_name_that_is_new(model: Model) -> None:
    low = {"kind": "support_settlement", "support": "east", "dof": "uz", "displacement": -0.01}
    effect = read_effect(low, "test")
    assert cause_name(model, effect) == "support settlement east uz"
    taken = model.extended({"support settlement east uz": effect})
    assert cause_name(taken, effect) == "support settlement east uz (found)"
    assert np.isfinite(content(effect)["displacement"])


@pytest.mark.parametrize(("until", "kind"), [(None, "sensor_drift"), (70, "sensor_bias")])
def test_an_offset_that_grows_to_the_last_row_is_a_drift(
    noisy: Problem, prepared: PreparedRecord, until: int | None, kind: str
) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    time = noisy.data.time
    end = None if until is None else float(time[until])
    found = found_with(noisy, [one.beginning(float(time[40]), "ramp", end)])
    (bias,) = estimated_effects(found.fit, prepared.record)
    (effect,) = effects_of(found, prepared.record)
    assert (effect.kind, effect.onset) == (kind, bias.onset)
    if until is None:
        last = prepared.record.origin + prepared.record.time[-1]
        days = (last - time[40]) / 86400
        reached = content(effect)["rate"]["value"] * days
        assert reached == pytest.approx(content(bias)["offset"]["value"])
