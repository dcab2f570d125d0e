"""A site of the small bridge with two explanations, for tests of planning."""

from typing import Any

import numpy as np

from rga.experiments.candidates import added_sensors, settings
from rga.experiments.explanation import CandidateModel, explanation
from rga.experiments.measurement_model import MeasurementModel
from rga.model import Model, read_effect

#: two settlements that move the middle of the bridge alike
EAST = {"kind": "support_settlement", "support": "east", "dof": "uz"}
WEST = {"kind": "support_settlement", "support": "west", "dof": "uz"}
#: a bar that has lost stiffness, and a gauge that reads too much
SOFT = {"kind": "member_stiffness", "member": "L2-L3"}
GAIN = {"kind": "sensor_gain", "sensor": "S L2-L3"}


def site(model: Model, working: list[str] | None = None) -> MeasurementModel:
    """The bridge with all that could be added, and its settings as tests."""
    operation = {
        "time": 600.0 * np.arange(6),
        "temperature": np.linspace(0.0, 20.0, 6),
        "west load": np.array([10.0, 60.0, 30.0, 80.0, 20.0, 50.0]),
        "east load": np.array([40.0, 20.0, 70.0, 10.0, 60.0, 30.0]),
    }
    tests = settings(model, {"temperature", "west load", "east load"})
    added = [one for one in added_sensors(model) if not one.context]
    levels = np.array([0.025, 0.01, 0.003])
    sensors = list(model.sensors) if working is None else working
    return MeasurementModel(model, sensors, added, tests, operation, None, None, levels)


def explained(
    model: Model, content: dict[str, Any], **parameters: tuple[float, float]
) -> CandidateModel:
    """An effect with parameters known to within a half width of their 90 % interval."""
    estimated = {
        name: {"value": value, "ci90": [value - half, value + half]}
        for name, (value, half) in parameters.items()
    }
    words = " ".join(str(one) for one in content.values())
    return explanation(words, model, [read_effect({**content, **estimated}, "test")])
