"""Channels whose noise is far beyond what the model states of it."""

from dataclasses import replace

import pytest

from rga.diagnosis.residuals.stated_noise import beyond_stated
from rga.diagnosis.search.linearised import Problem


def louder(problem: Problem, factor: float, count: int = 1) -> Problem:
    deviation = problem.noise.deviation.copy()
    deviation[:count] *= factor
    return replace(problem, noise=replace(problem.noise, deviation=deviation))


@pytest.mark.parametrize(("factor", "words"), [(1.0, 0), (2.5, 0), (8.0, 1)])
def test_only_noise_far_beyond_the_stated_is_a_warning(
    noisy: Problem, factor: float, words: int
) -> None:
    found = beyond_stated(louder(noisy, factor), ())
    assert len(found) == words
    if words:
        assert found[0].startswith("channel D1 varies by 0.4 mm")
        assert "8 times its stated noise" in found[0]


@pytest.mark.parametrize(("memory", "words"), [(0.5, 0), (0.9, 1)])
def test_noise_that_wanders_is_a_warning_sooner(noisy: Problem, memory: float, words: int) -> None:
    loud = louder(noisy, 3.0)
    phi = loud.noise.phi.copy()
    phi[0] = memory
    wandering = replace(loud, noise=replace(loud.noise, phi=phi))
    assert len(beyond_stated(wandering, ())) == words


def test_what_was_reported_before_is_not_repeated(noisy: Problem) -> None:
    assert beyond_stated(louder(noisy, 8.0), {"D1"}) == []


def test_many_channels_are_counted(noisy: Problem) -> None:
    found = beyond_stated(louder(noisy, 8.0, 9), ())
    assert found[-1] == f"{9 - len(found) + 1} more channels vary as much"


def test_a_channel_that_states_no_noise_is_left_out(noisy: Problem) -> None:
    model = noisy.simulator.model
    silent = model.sensors["D1"].model_copy(update={"noise": None})
    other = model.model_copy(update={"sensors": {**model.sensors, "D1": silent}})
    simulator = type(noisy.simulator)(other)
    assert beyond_stated(replace(louder(noisy, 8.0), simulator=simulator), ()) == []
