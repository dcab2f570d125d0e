"""The whole record in units of its noise: zeros put right, rows before an onset left aside."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, change_of, with_white_noise
from rga.diagnosis.checks.whole_record import WholeRecord
from rga.diagnosis.data.held_out import held_out_rows
from rga.diagnosis.search.linearised import Problem


@pytest.fixture
def few(noisy: Problem) -> tuple[Problem, WholeRecord]:
    """The rows that are fitted, and all of them."""
    held_out = held_out_rows(len(noisy.data.time))
    fitted = replace(noisy, data=noisy.data.rows(~held_out))
    problem = with_white_noise(fitted, noisy.residual(noisy.simulated)[~held_out])
    return problem, WholeRecord.of(noisy.data, held_out, problem)


def test_noise_is_that_of_the_fitted_rows(few: tuple[Problem, WholeRecord]) -> None:
    problem, whole = few
    np.testing.assert_allclose(whole.noise, np.tile(problem.noise.sigma, (len(whole.noise), 1)))
    np.testing.assert_array_equal(whole.deviation, problem.noise.deviation)


def test_all_rows_are_simulated_at_exact_contexts(
    few: tuple[Problem, WholeRecord], noisy: Problem
) -> None:
    problem, whole = few
    np.testing.assert_allclose(whole.simulated(problem), noisy.simulated)


def test_a_zero_goes_to_where_the_fitted_rows_put_it(
    few: tuple[Problem, WholeRecord], noisy: Problem
) -> None:
    problem, whole = few
    sigma = problem.noise.sigma
    off = 2.0 * sigma
    readings = noisy.simulated + off
    shifted = replace(whole, data=replace(whole.data, readings=readings))
    unknown = replace(problem, zero_variance=sigma**2)
    moved = shifted.at_zero(unknown, noisy.simulated) - noisy.simulated
    count = (~whole.held_out).sum()
    expected = off * sigma**2 / (sigma**2 + sigma**2 / count)
    np.testing.assert_allclose(moved, np.tile(expected, (len(moved), 1)))
    # No further than three deviations, and not at all where the zero is sure.
    small = replace(problem, zero_variance=(0.1 * sigma) ** 2)
    moved = shifted.at_zero(small, noisy.simulated) - noisy.simulated
    np.testing.assert_allclose(moved, np.tile(0.3 * sigma, (len(moved), 1)))
    np.testing.assert_array_equal(shifted.at_zero(problem, noisy.simulated), noisy.simulated)


def test_the_gain_is_the_square_of_what_was_off(
    few: tuple[Problem, WholeRecord], noisy: Problem
) -> None:
    _, whole = few
    one = candidate(noisy, "sensor_bias", sensor="D1")
    change = change_of(noisy, one, 0.1)
    readings = noisy.data.readings + change
    record = replace(whole, data=replace(whole.data, readings=readings))
    gained = record.gain(noisy.simulated, noisy.simulated + change, [one], 0)
    square = ((change / whole.noise) ** 2).mean()
    assert gained.before - gained.after == pytest.approx(square, rel=0.1)
    assert gained.interval[0] < square < gained.interval[1]


def test_rows_held_out_right_before_an_onset_are_not_compared(
    few: tuple[Problem, WholeRecord], noisy: Problem
) -> None:
    _, whole = few
    rows = np.flatnonzero(whole.held_out)
    block = rows[(rows > 50) & (rows < 60)]
    onset = float(noisy.data.time[block[-1] + 1])
    spoiled = noisy.data.readings.copy()
    spoiled[block] += 1e3
    record = replace(whole, data=replace(whole.data, readings=spoiled))
    one = candidate(noisy, "sensor_bias", sensor="D1").beginning(onset)
    after = noisy.simulated
    assert record.gain(after, after, [one], 0).after < 2
    assert record.gain(after, after, [], 0).after > 1e3
