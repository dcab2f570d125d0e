"""Loads that bring their mass, and names that a tracker exchanges."""

from typing import Any

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.model import Model, read_model
from rga.model.io import model_content
from rga.simulation.modal.simulator import ModalSimulator

E, BENDING, LENGTH, HEAD = 210e9, 2e-5, 4.0, 500.0
GRAVITY = 9.80665


def mast(effects: dict[str, dict[str, Any]], **context: tuple[float, float]) -> Model:
    """Two weightless columns side by side, each with a mass on its head, joined by nothing."""
    build = rga.ModelBuilder("masts").add_material("steel", E=E)
    build.add_section("tube", A=1e-1, Iy=BENDING, Iz=BENDING, J=BENDING)
    for name, x in (("A", 0.0), ("B", 3.0)):
        build.add_node(f"foot {name}", x).add_node(f"head {name}", x, z=LENGTH)
        build.add_member(f"foot {name}", f"head {name}", "tube", kind="frame", groups="shaft")
        build.support(f"foot {name}", "fixed").mass(f"head {name}", HEAD if name == "A" else 800.0)
    for name, limits in context.items():
        build.context(name, "m", limits)
    content = model_content(build.build())
    points = {name: {"node": f"head {name}", "direction": [0, 1, 0]} for name in "AB"}
    modes = {
        "A": {"near": 2.0, "within": 0.8, "shape": {"A": 1.0, "B": 0.0}},
        "B": {"near": 1.6, "within": 0.8, "shape": {"A": 0.0, "B": 1.0}},
    }
    sensors: dict[str, dict[str, Any]] = {
        f"f {mode}": {"kind": "frequency", "mode": mode, "unit": "Hz"} for mode in modes
    }
    sensors |= {
        f"{mode} at A": {"kind": "mode_shape", "mode": mode, "point": "A", "unit": "-"}
        for mode in modes
    }
    effects = {**content.get("effects", {}), **effects}
    more = {"points": points, "modes": modes, "sensors": sensors, "effects": effects}
    return read_model(content | more, "a test")


def sway(mass: float) -> float:
    """Natural frequency of a weightless cantilever with a mass on its end [Hz]."""
    return float(np.sqrt(3 * E * BENDING / LENGTH**3 / mass) / (2 * np.pi))


def force(newtons: float, **more: Any) -> dict[str, Any]:
    return {"kind": "nodal_load", "forces": {"head A": [0.0, 0.0, -newtons]}} | more


def read(model: Model, **contexts: Any) -> list[list[float]]:
    return ModalSimulator(model).predict(contexts or None).tolist()


def test_a_parked_weight_swings_with_the_structure() -> None:
    (shown,) = read(mast({"car": force(200.0 * GRAVITY, inertia=True)}))
    np.testing.assert_allclose(shown[:2], [sway(HEAD + 200.0), sway(800.0)], rtol=1e-9)


def test_a_force_has_no_mass_unless_it_says_so() -> None:
    (shown,) = read(mast({"push": force(200.0 * GRAVITY)}))
    np.testing.assert_allclose(shown[:2], [sway(HEAD), sway(800.0)], rtol=1e-9)


def test_a_heavier_weight_has_more_mass() -> None:
    scaled = {"kind": "load_scale", "effect": "car", "factor": 1.5}
    (shown,) = read(mast({"car": force(200.0 * GRAVITY, inertia=True), "scaled": scaled}))
    np.testing.assert_allclose(shown[0], sway(HEAD + 300.0), rtol=1e-9)


def test_an_axle_has_its_mass_where_it_stands() -> None:
    path = {"path": ["head A", "head B"], "forces": [300.0 * GRAVITY], "offsets": [0.0]}
    truck = {"kind": "axle_load", "position": {"context": "at"}, "inertia": True} | path
    shown = read(mast({"truck": truck}, at=(-2.0, 4.0)), at=[0.0, 1.0, 3.0, -1.0])
    heads = [(300, 0), (200, 100), (0, 300), (0, 0)]
    expected = [[sway(HEAD + a), sway(800.0 + b)] for a, b in heads]
    np.testing.assert_allclose(np.array(shown)[:, :2], expected, rtol=1e-9)


def test_it_comes_when_it_comes() -> None:
    car = force(200.0 * GRAVITY, inertia=True, onset=10.0)
    before, after = read(mast({"car": car}), time=[0.0, 20.0])
    np.testing.assert_allclose([before[0], after[0]], [sway(HEAD), sway(HEAD + 200.0)], rtol=1e-9)


def test_statics_are_those_of_the_force() -> None:
    results = [
        rga.results(mast({"car": force(200.0 * GRAVITY, inertia=inertia)}))
        for inertia in (False, True)
    ]
    np.testing.assert_array_equal(results[0].displacements, results[1].displacements)


def test_what_lifts_has_no_mass() -> None:
    with pytest.raises(InputError, match="no mass is"):
        read(mast({"car": force(100.0, inertia=True, factor=-1.0)}))


SWAP = {"kind": "mode_swap", "modes": ["A", "B"], "onset": 10.0}


def test_a_tracker_takes_one_mode_for_the_other() -> None:
    before, after = read(mast({"swap": SWAP}), time=[0.0, 20.0])
    assert after == [before[1], before[0], before[3], before[2]]
    assert before[0] != before[1]


@pytest.mark.parametrize(
    ("modes", "said"), [(["A", "A"], "name two that differ"), (["A", "C"], "there is no mode 'C'")]
)
def test_modes_that_cannot_be_swapped(modes: list[str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        mast({"swap": SWAP | {"modes": modes}})
