"""Spreads of inferred contexts are those of the textbook."""

import numpy as np
import pytest

from crossed_truss import LATENT, crossed_truss, noise_of
from rga.inference import Variables
from rga.inference.map.laplace import laplace_spread
from rga.inference.map.posterior_mode import mode_beyond
from rga.model.schema import Model
from rga.simulation import Simulator


@pytest.fixture(scope="module")
def forwards() -> Model:
    return crossed_truss(both_ways=False)


@pytest.mark.parametrize("lies", [True, False])
def test_a_row_leaves_its_range_for_many_sensors_and_not_for_one(lies: bool) -> None:
    """Whatever is not sure of the structure: here all readings, by a common factor."""
    slopes = np.array([[1.0, 0.5], [1.0, -0.5], [2.0, 0.3], [1.5, 0.0], [0.8, 0.2], [1.2, 1.0]])
    context, noise = np.array([[1.8 if lies else 3.0, 0.1]]), np.full(6, 0.05)
    readings = context @ slopes.T
    readings[0, 2] += 2.0 * lies
    unsure = np.diag(noise**2) + 0.3**2 * np.outer(slopes[:, 0], slopes[:, 0])
    found = mode_beyond(
        lambda c: c @ slopes.T,
        lambda c: np.tile(slopes, (len(c), 1, 1)),
        readings,
        np.diag(noise**2) if lies else unsure,
        noise,
        np.array([[-2.0, 2.0], [-2.0, 2.0]]),
        np.zeros((1, 2)),
    )
    assert (found.value[0, 0] > 2.5) != lies


def test_laplace_is_the_textbook_formula(forwards: Model) -> None:
    variables, noise = Variables.of(forwards, LATENT), noise_of(forwards)
    simulator = Simulator(forwards)
    measured, latent = np.array([[12.0]]), np.array([[8.0, 4.1]])
    seen = np.ones((1, len(variables.sensors)), dtype=bool)
    seen[0, 3] = False
    j = simulator.jacobian({"crowd": 8.0, "temperature": 12.0, "cart": 4.1})[0][seen[0]]
    s = np.diag(noise[:-1][seen[0]] ** 2) + np.outer(j[:, 1], j[:, 1]) * 0.3**2
    prior = np.diag(12 / np.array([20.0, 11.0]) ** 2)
    precision = j[:, [0, 2]].T @ np.linalg.solve(s, j[:, [0, 2]]) + prior
    wanted = np.sqrt(np.diag(np.linalg.inv(precision)))
    found = laplace_spread(simulator, variables, measured, latent, seen, noise)[0]
    assert found == pytest.approx(wanted, rel=1e-6)
    blind = laplace_spread(simulator, variables, measured, latent, np.zeros_like(seen), noise)[0]
    assert blind == pytest.approx(np.array([20.0, 11.0]) / np.sqrt(12))
