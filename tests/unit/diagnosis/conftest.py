"""A small bridge with measured contexts, and its record about the simulation."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from known_problem import with_white_noise
from rga.diagnosis.preparation.prepare import PreparedRecord, prepare
from rga.diagnosis.search.linearised import Problem, pose
from rga.model import Model, read_model
from rga.records import Record
from rga.simulation import Simulator


@pytest.fixture(scope="session")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "small bridge")


@pytest.fixture(scope="session")
def prepared(model: Model, measured_record: Callable[..., Record]) -> PreparedRecord:
    """A record with nothing hidden."""
    return prepare(model, measured_record(model), lambda done: None)


@pytest.fixture(scope="session")
def posed(model: Model, prepared: PreparedRecord) -> Problem:
    """The same about the simulation, its noise and scatter estimated."""
    return pose(Simulator(model), prepared.data)


@pytest.fixture(scope="session")
def nothing_off(posed: Problem) -> Problem:
    """Readings that are those of the simulation, under white noise as stated."""
    return with_white_noise(posed, np.zeros_like(posed.simulated))


@pytest.fixture(scope="session")
def noisy(posed: Problem) -> Problem:
    """The same with that noise on the readings."""
    sigma = np.array([posed.simulator.model.sensors[name].noise for name in posed.data.sensors])
    draw = np.random.default_rng(11)
    return with_white_noise(posed, sigma * draw.standard_normal(posed.simulated.shape))
