"""The smallest effect that would have been named: it grows with the noise, whatever was found."""

import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.checks.detectability import Least, least_seen
from rga.diagnosis.search.linearised import Problem


def seen(noisy: Problem, factor: float, z: float = 0.4) -> Least | None:
    """A bias of the first channel under so many times the noise, and the least that is seen."""
    one = candidate(noisy, "sensor_bias", sensor="D1")
    sigma = factor * noisy.noise.sigma
    off = factor * noisy.residual(noisy.simulated) + change_of(noisy, one, z)
    problem = with_white_noise(noisy, off, sigma)
    return least_seen(found_with(problem, [one]), 0)


def test_the_more_noise_the_larger_is_the_least(noisy: Problem) -> None:
    found = [seen(noisy, factor) for factor in (1.0, 4.0, 8.0)]
    values = [least.value for least in found if least is not None and least.value is not None]
    assert len(values) == 3
    assert values == sorted(values)
    assert values[2] > 1.5 * values[1]
    bias = candidate(noisy, "sensor_bias", sensor="D1").priors["offset"].value(0.4)
    assert 0 < values[0] < 0.2 * bias


def test_the_share_is_of_what_was_found(noisy: Problem) -> None:
    one = seen(noisy, 1.0, 0.4)
    larger = seen(noisy, 1.0, 0.8)
    assert one is not None
    assert larger is not None
    assert 0 < larger.share < one.share < 1
    assert larger.share == pytest.approx(one.share / 2, rel=0.1)


def test_what_would_not_have_been_named_has_no_least(noisy: Problem) -> None:
    assert seen(noisy, 1.0, 0.0) is None
