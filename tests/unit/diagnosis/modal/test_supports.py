"""Structures that stand for those of all windows, where more than one thing drives them."""

from typing import Any

import numpy as np
import polars as pl
import pytest

import rga
from rga.arrays import FloatArray
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.model import Model, read_model
from rga.model.io import model_content
from rga.records.modal.read import load_modal_record
from rga.simulation.modal.simulator import ModalSimulator

WINDOWS = 40
TIME = 3600.0 * np.arange(WINDOWS)
AIR = 10.0 + 15.0 * np.sin(np.arange(WINDOWS) / 3.0)
#: a truck that comes and goes, whatever the weather
TRUCK = (np.arange(WINDOWS) % 5 < 2).astype(float)
NEWTONS = 3000.0


def mast(truck: dict[str, Any], *, warm: bool = True) -> Model:
    """A column that softens when it is warm, with a weight on its head at times."""
    build = rga.ModelBuilder("mast").add_material("steel", E=210e9, density=7850)
    build.add_section("tube", A=5e-3, Iy=2e-5, Iz=3e-5, J=4e-5)
    build.add_node("foot").add_node("head", z=4.0)
    build.add_member("foot", "head", "tube", kind="frame", groups="shaft")
    build.support("foot", "fixed").mass("head", 800.0)
    build.context("air", "degC", (-10.0, 30.0)).context("truck", "-", (0.0, 1.0))
    content = model_content(build.build())
    points = {
        "X": {"node": "head", "direction": [1, 0, 0]},
        "Y": {"node": "head", "direction": [0, 1, 0]},
    }
    modes = {
        "x": {"near": 4.0, "within": 0.6, "shape": {"X": 1.0, "Y": 0.0}},
        "y": {"near": 5.0, "within": 0.6, "shape": {"X": 0.0, "Y": 1.0}},
    }
    sensors = {f"f_{name}": {"kind": "frequency", "mode": name, "unit": "Hz"} for name in modes}
    effects: dict[str, Any] = {
        "truck": {"kind": "nodal_load", "forces": {"head": [0, 0, -NEWTONS]}, "inertia": True}
        | truck
    }
    if warm:
        softer = {"context": "air", "kink": 0.0, "below": -0.02, "above": -0.003}
        effects["warm"] = {"kind": "elastic_modulus", "material": "steel", "factor": softer}
    more = {"points": points, "modes": modes, "sensors": sensors, "effects": effects}
    return read_model(content | more, "a test")


def predicted(model: Model, tmp_path: Any) -> tuple[FloatArray, FloatArray]:
    """ln f of every window by the trials of a diagnosis, and by the simulator."""
    shown = ModalSimulator(model).predict({"time": TIME, "air": AIR, "truck": TRUCK})
    lines = [
        {"time": at, "air": air, "truck": truck, "f": row[k], "X": 1.0 - k, "Y": float(k)}
        for at, air, truck, row in zip(TIME, AIR, TRUCK, shown, strict=True)
        for k in range(2)
    ]
    pl.DataFrame(lines).write_csv(tmp_path / "modes.csv")
    readings = ModalReadings.of(model, load_modal_record(tmp_path / "modes.csv", model))
    return ModalTrials(model, readings).predict({}).log_f, np.log(shown)


@pytest.mark.parametrize(
    "truck",
    [
        {"factor": {"context": "truck"}},
        {"onset": float(TIME[25])},
        {"factor": {"context": "truck"}, "onset": float(TIME[10])},
    ],
)
@pytest.mark.parametrize("warm", [False, True])
def test_a_truck_and_the_weather_are_looked_at_together(
    truck: dict[str, Any], warm: bool, tmp_path: Any
) -> None:
    found, right = predicted(mast(truck, warm=warm), tmp_path)
    # Between the temperatures that are looked at the line with its bend is cut short.
    np.testing.assert_allclose(found, right, rtol=0, atol=0.02 if warm else 1e-9)
    assert np.ptp(right, axis=0).min() > 0.1
