"""The search: it names what is hidden and nothing else, and takes out what is needless."""

from types import SimpleNamespace

import numpy as np
import pytest

from known_problem import candidate, candidates, change_of, found_with, with_white_noise
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Prospect, Screening
from rga.diagnosis.search.stepwise import (
    Found,
    fitted_beside,
    search,
    weighed,
    with_moment,
    without_cause,
    without_needless,
    worth_fitting,
)


def searched(problem: Problem) -> Found:
    few = candidates(problem, "sensor_bias", "support_settlement")
    screening = Screening(problem, problem.simulator, few)
    return search(problem, problem.simulator, few, screening, lambda stage, done: None)


def with_hidden(noisy: Problem, *effects: tuple[str, dict[str, str], float]) -> Problem:
    off = noisy.residual(noisy.simulated).copy()
    for kind, place, z in effects:
        off += change_of(noisy, candidate(noisy, kind, **place), z)
    return with_white_noise(noisy, off)


SUNK = ("support_settlement", {"support": "east", "dof": "uz"}, 0.2)
OFF = ("sensor_bias", {"sensor": "S L2-L3"}, 0.3)


@pytest.mark.parametrize("hidden", [[], [OFF], [SUNK, OFF]])
def test_what_is_hidden_is_named_and_nothing_else(
    noisy: Problem, hidden: list[tuple[str, dict[str, str], float]]
) -> None:
    found = searched(with_hidden(noisy, *hidden))
    named = {(one.name, one.place.get("sensor")) for one in found.fit.hypotheses}
    assert named == {(kind, place.get("sensor")) for kind, place, _ in hidden}
    assert len(found.log_odds) == len(found.alternatives) == len(hidden)
    assert all(odds > 20 for odds in found.log_odds)
    shown = found.problem.data.predict(found.fit.simulator(found.base))
    np.testing.assert_allclose(found.at_fit.simulated, shown, rtol=1e-12, atol=1e-15)
    for ranked in found.alternatives:
        assert [one.behind for one in ranked] == sorted(one.behind for one in ranked)


def test_leaving_a_cause_out_fits_the_others_alone(noisy: Problem) -> None:
    problem = with_hidden(noisy, SUNK, OFF)
    found = found_with(problem, [candidate(problem, kind, **at) for kind, at, _ in (SUNK, OFF)])
    left = without_cause(problem, problem.simulator, found.fit, 0)
    assert [one.name for one in left.hypotheses] == ["sensor_bias"]
    alone = fit(problem, problem.simulator, left.hypotheses, [0.1])
    assert left.log_evidence == pytest.approx(alone.log_evidence)
    assert found.fit.log_evidence - left.log_evidence == pytest.approx(found.log_odds[0])


def test_what_another_noise_does_not_speak_for_is_needless(noisy: Problem) -> None:
    problem = with_hidden(noisy, SUNK, OFF)
    found = found_with(problem, [candidate(problem, kind, **at) for kind, at, _ in (SUNK, OFF)])
    assert without_needless(problem, found).hypotheses == found.fit.hypotheses
    sigma = problem.noise.sigma.copy()
    # The channel that is off says nothing any more.
    sigma[problem.data.sensors.index("S L2-L3")] *= 1e3
    deaf = with_white_noise(noisy, problem.residual(problem.simulated), sigma)
    (left,) = without_needless(deaf, found).hypotheses
    assert left.name == "support_settlement"


def test_a_cause_that_earns_nothing_is_taken_out(noisy: Problem) -> None:
    problem = with_hidden(noisy, SUNK)
    sunk, bias = (candidate(problem, kind, **at) for kind, at, _ in (SUNK, OFF))
    both = fit(problem, problem.simulator, [sunk, bias], [0.2, 0.1])
    screening = Screening(problem, problem.simulator, [sunk, bias])
    left = weighed(problem, problem.simulator, both, screening, lambda stage, done: None)
    assert [one.name for one in left.fit.hypotheses] == ["support_settlement"]
    assert left.log_odds[0] > 20


def test_an_onset_moves_to_its_likeliest_row(noisy: Problem) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    change = change_of(noisy, one, 0.2)
    change[:50] = 0.0
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    early = fit(problem, problem.simulator, [one.beginning(problem.data.time[30])], [0.1])
    moved = with_moment(problem, problem.simulator, early, 0)
    assert moved.hypotheses[0].onset == problem.data.time[50]
    assert moved.log_evidence > early.log_evidence
    always = fit(problem, problem.simulator, [one], [0.1])
    assert with_moment(problem, problem.simulator, always, 0) is always


def test_prospects_are_fitted_beside_what_is_there(noisy: Problem) -> None:
    problem = with_hidden(noisy, SUNK, OFF)
    current = fit(problem, problem.simulator, [candidate(problem, SUNK[0], **SUNK[1])], [0.1])
    few = candidates(problem, "sensor_bias")
    screening = Screening(problem, problem.simulator, few)
    prospects = screening.again(problem, current.simulator(problem.simulator), current.hypotheses)
    best = max(
        fitted_beside(problem, problem.simulator, current, prospects[:3]),
        key=lambda one: one.log_evidence,
    )
    assert [one.name for one in best.hypotheses] == ["support_settlement", "sensor_bias"]
    assert best.hypotheses[1].place["sensor"] == "S L2-L3"
    np.testing.assert_allclose(best.z, [0.2, 0.3], rtol=0.05)


def test_of_another_kind_the_best_alone_is_fitted_unless_it_is_hopeless(noisy: Problem) -> None:
    kinds = {"sensor_bias": 1000.0, "support_settlement": 800.0, "sensor_gain": 600.0}
    places = {kind: candidates(noisy, kind) for kind in kinds}
    ranked = [
        Prospect(0, one, (0.1,), kinds[kind] - number, 5.0, 5.0, (0.1,))
        for kind, several in places.items()
        for number, one in enumerate(several)
    ]
    count = len(places["sensor_bias"])
    assert count > 10
    assert worth_fitting(ranked) == [*ranked[:10], ranked[count]]


def test_an_onset_that_is_no_likelier_elsewhere_stays(
    noisy: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    time = noisy.data.time
    # Between two rows it acts on the same readings.
    begun, alike = one.beginning(time[50]), one.beginning((time[49] + time[50]) / 2)
    current = fit(noisy, noisy.simulator, [begun], [0.1])
    likeliest = SimpleNamespace(likeliest=alike)
    monkeypatch.setattr("rga.diagnosis.search.stepwise.beginnings", lambda *of: likeliest)
    assert with_moment(noisy, noisy.simulator, current, 0) is current
