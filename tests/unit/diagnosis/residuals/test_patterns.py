"""Patterns that sensors share beyond loads and contexts: found, in words, and none by chance."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.residuals.patterns import (
    in_words,
    known_contexts,
    leftovers,
    share_left,
    shared_pattern,
    with_leftovers,
)
from rga.diagnosis.search.linearised import Problem


def swaying(posed: Problem, amplitude: np.ndarray, size: float = 3.0) -> Problem:
    """Four channels that move together, so many times their noise."""
    direction = np.zeros(len(posed.data.sensors))
    direction[4:8] = size * posed.noise.sigma[4:8] * [1, -1, 1, -1]
    readings = posed.data.readings + np.outer(amplitude, direction)
    return replace(posed, data=replace(posed.data, readings=readings))


@pytest.fixture
def white(posed: Problem) -> np.ndarray:
    return np.random.default_rng(1).standard_normal(len(posed.data.time))


def test_independent_noise_shares_no_pattern(posed: Problem) -> None:
    assert shared_pattern(posed) is None
    assert with_leftovers(posed) is posed
    assert share_left(posed) == 0.0
    assert in_words(posed, {}).startswith("nothing that varies in common")


def test_channels_that_move_together_do(posed: Problem, white: np.ndarray) -> None:
    found = shared_pattern(swaying(posed, white))
    assert found is not None
    moved = found.direction / posed.noise.sigma
    moved /= np.abs(moved).max()
    assert (np.abs(moved[4:8]) > 0.7).all()
    assert (np.abs(np.delete(moved, range(4, 8))) < 0.5).all()
    assert moved[4] * moved[5] < 0 < moved[4] * moved[6]
    assert 0.1 < found.share < 1


def test_a_pattern_is_part_of_the_covariance_with_what_it_follows(
    posed: Problem, white: np.ndarray
) -> None:
    problem = with_leftovers(swaying(posed, white))
    assert problem.factors.shape[1] >= 1
    assert share_left(problem) > 0.2
    first = leftovers(problem, {"wind": white})[0]
    assert first.follows.startswith("goes with wind")
    assert first.drivers["wind"] > 0.9
    assert np.sqrt((first.amplitude**2).mean()) == pytest.approx(1.0)
    assert leftovers(problem, {})[0].follows == "follows no context and changes from row to row"
    assert "a pattern of S" in in_words(problem, {})


def test_measured_contexts_are_known(posed: Problem) -> None:
    assert list(known_contexts(posed, ["temperature"])) == ["temperature"]
    assert known_contexts(posed, ["absent"]) == {}
