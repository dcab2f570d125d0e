"""Evidence by Laplace's approximation: exact where a response is straight in its parameter."""

import numpy as np
import pytest

from known_problem import candidate, change_of, with_white_noise
from rga.diagnosis.search.laplace import effects_at, fit, refit
from rga.diagnosis.search.linearised import Problem


def by_hand(problem: Problem, slope: np.ndarray, log_prior: float) -> tuple[float, float]:
    """Estimate and log evidence of r = slope z + noise with z standard normal."""
    sigma = problem.noise.sigma
    residual = problem.residual(problem.simulated)
    information = 1 + float(((slope / sigma) ** 2).sum())
    along = float((slope * residual / sigma**2).sum())
    return along / information, along**2 / information / 2 - np.log(information) / 2 + log_prior


@pytest.mark.parametrize(
    ("kind", "place"),
    [("sensor_bias", {"sensor": "D1"}), ("support_settlement", {"support": "east", "dof": "uz"})],
)
def test_a_linear_response_has_the_evidence_of_the_textbook(
    noisy: Problem, kind: str, place: dict[str, str]
) -> None:
    one = candidate(noisy, kind, **place)
    slope = change_of(noisy, one, 1.0)
    for size in (0.0, 0.02):
        problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + size * slope)
        z, evidence = by_hand(problem, slope, one.log_prior)
        found = fit(problem, problem.simulator, [one], [0.1])
        assert found.z == pytest.approx([z], rel=1e-4, abs=1e-6)
        assert found.log_evidence == pytest.approx(evidence, rel=1e-4, abs=1e-4)
        assert found.spreads() == pytest.approx([found.information[0, 0] ** -0.5])


def test_no_hypothesis_has_no_evidence(noisy: Problem) -> None:
    nothing = fit(noisy, noisy.simulator, [], [])
    assert nothing.log_evidence == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(nothing.simulated, noisy.simulated)


def test_another_noise_moves_a_fit_to_where_it_would_be_fitted(noisy: Problem) -> None:
    one = candidate(noisy, "support_settlement", support="east", dof="uz")
    off = noisy.residual(noisy.simulated) + change_of(noisy, one, 0.05)
    off[:, 0] += 0.5
    problem = with_white_noise(noisy, off)
    wider = with_white_noise(noisy, off, problem.noise.sigma * np.where(np.arange(11) == 0, 30, 1))
    (moved,) = refit(wider, wider.simulator, [fit(problem, problem.simulator, [one], [0.1])])
    again = fit(wider, wider.simulator, [one], [0.1])
    assert moved.z == pytest.approx(again.z, rel=1e-4)
    assert moved.z != pytest.approx(fit(problem, problem.simulator, [one], [0.1]).z, rel=0.1)
    assert moved.log_evidence == pytest.approx(again.log_evidence, rel=1e-5)


def test_parameters_go_to_the_hypotheses_in_their_order(noisy: Problem) -> None:
    two = [candidate(noisy, "sensor_bias", sensor=name) for name in ("D1", "D2")]
    effects = effects_at(two, np.array([1.0, 2.0]))
    scale = two[0].priors["offset"].value(1.0)
    assert [one.model_dump()["sensor"] for one in effects.values()] == ["D1", "D2"]
    assert [one.model_dump()["offset"] for one in effects.values()] == [scale, 2 * scale]
    assert fit(noisy, noisy.simulator, two, [0.1, 0.1]).slices() == [slice(0, 1), slice(1, 2)]
