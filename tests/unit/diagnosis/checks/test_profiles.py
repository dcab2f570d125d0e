"""Profiles: parabolas of a parameter that acts straight, and chances of onsets."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, change_of, found_with, with_white_noise
from rga.diagnosis.checks.profiles import onset_profile, profiles
from rga.diagnosis.search.linearised import Problem


def test_a_linear_parameter_has_a_parabola(noisy: Problem) -> None:
    two = [candidate(noisy, "sensor_bias", sensor=name) for name in ("D1", "D2")]
    off = noisy.residual(noisy.simulated) + sum(change_of(noisy, one, 0.1) for one in two)
    found = found_with(with_white_noise(noisy, off), two)
    (one,) = profiles(found, 1)
    assert one.parameter == "offset"
    np.testing.assert_allclose(one.height, -(one.away**2) / 2, rtol=1e-5, atol=1e-5)
    prior = two[1].priors["offset"]
    estimate, spread = found.fit.z[1], found.fit.spreads()[1]
    expected = [prior.value(float(estimate + step * spread)) for step in one.away]
    np.testing.assert_allclose(one.values, expected, rtol=1e-6)


def test_what_another_cause_can_do_widens_a_profile(noisy: Problem) -> None:
    sunk = candidate(noisy, "support_settlement", support="east", dof="uz")
    bias = candidate(noisy, "sensor_bias", sensor="D3")
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change_of(noisy, sunk, 0.2))
    (alone,) = profiles(found_with(problem, [sunk]), 0)
    (beside,) = profiles(found_with(problem, [sunk, bias]), 0)
    assert (alone.parameter, alone.unit) == ("displacement", "m")
    assert np.ptp(beside.values) > 1.3 * np.ptp(alone.values)
    np.testing.assert_allclose(beside.height, -(beside.away**2) / 2, rtol=1e-3, atol=1e-3)


def test_other_parameters_adapt_even_where_the_information_does_not_say_so(
    noisy: Problem,
) -> None:
    """Along one coordinate alone the height is that of the marginal posterior all the same."""
    two = [
        candidate(noisy, "support_settlement", support="east", dof="uz"),
        candidate(noisy, "sensor_bias", sensor="D3"),
    ]
    found = found_with(noisy, two)
    whole = found.fit.information
    apart = replace(found, fit=replace(found.fit, information=np.diag(np.diag(whole))))
    (one,) = profiles(apart, 0)
    steps = one.away / np.sqrt(whole[0, 0])
    expected = -(steps**2) / (2 * np.linalg.inv(whole)[0, 0])
    np.testing.assert_allclose(one.height, expected, rtol=1e-3, atol=1e-6)


def test_onsets_count_from_the_first_row(noisy: Problem) -> None:
    one = candidate(noisy, "sensor_bias", sensor="D1")
    change = change_of(noisy, one, 0.2)
    change[50:] *= 1.0
    change[:50] = 0.0
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    late = found_with(problem, [one.beginning(float(problem.data.time[50]))])
    profile = onset_profile(late, 0, float(problem.data.time[10]))
    assert profile is not None
    assert profile.chances.sum() == pytest.approx(1.0)
    likeliest = profile.times[np.argmax(profile.chances)]
    assert likeliest == problem.data.time[50] - problem.data.time[10]
    assert onset_profile(found_with(problem, [one]), 0, 0.0) is None
