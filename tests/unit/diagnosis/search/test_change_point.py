"""Beginnings: the row from which on a channel is off, at once or growing, and how sure that is."""

import numpy as np
import pytest

from known_problem import candidate, change_of, with_white_noise
from rga.diagnosis.search.change_point import beginnings
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.linearised import Problem

ROW = 40


def begun(noisy: Problem, weight: np.ndarray, size: float = 0.2) -> tuple[Problem, object]:
    """A bias of a channel that takes so much of each row, and its beginnings."""
    one = candidate(noisy, "sensor_bias", sensor="D1")
    change = change_of(noisy, one, size) * weight[:, None]
    problem = with_white_noise(noisy, noisy.residual(noisy.simulated) + change)
    current = fit(problem, problem.simulator, [one.beginning(problem.data.time[20])], [0.01])
    return problem, beginnings(problem, problem.simulator, current, 0)


def test_a_step_begins_at_its_row(noisy: Problem) -> None:
    rows = np.arange(len(noisy.data.time))
    problem, found = begun(noisy, (rows >= ROW).astype(float))
    assert found.likeliest.onset == problem.data.time[ROW]
    assert found.likeliest.profile == "step"
    assert found.chances.sum() == pytest.approx(1.0)
    assert found.moments[np.argmax(found.chances)] == problem.data.time[ROW]


def test_what_grows_is_a_ramp(noisy: Problem) -> None:
    rows = np.arange(len(noisy.data.time))
    problem, found = begun(noisy, np.clip((rows - ROW) / (len(rows) - 1 - ROW), 0, 1))
    assert found.likeliest.profile == "ramp"
    assert abs(found.likeliest.onset - problem.data.time[ROW]) <= 6 * 600.0
    assert found.likeliest.end is None


def test_a_small_step_may_have_begun_at_many_rows(noisy: Problem) -> None:
    rows = np.arange(len(noisy.data.time))
    _, large = begun(noisy, (rows >= ROW).astype(float))
    _, small = begun(noisy, (rows >= ROW).astype(float), 0.003)
    assert small.chances.max() < 0.5 < large.chances.max()
