"""What a zero is off: the noise of the mean over its rows, and the contexts there."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.data.tare import Tare
from rga.diagnosis.noise.row_covariance import Noise
from rga.diagnosis.noise.zero_errors import slopes_at_zero, zero_errors
from rga.diagnosis.search.linearised import Problem


def zeroed(posed: Problem, rows: int) -> Problem:
    """The record as zeroed over its first rows, on all channels but the last."""
    data = posed.data
    sensors = len(data.sensors)
    contexts = {name: column[:rows] for name, column in data.belief.table.items()}
    shares, counts = np.full((rows, sensors), 1 / rows), np.full(sensors, rows)
    shares[:, -1], counts[-1] = 0.0, 0
    return replace(posed, data=replace(data, tare=Tare(contexts, shares, counts, rows)))


def test_nothing_taken_off_is_not_off(posed: Problem) -> None:
    found = zero_errors(posed.simulator, posed.data, posed.noise)
    assert len(found.spread) == 0
    assert not found.variance.any()
    assert slopes_at_zero(posed.simulator, posed.data) == {}


@pytest.mark.parametrize(("memory", "factor"), [(0.0, 0.25), (0.6, 0.5), (0.98, 1.0)])
def test_noise_of_a_mean_goes_with_the_rows_and_their_memory(
    posed: Problem, memory: float, factor: float
) -> None:
    """sigma sqrt((1 + phi) / (1 - phi) / n), and never more than sigma."""
    problem = zeroed(posed, 16)
    sensors = len(problem.data.sensors)
    sigma = problem.noise.sigma
    noise = Noise(sigma, np.full(sensors, memory), problem.noise.context_sigma, sigma)
    found = zero_errors(problem.simulator, problem.data, noise)
    assert found.spread[: sensors - 1] == pytest.approx(factor * sigma[:-1])
    np.testing.assert_array_equal(found.patterns[: sensors - 1], np.eye(sensors)[:-1])
    assert found.measured.all()
    assert found.variance[-1] == 0.0
    assert (found.variance[:-1] >= (0.999 * factor * sigma[:-1]) ** 2).all()


def test_contexts_move_all_channels_together(posed: Problem) -> None:
    problem = zeroed(posed, 16)
    found = zero_errors(problem.simulator, problem.data, problem.noise)
    own = len(problem.data.sensors) - 1
    slopes = slopes_at_zero(problem.simulator, problem.data)
    names = list(problem.data.belief.spread)
    assert list(slopes) == names
    for number, name in enumerate(names):
        pattern = found.patterns[own + number]
        assert pattern == pytest.approx(problem.data.taken_off(slopes[name]))
        assert found.spread[own + number] == pytest.approx(
            problem.noise.context_sigma[number] / 4.0
        )
    rows = found.of_rows(3)
    assert len(rows) == len(found.spread)
    np.testing.assert_array_equal(rows[-1][0], np.tile(found.patterns[-1], (3, 1)))
