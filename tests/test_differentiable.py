"""The simulator as a torch module."""

from typing import Any

import numpy as np
import pytest
import torch

from rga.errors import InputError
from rga.model import read_model
from rga.simulation import Simulator

CONTEXTS = torch.tensor([[5.0, 2e4], [31.0, 7e4], [-12.0, 4e4]], dtype=torch.float64)


@pytest.fixture
def simulator(two_bars: dict[str, Any]) -> Simulator:
    # A load in kilonewtons, so that numbers of like size stand side by side.
    two_bars["context"]["load"] = {"unit": "kN", "range": [0, 100]}
    two_bars["effects"]["weight"]["factor"] = {"context": "load", "times": 1000.0}
    # Something that is not linear: the product of two contexts.
    two_bars["effects"]["stiffness"] = {
        "kind": "member_stiffness",
        "member": "west",
        "factor": {"context": "temperature", "times": 0.005, "minus": -200.0},
    }
    return Simulator(read_model(two_bars, "test"))


def contexts() -> torch.Tensor:
    return (CONTEXTS / torch.tensor([1.0, 1000.0])).requires_grad_()


def test_values_are_those_of_the_simulator(simulator: Simulator) -> None:
    table = dict(zip(simulator.model.context, contexts().detach().numpy().T, strict=True))
    found = simulator.as_torch()(contexts())
    assert found.dtype == torch.float64
    assert found.detach().numpy().tobytes() == simulator.predict(table).tobytes()


def test_gradients(simulator: Simulator) -> None:
    # The derivatives are central differences themselves: equal to about six figures.
    assert torch.autograd.gradcheck(simulator.as_torch(), (contexts(),), eps=1e-3, atol=1e-6)


def test_time(simulator: Simulator) -> None:
    values = {"kind": "sensor_bias", "sensor": "D1", "offset": 3.0, "onset": 10.0}
    effect = read_model(
        {**simulator.model.model_dump(), "effects": {"late": values}}, "test"
    ).effects["late"]
    module = simulator.extended({"late": effect}).as_torch()
    early, late = (module(contexts(), np.full(3, moment))[:, 0] for moment in (0.0, 20.0))
    assert torch.allclose(late - early, torch.full((3,), 3.0, dtype=torch.float64))
    by_default = simulator.extended({"late": effect}).as_torch(np.full(3, 20.0))
    assert torch.equal(by_default(contexts())[:, 0], late)


def test_a_wrong_shape_is_refused(simulator: Simulator) -> None:
    with pytest.raises(InputError, match="temperature, load"):
        simulator.as_torch()(torch.zeros(3, 5, dtype=torch.float64))
