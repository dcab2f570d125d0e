"""Causes as findings hold them: status, sizes, rivals, intervals of onsets, what shows them."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.assemble.causes import causes, fault_cause, rivals_of
from rga.diagnosis.assemble.effects import effects_of, fault_effect
from rga.diagnosis.preparation.prepare import PreparedRecord
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found
from rga.findings.schema import Cause


@pytest.fixture(autouse=True)
def no_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    """What would separate a cause from its rival is a test of its own."""

    class Silent:
        def __init__(self, *arguments: object) -> None:
            pass

        def against(self, rival: object) -> str:
            return "measure it"

    monkeypatch.setattr("rga.diagnosis.assemble.causes.Advice", Silent)


def reported(found: Found, prepared: PreparedRecord) -> Cause:
    warnings: list[str] = []
    effects = effects_of(found, prepared.record)
    (cause,) = causes(found, effects, prepared.record, warnings)
    assert warnings == []
    return cause


def settled(noisy: Problem, z: float = 0.2, first: int = 0) -> Problem:
    change = change_of(noisy, candidate(noisy, "support_settlement", support="east"), z)
    change[:first] = 0.0
    return with_white_noise(noisy, noisy.residual(noisy.simulated) + change)


def test_sizes_of_a_cause_are_those_of_its_change(noisy: Problem, prepared: PreparedRecord) -> None:
    problem = settled(noisy)
    sunk = candidate(noisy, "support_settlement", support="east")
    bias = candidate(noisy, "sensor_bias", sensor="D3")
    cause = reported(found_with(problem, [sunk], [bias]), prepared)
    found = found_with(problem, [sunk], [bias])
    sigma = problem.noise.sigma
    own = (found.fit.simulated - noisy.simulated) / sigma
    other = (found.alternatives[0][0].fit.simulated - noisy.simulated) / sigma
    assert cause.d_prime == pytest.approx(np.sqrt((own**2).sum()))
    rest = (own**2).sum() - (own * other).sum() ** 2 / (other**2).sum()
    assert cause.d_perp == pytest.approx(np.sqrt(rest))
    assert cause.log_odds == found.log_odds[0]
    assert cause.status == "named"
    assert cause.rivals == []
    behind = found.alternatives[0][0].behind
    assert cause.separated_by.endswith(
        f": measure it; this record tells them apart by {behind:.0f} log-odds"
    )
    assert "D3" in cause.why.split(",")[0]
    alone = reported(found_with(problem, [sunk]), prepared)
    assert alone.d_perp == alone.d_prime
    assert alone.separated_by == ""


def test_rivals_begin_with_the_nearest_of_each_other_kind(noisy: Problem) -> None:
    sunk = candidate(noisy, "support_settlement", support="east")
    places = [candidate(noisy, "sensor_bias", sensor=name) for name in ("D1", "D2", "D3")]
    west = candidate(noisy, "support_settlement", support="west", dof="uz")
    found = found_with(noisy, [sunk], [*places, west])
    by_place = {str(one.hypothesis.place): one for one in found.alternatives[0]}
    ranked = [
        replace(by_place[str(one.place)], behind=behind)
        for one, behind in ((west, 0.1), (places[1], 0.5), (places[0], 0.9), (places[2], 30.0))
    ]
    found = replace(found, alternatives=(tuple(ranked),))
    order = [one.behind for one in rivals_of(found, 0)]
    assert order == [0.5, 0.1, 0.9]


def test_a_cause_with_a_rival_is_ambiguous(noisy: Problem, prepared: PreparedRecord) -> None:
    sunk = candidate(noisy, "support_settlement", support="east")
    found = found_with(settled(noisy), [sunk], [candidate(noisy, "sensor_bias", sensor="D3")])
    (ranked,) = found.alternatives
    close = replace(found, alternatives=((replace(ranked[0], behind=0.4),),))
    cause = reported(close, prepared)
    assert cause.status == "ambiguous"
    assert [one["kind"] for one in cause.rivals] == ["sensor_bias"]
    assert cause.rivals_omitted == 0


def test_an_onset_has_an_interval_that_holds_it(noisy: Problem, prepared: PreparedRecord) -> None:
    sunk = candidate(noisy, "support_settlement", support="east")
    moment = float(noisy.data.time[45])
    cause = reported(found_with(settled(noisy, 0.2, 45), [sunk.beginning(moment)]), prepared)
    assert cause.onset_ci90 is not None
    first, last = map(float, cause.onset_ci90)
    at = moment - prepared.record.origin
    assert first <= at <= last
    assert last - first <= 5 * 600.0


def test_a_fault_has_odds_by_its_odd_readings(prepared: PreparedRecord) -> None:
    fault = BrokenChannel("D1", "stuck", "it is still", 7)
    cause = fault_cause(fault, fault_effect(fault, prepared.record))
    assert cause.log_odds == pytest.approx(7 * np.log(1000))
    assert cause.d_prime == cause.d_perp == pytest.approx(np.sqrt(2 * cause.log_odds))
    assert (cause.status, cause.why) == ("named", "it is still")
