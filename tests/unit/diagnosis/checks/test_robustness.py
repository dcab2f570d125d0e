"""Causes where noise is not what it is taken for: leads that hang on a channel, unseen channels."""

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.checks.explanations import OnUnseen
from rga.diagnosis.checks.robustness import (
    with_better_prediction,
    with_hanging_leads,
    without_unhelpful,
)
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Fit
from rga.diagnosis.search.linearised import Problem
from rga.simulation import Simulator


@pytest.fixture
def east(noisy: Problem) -> Hypothesis:
    return candidate(noisy, "support_settlement", support="east", dof="uz")


@pytest.fixture
def west(noisy: Problem) -> Hypothesis:
    return candidate(noisy, "support_settlement", support="west", dof="uz")


def of_channels(noisy: Problem, change: np.ndarray, *channels: str) -> Problem:
    shown = np.array([name in channels for name in noisy.data.sensors])
    return with_white_noise(noisy, noisy.residual(noisy.simulated) + change * shown)


def nothing(done: float) -> None:
    pass


def test_a_lead_that_hangs_on_one_channel_is_taken_without_it(
    nothing_off: Problem, east: Hypothesis, west: Hypothesis
) -> None:
    """All channels show half of either settlement, and one a little more of the one."""
    half = (change_of(nothing_off, east, 0.1) + change_of(nothing_off, west, 0.1)) / 2
    half[:, 2] *= 1.03
    problem = with_white_noise(nothing_off, half)
    found = found_with(problem, [east], [west])
    before = found.alternatives[0][0].behind
    after = with_hanging_leads(found, nothing).alternatives[0][0].behind
    assert after < 0 < before


def test_a_lead_that_many_channels_bear_stays(
    noisy: Problem, east: Hypothesis, west: Hypothesis
) -> None:
    problem = of_channels(noisy, change_of(noisy, east, 0.3), "D1", "D2", "D3")
    found = found_with(problem, [east], [west])
    assert found.alternatives[0][0].behind > 1000
    assert with_hanging_leads(found, nothing) is found


def predicting(
    monkeypatch: pytest.MonkeyPatch, told: dict[frozenset[str], OnUnseen]
) -> dict[frozenset[str], OnUnseen]:
    """What unseen channels say, by the supports whose settlements are in a fit."""

    def of_fits(problem: Problem, base: Simulator, fits: list[Fit]) -> list[OnUnseen]:
        return [told[frozenset(str(h.place["support"]) for h in one.hypotheses)] for one in fits]

    monkeypatch.setattr("rga.diagnosis.checks.robustness.on_unseen", of_fits)
    return told


def test_the_cause_without_which_unseen_channels_are_best_predicted_goes(
    noisy: Problem, east: Hypothesis, west: Hypothesis, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = found_with(noisy, [east, west])
    both, one, other = (frozenset(names) for names in (("east", "west"), ("east",), ("west",)))
    odds = {both: 10.0, one: 12.0, other: 11.0}
    told = predicting(monkeypatch, {names: OnUnseen(1.0, each) for names, each in odds.items()})
    (kept,) = without_unhelpful(noisy, found.base, found.fit).hypotheses
    assert kept.place["support"] == "east"
    told[both] = OnUnseen(1.0, 12.5)
    assert without_unhelpful(noisy, found.base, found.fit) is found.fit


def test_a_close_rival_that_predicts_unseen_channels_takes_the_place(
    noisy: Problem, east: Hypothesis, west: Hypothesis, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = found_with(noisy, [east], [west])
    rival = found.alternatives[0][0]
    assert abs(rival.behind) < 3
    east_alone, west_alone = frozenset({"east"}), frozenset({"west"})
    told = predicting(monkeypatch, {east_alone: OnUnseen(2.0, 5.0), west_alone: OnUnseen(0.5, 6.0)})
    other = with_better_prediction(found)
    assert other.fit is rival.fit
    (former,) = other.alternatives[0]
    assert former.hypothesis is east
    assert former.behind == pytest.approx(-rival.behind, abs=1e-6)
    assert other.log_odds[0] == pytest.approx(found.log_odds[0] - rival.behind, abs=1e-6)
    # Half the gap by saying little is no better prediction.
    for said in (OnUnseen(1.8, 6.0), OnUnseen(0.5, 4.0)):
        told[west_alone] = said
        assert with_better_prediction(found) is found


def test_a_rival_far_behind_stays_one_whatever_it_predicts(
    noisy: Problem, east: Hypothesis, west: Hypothesis, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = of_channels(noisy, change_of(noisy, east, 0.3), "D1", "D2", "D3")
    told = {frozenset({"east"}): OnUnseen(2.0, 5.0), frozenset({"west"}): OnUnseen(0.1, 50.0)}
    predicting(monkeypatch, told)
    found = found_with(problem, [east], [west])
    assert with_better_prediction(found) is found
