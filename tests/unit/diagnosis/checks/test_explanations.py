"""Explanations: groups of channels, what is hidden of a record, and gaps on what was not fitted."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from known_problem import candidate, candidates, change_of, found_with, with_white_noise
from rga.diagnosis.checks.explanations import compare, hiding, on_unseen, sensor_groups, variance
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Screening
from rga.diagnosis.search.stepwise import settled
from rga.model import Model, read_model
from rga.records import Record
from rga.simulation import Simulator


def test_like_channels_are_grouped(model: Model) -> None:
    groups = sensor_groups(model, list(model.sensors))
    assert groups["displacement"] == ["D1", "D2", "D3", "DX"]
    assert groups["strain bottom chord"] == ["S L0-L1", "S L2-L3"]
    assert sorted(name for names in groups.values() for name in names) == sorted(model.sensors)
    own = model.sensors["D1"].model_copy(update={"groups": ["west half"]})
    named = model.model_copy(update={"sensors": {**model.sensors, "D1": own}})
    assert sensor_groups(named, list(named.sensors))["west half"] == ["D1"]


def test_a_hidden_channel_says_nothing(noisy: Problem) -> None:
    part = hiding(noisy, ["D1"])
    assert not part.data.observed[:, 0].any()
    assert part.data.observed[:, 1:].all()
    assert hiding(noisy, ["D1"]) is part
    for name, evidence in (("D1", 0.0), ("D2", 1.0)):
        one = candidate(noisy, "sensor_bias", sensor=name)
        slope = part.covariance.reduce(change_of(noisy, one, 1.0).T[None])
        assert bool(part.covariance.squares(slope)[0] > 1e-9) == bool(evidence)


def test_variance_is_that_of_noise_zero_and_contexts(posed: Problem) -> None:
    zeroed = replace(posed, zero_variance=np.full(len(posed.data.sensors), 2.0))
    jacobian, noise = posed.covariance.rows.context_jacobian, posed.noise
    contexts = np.einsum("tsk,k->ts", jacobian**2, noise.context_sigma**2)
    np.testing.assert_allclose(variance(zeroed), noise.deviation**2 + 2.0 + contexts)
    assert (contexts > 0).any()


def test_the_gap_on_what_was_not_fitted(noisy: Problem) -> None:
    """A settlement that is there predicts channels that were not fitted, and no other does."""
    base = noisy.simulator
    nothing = fit(noisy, base, [], [])
    residual = noisy.residual(noisy.simulated) / noisy.noise.sigma
    assert on_unseen(noisy, base, [nothing])[0].gap == pytest.approx((residual**2).mean())
    sunk = candidate(noisy, "support_settlement", support="east", dof="uz")
    off = noisy.residual(noisy.simulated)
    change = change_of(noisy, sunk, 0.2)
    true = with_white_noise(noisy, off + change)
    alone = np.zeros_like(change)
    alone[:, 0] = change[:, 0]
    false = with_white_noise(noisy, off + alone)
    # Two groups: fitted to the one, the settlement is told by what it does to the other.
    groups = {"D1": ["west"], "D2": ["east"], "D3": ["east"], "DX": ["east"]}
    sensors = {
        name: one.model_copy(update={"groups": groups.get(name, ["west"])})
        for name, one in base.model.sensors.items()
    }
    grouped = type(base)(base.model.model_copy(update={"sensors": sensors}))
    for problem, most in ((true, 1.2), (false, np.inf)):
        found = fit(problem, grouped, [sunk], [0.1])
        (gap, odds), (bare, none) = on_unseen(
            problem, grouped, [found, fit(problem, grouped, [], [])]
        )
        assert gap < most
        assert (gap < bare) == (problem is true)
        assert none == pytest.approx(0.0, abs=1e-9)
        assert (odds > 5.0) == (problem is true)


@pytest.fixture(scope="module")
def latent(
    small_bridge: dict[str, Any], model: Model, measured_record: Callable[..., Record]
) -> Problem:
    """A record with nothing wrong in which nothing but readings tells the loads."""
    record = measured_record(model)
    record = replace(record, contexts={"temperature": record.contexts["temperature"]})
    free = read_model(small_bridge, "small bridge")
    return settled(Simulator(free), prepare(free, record, lambda done: None).data)


def test_what_is_left_out_says_nothing_of_itself(latent: Problem) -> None:
    """Neither by the contexts that its own readings would show."""
    names = sensor_groups(latent.simulator.model, latent.data.sensors)["displacement"]
    columns = [latent.data.sensors.index(name) for name in names]
    readings = latent.data.readings.copy()
    readings[:, columns] += 10.0 * latent.noise.sigma[columns]
    moved = replace(latent, data=replace(latent.data, readings=readings))
    before, after = (
        one.with_contexts(one.simulated, hiding(one, names))[:, columns] for one in (latent, moved)
    )
    np.testing.assert_allclose(after, before, atol=1e-9)
    own = moved.with_contexts(moved.simulated) - latent.with_contexts(latent.simulated)
    assert np.abs(own[:, columns] / latent.noise.sigma[columns]).max() > 1.0


def test_a_faultless_model_predicts_channels_left_out_to_their_variance(latent: Problem) -> None:
    nothing = fit(latent, latent.simulator, [], [])
    (sound,) = on_unseen(latent, latent.simulator, [nothing])
    assert sound.gap == pytest.approx(1.0, abs=0.1)


def test_one_group_has_no_gap_on_others(noisy: Problem) -> None:
    model = noisy.simulator.model
    sensors = {k: one.model_copy(update={"groups": ["all"]}) for k, one in model.sensors.items()}
    base = type(noisy.simulator)(model.model_copy(update={"sensors": sensors}))
    assert np.isnan(on_unseen(noisy, base, [fit(noisy, base, [], [])])[0].gap)


def test_what_was_tried_begins_with_nothing_and_ends_with_free_gains(noisy: Problem) -> None:
    bias = candidate(noisy, "sensor_bias", sensor="D1")
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change_of(noisy, bias, 0.1))
    few = candidates(problem, "sensor_bias", "sensor_gain", "support_settlement")
    prospects = Screening(problem, problem.simulator, few).first
    done: list[float] = []
    tried = compare(found_with(problem, [bias]), prospects, done.append)
    assert tried[0].fit is not None
    assert tried[0].fit.hypotheses == ()
    assert tried[-1].fit is None
    named = [[one.name for one in t.fit.hypotheses] for t in tried[:-1] if t.fit]
    assert ["sensor_bias"] in named
    assert ["support_settlement"] in named
    assert len({str(one) for one in named}) > 2
    best = min(tried[:-1], key=lambda one: one.gap)
    assert best.fit is not None
    assert "sensor_bias" in [one.name for one in best.fit.hypotheses]
    assert best.gap == pytest.approx(1.0, abs=0.15)
    assert tried[-1].gap <= tried[0].gap
    assert done == sorted(done)
