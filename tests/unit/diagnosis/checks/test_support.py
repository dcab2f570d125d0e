"""Causes that nothing speaks for but the readings fitted are taken out; others stay."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.checks.explanations import groups_left_out, on_unseen
from rga.diagnosis.checks.support import gaps_left_out, supported, worsens
from rga.diagnosis.checks.whole_record import WholeRecord
from rga.diagnosis.data.held_out import held_out_rows
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found

Split = tuple[Problem, WholeRecord]


@pytest.fixture
def sunk(noisy: Problem) -> Hypothesis:
    return candidate(noisy, "support_settlement", support="east", dof="uz")


@pytest.fixture
def split(noisy: Problem) -> Callable[[np.ndarray, np.ndarray], Split]:
    """A record off by one thing on the rows that are fitted, by another on those held out."""
    held_out = held_out_rows(len(noisy.data.time))
    noise = noisy.residual(noisy.simulated)

    def of(fitted: np.ndarray, unseen: np.ndarray) -> Split:
        off = noise + np.where(held_out[:, None], unseen, fitted)
        whole = with_white_noise(noisy, off)
        few = with_white_noise_of_rows(whole, ~held_out)
        return few, WholeRecord.of(whole.data, held_out, few)

    return of


def with_white_noise_of_rows(problem: Problem, rows: np.ndarray) -> Problem:
    off = problem.residual(problem.simulated)[rows]
    data = problem.data.rows(rows)
    return with_white_noise(replace(problem, data=data), off)


def as_it_is(found: Found) -> Found:
    return found


def test_a_cause_that_held_out_rows_confirm_stays(
    split: Callable[[np.ndarray, np.ndarray], Split], noisy: Problem, sunk: Hypothesis
) -> None:
    change = change_of(noisy, sunk, 0.2)
    problem, whole = split(change, change)
    found = found_with(problem, [sunk])
    kept, dropped = supported(found, problem, whole, 0, as_it_is)
    assert kept is found
    assert dropped == []


def test_a_cause_that_held_out_rows_deny_goes(
    split: Callable[[np.ndarray, np.ndarray], Split], noisy: Problem, sunk: Hypothesis
) -> None:
    change = change_of(noisy, sunk, 0.2)
    problem, whole = split(change, -change)
    kept, dropped = supported(found_with(problem, [sunk]), problem, whole, 0, as_it_is)
    assert kept.fit.hypotheses == ()
    assert [one.name for one in dropped] == ["support_settlement"]


def test_channels_that_get_worse_by_a_cause(noisy: Problem, sunk: Hypothesis) -> None:
    change = change_of(noisy, sunk, 0.2)
    true = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    found = found_with(true, [sunk])
    assert not worsens(found, fit(true, true.simulator, [], []))
    assert not worsens(found, found.fit)


@pytest.mark.parametrize(
    ("odds", "worse"), [((5.0, -4.0), True), ((5.0, -6.0), False), ((4.0, 1.0), False)]
)
def test_channels_get_worse_where_one_group_speaks_up_and_no_others_outweigh_it(
    noisy: Problem,
    sunk: Hypothesis,
    monkeypatch: pytest.MonkeyPatch,
    odds: tuple[float, ...],
    worse: bool,
) -> None:
    found = found_with(noisy, [sunk])
    told = [([name], one) for name, one in zip(noisy.data.sensors, odds, strict=False)]
    monkeypatch.setattr("rga.diagnosis.checks.support._against", lambda *_: iter(told))
    assert worsens(found, fit(noisy, noisy.simulator, [], [])) == worse


def test_what_others_do_not_know_of_a_cause_is_not_known(noisy: Problem, sunk: Hypothesis) -> None:
    """The others put its parameter elsewhere, and leave it open: the group is no worse by it."""
    sigma, gauge = noisy.noise.sigma, noisy.data.sensors.index("S L0-L1")
    off = noisy.residual(noisy.simulated) + change_of(noisy, sunk, 0.2)
    off[:, gauge] -= 0.15 * sigma[gauge]
    found = found_with(with_white_noise(noisy, off), [sunk])
    signatures = found.fit.signatures.copy()
    signatures[0, gauge] = 0.1 * sigma[gauge]
    found = replace(found, fit=replace(found.fit, signatures=signatures))
    without = fit(found.problem, noisy.simulator, [], [])
    before, after = on_unseen(found.problem, noisy.simulator, [without, found.fit])
    assert after.gap < before.gap
    assert gaps_left_out(found) is None


def test_groups_that_speak_against_a_cause(
    noisy: Problem, sunk: Hypothesis, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others do not count: a group that a cause leaves alone would dilute what one says."""
    found = found_with(noisy, [sunk])
    first, *others = groups_left_out(noisy.simulator.model, noisy.data.sensors)
    odds = [5.0, *(1e-12 for _ in others)]
    told = list(zip([first, *others], odds, strict=True))
    monkeypatch.setattr("rga.diagnosis.checks.support._against", lambda *_: iter(told))
    without = fit(noisy, noisy.simulator, [], [])
    assert gaps_left_out(found) == tuple(
        one.gap for one in on_unseen(noisy, noisy.simulator, [without, found.fit], [first])
    )
    told[0] = (first, 4.0)
    assert gaps_left_out(found) is None


def test_a_group_whose_readings_deny_a_cause_speaks_against_it(noisy: Problem) -> None:
    """All but the upper chord strain as a heavier load would have it, that chord the other way."""
    heavier = candidate(noisy, "load_scale", effect="west")
    change = change_of(noisy, heavier, 0.1)
    chord = [name in ("S U1-U2", "S U2-U3") for name in noisy.data.sensors]
    for denied, worse in ((np.where(chord, -change, change), True), (change, False)):
        problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + denied)
        found = found_with(problem, [heavier])
        without = fit(problem, noisy.simulator, [], [])
        assert found.fit.log_evidence > without.log_evidence + 4.6
        assert worsens(found, without) == worse
        assert (gaps_left_out(found) is not None) == worse
