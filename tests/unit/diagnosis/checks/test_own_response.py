"""A channel that answers the loads in a way of its own, beside causes of the structure."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, found_with
from rga.diagnosis.checks.own_response import FREE, own_response
from rga.diagnosis.preparation.prepare import PreparedRecord, prepare
from rga.diagnosis.search.linearised import Problem, pose
from rga.findings.criteria import Criteria
from rga.model import Model
from rga.records import Record
from rga.simulation import Simulator

CHANNEL = "S U1-U2"


@pytest.fixture(scope="module")
def exaggerated(model: Model, measured_record: Callable[..., Record]) -> Problem:
    """A record of which one channel reads 1.4 times as much as it should."""
    record = measured_record(model)
    readings = record.readings.copy()
    readings[:, record.sensors.index(CHANNEL)] *= 1.4
    data = prepare(model, replace(record, readings=readings), lambda done: None).data
    return pose(Simulator(model), data)


def test_a_channel_of_its_own_is_likelier_than_a_cause_bent_to_it(exaggerated: Problem) -> None:
    bent = candidate(exaggerated, "support_settlement", support="east", dof="uz")
    assert own_response(found_with(exaggerated, [bent])) == CHANNEL


def test_where_no_cause_of_the_structure_is_there_is_nothing_to_weigh(
    exaggerated: Problem, posed: Problem
) -> None:
    gain = candidate(exaggerated, "sensor_gain", sensor=CHANNEL)
    assert own_response(found_with(exaggerated, [gain])) is None
    assert own_response(found_with(posed, [])) is None


def test_a_sound_channel_is_none_beside_a_needless_cause(posed: Problem) -> None:
    """What is free is charged for."""
    needless = candidate(posed, "support_settlement", support="east", dof="uz")
    assert own_response(found_with(posed, [needless])) is None


def test_a_cause_that_many_channels_show_is_no_channel_of_its_own(
    model: Model, prepared: PreparedRecord
) -> None:
    data = prepared.data
    sunk = candidate(pose(Simulator(model), data), "support_settlement", support="east", dof="uz")
    change = data.predict(Simulator(model).extended({"low": sunk.effect([0.3])}))
    off = change - data.predict(Simulator(model))
    problem = pose(Simulator(model), replace(data, readings=data.readings + off))
    assert np.abs(off).max() > 0.1
    assert own_response(found_with(problem, [sunk])) is None


def log_likelihood(problem: Problem, spread: np.ndarray) -> float:
    """Of the readings about the simulation, with random effects of a spread, up to a constant."""
    covariance = problem.covariance.with_spread(spread)
    residual = problem.residual(problem.simulated)
    square = covariance.squares(covariance.reduce(residual.T[None]))[0]
    precision = covariance.information + np.diag(spread**-2.0)
    size = np.linalg.slogdet(precision)[1] + 2 * np.log(spread).sum()
    return float(-0.5 * (square + size))


@pytest.mark.parametrize(("short", "named"), [(0.1, CHANNEL), (-0.1, None)])
def test_a_channel_is_named_by_the_likelihood_that_its_free_response_gains(
    exaggerated: Problem, short: float, named: str | None
) -> None:
    """Less what it costs that it could be any channel, beside all kinds of causes."""
    bent = candidate(exaggerated, "support_settlement", support="east", dof="uz")
    spread, scatter = exaggerated.covariance.spread, exaggerated.scatter
    own = scatter.channel == exaggerated.data.sensors.index(CHANNEL)
    gained = log_likelihood(exaggerated, np.where(own, FREE, spread))
    gained -= log_likelihood(exaggerated, spread)
    odds = gained - np.log(2 * len(exaggerated.data.sensors) * bent.kinds)
    criteria = Criteria.model_validate({"naming": {"log_odds": odds - short}})
    judged = replace(exaggerated, data=replace(exaggerated.data, criteria=criteria))
    found = replace(found_with(exaggerated, [bent]), problem=judged)
    assert own_response(found) == named
