"""The small bridge with measured contexts, and what could be measured on it."""

from typing import Any

import pytest

from planned_bridge import GAIN, SOFT, explained, site
from rga.experiments.measurement_model import Errors, MeasurementModel
from rga.experiments.separation import Pair, paired
from rga.model import Model, read_model


@pytest.fixture(scope="session")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "small bridge")


@pytest.fixture(scope="session")
def bridge(model: Model) -> MeasurementModel:
    return site(model)


@pytest.fixture(scope="session")
def pair(model: Model, bridge: MeasurementModel) -> Pair:
    """A soft bar, or a gauge on it that reads too much."""
    soft = explained(model, SOFT, factor=(0.7, 0.05))
    return paired(bridge, soft, explained(model, GAIN, factor=(1.43, 0.05)))


@pytest.fixture(scope="session")
def errors(bridge: MeasurementModel, pair: Pair) -> Errors:
    return bridge.errors(pair.cause.effects)
