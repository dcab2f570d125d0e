"""Spreads of inferred contexts are those of the textbook."""

import numpy as np
import pytest

from crossed_truss import LATENT, crossed_truss, noise_of
from rga.inference import Variables
from rga.inference.map.laplace import laplace_spread
from rga.model.schema import Model
from rga.simulation import Simulator


@pytest.fixture(scope="module")
def forwards() -> Model:
    return crossed_truss(both_ways=False)


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
