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
    assert torch.autograd.gradcheck(simulator.as_torch(), (contexts(),), eps=1e-3, atol=1e-8)


@pytest.mark.parametrize("path", ["C1", "C2", "C3", "C3 anew", "C4", "shown otherwise"])
def test_the_adjoint_is_the_jacobian_transposed(simulator: Simulator, path: str) -> None:
    data = simulator.model.model_dump()
    rows = 9 if path in ("C2", "C3", "C3 anew") else 4
    table = {"temperature": np.linspace(-15, 35, rows), "load": np.linspace(10, 90, rows) ** 1.1}
    if path == "C1":
        del data["effects"]["stiffness"]
    elif path == "C3":
        # Elongations of two members side by side are one: they cannot be condensed.
        data["members"]["beside"] = data["members"]["west"]
        data["effects"]["stiffness"]["member"] = ["west", "beside"]
    elif path == "C3 anew":
        del data["effects"]["stiffness"]
        factor = {"context": "temperature", "times": 0.001, "minus": -1000.0}
        data["effects"]["warm"] = {
            "kind": "thermal_expansion",
            "material": "steel",
            "factor": factor,
        }
    elif path == "C4":
        data["effects"]["slip"] = {"kind": "joint_slip", "member": "west", "slip": 1e-4}
        del data["effects"]["stiffness"]
    elif path == "shown otherwise":
        data["effects"]["gain"] = {"kind": "sensor_gain", "sensor": "D1", "factor": 1.5}
    other = Simulator(read_model(data, "test"))
    if path.startswith("C"):
        assert other.plan(table).path == path[:2]
    gradients = np.random.default_rng(1).normal(size=(rows, len(other.model.sensors)))
    jacobian = other.jacobian(table)
    expected = np.einsum("ts,tsc->tc", gradients, jacobian)
    size = np.einsum("ts,tsc->tc", np.abs(gradients), np.abs(jacobian))
    assert np.abs(jacobian).max(axis=(0, 1)).min() > 0
    assert (np.abs(other.pull_back(table, gradients) - expected) <= 1e-9 * size).all()


def test_bad_gradients_are_refused(simulator: Simulator) -> None:
    table = {"temperature": [1.0, 2.0], "load": [3.0, 4.0]}
    sensors = len(simulator.model.sensors)
    for wrong in (np.zeros((3, sensors)), np.full((2, sensors), np.nan), [[0.0]]):
        with pytest.raises(InputError, match="gradients"):
            simulator.pull_back(table, wrong)


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


def test_parameters_that_multiply_one_stiffness_are_differentiated_row_by_row(
    simulator: Simulator,
) -> None:
    data = simulator.model.model_dump()
    data["context"]["wear"] = {"unit": "-", "range": [0, 0.5]}
    data["effects"]["wear"] = {
        "kind": "member_stiffness",
        "member": ["west"],
        "factor": {"context": "wear", "times": -1.0, "minus": 1.0},
    }
    worn = Simulator(read_model(data, "test"))
    rows = 12
    table = {
        "temperature": np.linspace(-15, 35, rows),
        "load": np.linspace(10, 90, rows),
        "wear": np.linspace(0.0, 0.45, rows) ** 1.2 + 0.01,
    }
    found = worn.jacobian(table)
    for column, name in enumerate(worn.model.context):
        step = 1e-5 * np.ptp(worn.model.context[name].range)
        ahead, behind = (worn.predict({**table, name: table[name] + way * step}) for way in (1, -1))
        slope = (ahead - behind) / (2 * step)
        near = 1e-6 * np.abs(slope).max()
        np.testing.assert_allclose(found[:, :, column], slope, rtol=1e-5, atol=near)


def test_a_logarithm_drives_a_stiffness(simulator: Simulator) -> None:
    data = simulator.model.model_dump()
    data["context"]["firmness"] = {"unit": "-", "range": [-1, 0]}
    factor = {"context": "firmness", "log10": True}
    data["effects"]["stiffness"]["factor"] = factor
    firm = Simulator(read_model(data, "test"))
    data["effects"]["stiffness"]["factor"] = 10.0**-0.4
    fixed = Simulator(read_model(data, "test"))
    table = {"temperature": [5.0, 9.0], "load": [20.0, 30.0], "firmness": [-0.4, -0.4]}
    np.testing.assert_allclose(firm.predict(table), fixed.predict(table), rtol=1e-12)
    slope = firm.jacobian(table)[:, :, 2]
    ahead, behind = (firm.predict({**table, "firmness": [-0.4 + way] * 2}) for way in (1e-5, -1e-5))
    np.testing.assert_allclose(slope, (ahead - behind) / 2e-5, rtol=1e-5, atol=1e-9)


def test_a_temperature_follows_no_logarithm(two_bars: dict[str, Any]) -> None:
    warm = next(e for e in two_bars["effects"].values() if e["kind"] == "temperature")
    warm["delta"] = {"context": "temperature", "log10": True}
    with pytest.raises(InputError, match="log10"):
        read_model(two_bars, "test")
