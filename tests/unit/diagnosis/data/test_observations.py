"""Readings with what is believed of their contexts: priors, zeros, simulations kept."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate
from rga.diagnosis.data.observations import first_belief
from rga.diagnosis.data.tare import Tare
from rga.diagnosis.search.linearised import Problem
from rga.model import Model

TIME = 600.0 * np.arange(5)


def test_measured_contexts_have_their_noise_and_gaps_are_filled(model: Model) -> None:
    measured = {"temperature": np.array([0.0, np.nan, 2.0, np.nan, np.nan])}
    belief = first_belief(model, TIME, measured)
    assert belief.table["temperature"] == pytest.approx([0, 1, 2, 2, 2])
    assert belief.spread["temperature"] == 0.3
    assert belief.known == {"temperature", "west load", "east load"}
    assert belief.latent == {"west load", "east load"}
    assert belief.measured == ["temperature"]
    assert belief.inferred


def test_what_nothing_measured_may_lie_anywhere_in_its_range(model: Model) -> None:
    belief = first_belief(model, TIME, {})
    assert (belief.table["west load"] == 50.0).all()
    assert belief.spread["west load"] == pytest.approx(100 / np.sqrt(12))


def test_a_line_has_a_level_and_a_rate(model: Model) -> None:
    moving = model.context["west load"].model_copy(update={"law": "linear", "rate": (-0.2, 0.1)})
    other = model.model_copy(update={"context": {**model.context, "west load": moving}})
    belief = first_belief(other, TIME, {})
    assert belief.lines == {"west load": (50.0, 0.2)}
    assert "west load" not in belief.spread
    assert belief.passing == ("west load",)


def test_distance_is_in_prior_spreads_and_of_inferred_contexts_alone(model: Model) -> None:
    belief = first_belief(model, TIME, {"temperature": np.zeros(5)})
    spread = belief.spread["west load"]
    moved = belief.with_values({"west load": belief.table["west load"] + spread / 2})
    assert belief.distance(moved) == pytest.approx(0.5)
    warmer = belief.with_values({"temperature": np.full(5, 30.0)})
    assert belief.distance(warmer) == 0.0
    few = belief.rows(np.array([True, False, False, True, False]))
    assert few.table["time"].tolist() == [0.0, 1800.0]
    assert few.middle == 900.0


def test_what_a_zero_takes_off_is_missing_in_every_row(nothing_off: Problem) -> None:
    data = nothing_off.data
    rows, sensors = 4, len(data.sensors)
    contexts = {name: column[:rows] for name, column in data.belief.table.items()}
    tare = Tare(contexts, np.full((rows, sensors), 1 / rows), np.full(sensors, rows), rows)
    zeroed = replace(data, tare=tare)
    mean = nothing_off.simulated[:rows].mean(0)
    np.testing.assert_allclose(
        zeroed.predict(nothing_off.simulator), nothing_off.simulated - mean, atol=1e-9
    )
    shown, at_zero = zeroed.untared(nothing_off.simulator)
    np.testing.assert_allclose(shown, nothing_off.simulated, atol=1e-9)
    np.testing.assert_allclose(at_zero, nothing_off.simulated[:rows], atol=1e-9)
    np.testing.assert_allclose(zeroed.at_zero(nothing_off.simulator), at_zero, atol=1e-9)


def test_an_effect_changes_the_channels_that_it_touches(nothing_off: Problem) -> None:
    data = nothing_off.data
    about = data.about(nothing_off.simulator)
    assert data.about(nothing_off.simulator) is about
    bias = candidate(nothing_off, "sensor_bias", sensor="D3").effect([1.0])
    touched, change, at_zero = data.change(about, bias)
    assert touched.tolist() == [data.sensors.index("D3")]
    assert change[:, 0] == pytest.approx(np.full(len(data.time), 5.0))
    assert len(at_zero) == 0
    tried = data.tried(about, {"bias": bias})
    assert data.tried(about, {"bias": bias}) is tried
    np.testing.assert_allclose(tried[:, touched] - nothing_off.simulated[:, touched], change)


def test_rows_and_channels_that_are_left(nothing_off: Problem) -> None:
    data = nothing_off.data
    chosen = np.arange(len(data.time)) % 2 == 0
    few = data.rows(chosen)
    np.testing.assert_array_equal(few.readings, data.readings[chosen])
    np.testing.assert_array_equal(few.time, data.time[chosen])
    hidden = data.without({"D1"})
    assert not hidden.observed[:, 0].any()
    assert hidden.observed[:, 1:].all()
    assert data.observed.all()
