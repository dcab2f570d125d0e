"""Screening: scores are the evidence where a response is straight, and what is hidden is first."""

import numpy as np
import pytest

from known_problem import candidate, candidates, change_of, with_white_noise
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Prospect, Screening


def screened(problem: Problem) -> list[Prospect]:
    few = candidates(problem, "sensor_bias", "support_settlement")
    return Screening(problem, problem.simulator, few).first


def test_a_score_is_the_log_evidence(noisy: Problem) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    change = change_of(noisy, one, 0.02)
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    best = screened(problem)[0]
    assert best.hypothesis.same_place(one)
    assert best.hypothesis.onset is None
    exact = fit(problem, problem.simulator, [best.hypothesis], list(best.z))
    assert best.score == pytest.approx(exact.log_evidence, rel=1e-4)
    assert best.z == pytest.approx(exact.z, rel=1e-4)


def test_nothing_hidden_promises_nothing(noisy: Problem) -> None:
    assert max(one.score for one in screened(noisy)) < 3


def test_the_largest_is_d_prime_at_two_prior_deviations(nothing_off: Problem) -> None:
    one = candidate(nothing_off, "sensor_bias", sensor="D1")
    expected = np.linalg.norm(change_of(nothing_off, one, 2.0) / nothing_off.noise.sigma)
    (found,) = (p for p in screened(nothing_off) if p.hypothesis.same_place(one))
    assert found.largest == pytest.approx(expected, rel=1e-5)


def test_what_begins_late_is_reported_with_its_moment(noisy: Problem) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D3")
    change = change_of(noisy, one, 0.1)
    change[:60] = 0.0
    best = screened(with_white_noise(noisy, noisy.residual(noisy.simulated) + change))[0]
    assert best.hypothesis.name == "sensor_bias"
    assert best.hypothesis.place == one.place
    assert best.hypothesis.onset == noisy.data.time[60]


def test_what_is_taken_is_no_prospect_again(noisy: Problem) -> None:
    few = candidates(noisy, "sensor_bias")
    screening = Screening(noisy, noisy.simulator, few)
    again = screening.again(noisy, noisy.simulator, few[:2])
    assert len(again) == len(screening.first) - 2
    assert not any(p.hypothesis.same_place(one) for p in again for one in few[:2])


def test_of_prospects_alike_the_first_candidate_is_first(noisy: Problem) -> None:
    few = candidates(noisy, "sensor_bias")
    twins = [*few, *reversed(few)]
    found = [one.number for one in Screening(noisy, noisy.simulator, twins).first]
    last = len(twins) - 1
    assert found[::2] == [min(one, last - one) for one in found[::2]]
    assert found[1::2] == [last - one for one in found[::2]]


def test_far_behind_only_the_best_of_each_kind_is_ranked(
    noisy: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    kinds = ("sensor_bias", "sensor_gain", "member_stiffness")
    screening = Screening(noisy, noisy.simulator, candidates(noisy, *kinds))
    whole = screening.again(noisy, noisy.simulator, ())
    ranked = [one.number for one in screening.first]
    assert [one.number for one in whole][:20] == ranked[:20]
    monkeypatch.setattr("rga.diagnosis.search.screening.JUDGED", 2)
    monkeypatch.setattr("rga.diagnosis.search.screening.BEHIND", 3)
    few = screening.again(noisy, noisy.simulator, ())
    assert few[0] == whole[0]
    assert len(few) <= 5 + 3 * len(kinds)
    assert {one.hypothesis.name for one in few} == set(kinds)
    best = {kind: next(p for p in whole if p.hypothesis.name == kind) for kind in kinds}
    assert {one.number for one in best.values()} <= {one.number for one in few}
