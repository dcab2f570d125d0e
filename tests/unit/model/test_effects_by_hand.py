"""Effects against what they do by hand: stiffness and temperature, creep, loads that lean, play."""

from typing import Any

import numpy as np
import pytest

from every_kind_bridge import CONTEXTS, HOUR, ROWS, bridge, readings
from rga.errors import InputError
from rga.model import read_model
from rga.simulation import Simulator

#: of a bar [m2, N/m2, m], and the load that it hangs [N]
AREA, MODULUS, LENGTH, LOAD = 0.004, 2e11, 3.0, 1e5


def hanging_bar(**more: Any) -> dict[str, Any]:
    """A model of a bar that hangs from one support, its lower end guided."""
    return {
        "rga_model": 1,
        "name": "bar",
        "plane": "xz",
        "materials": {"steel": {"E": MODULUS, "alpha": 0.0}},
        "sections": {"bar": {"A": AREA}},
        "nodes": {"top": [0, 0, LENGTH], "low": [0, 0, 0]},
        "members": {
            "bar": {"nodes": ["top", "low"], "section": "bar", "material": "steel", "groups": ["g"]}
        },
        "supports": {
            "top": {"node": "top", "fixed": ["ux", "uz"]},
            "low": {"node": "low", "fixed": ["ux"]},
        },
        "sensors": {
            "z": {"kind": "displacement", "node": "low", "direction": [0, 0, -1], "unit": "m"}
        },
        **more,
    }


PULL = {"kind": "nodal_load", "forces": {"low": [0, 0, -LOAD]}}


def test_a_stiffness_follows_the_temperature_by_hand() -> None:
    """Of a hanging bar: EA as below the kink, and straight in the temperature above it."""
    warmth = {
        "kind": "temperature",
        "groups": {"g": 1.0},
        "delta": {"context": "air", "minus": 10.0},
    }
    context = {"air": {"unit": "degC", "range": [-20, 40]}}
    air = np.array([-10.0, 5.0, 10.0, 13.0, 14.0, 30.0, 31.0])
    frost = np.where(air > 12, -0.02 * (air - 12), -0.05 * (air - 12))
    for more, change in (
        ({}, -0.02 * (air - 10)),
        ({"of": "both"}, -0.02 * (air - 10)),
        ({"kink": 12.0, "below": -0.05}, frost),
        ({"kink": 12.0}, -0.02 * np.maximum(air - 12, 0)),
    ):
        own = {"kind": "stiffness_temperature", "group": "g", "rate": -0.02, **more}
        effects = {"pull": PULL, "warmth": warmth, "own": own}
        simulator = Simulator(read_model(hanging_bar(context=context, effects=effects), "test"))
        shown = simulator.predict({"air": air})[:, 0]
        expected = LOAD * LENGTH / (MODULUS * AREA * (1 + change))
        np.testing.assert_allclose(shown, expected, rtol=1e-12)
        assert simulator.plan({"air": air}).path == "C2"
    with pytest.raises(InputError, match="leaves no stiffness"):
        simulator.predict({"air": 70.0})


@pytest.mark.parametrize(("of", "bends", "stretches"), [("EA", 0, 1), ("EI", 1, 0), ("both", 1, 1)])
def test_what_follows_the_temperature_of_a_cantilever(of: str, bends: int, stretches: int) -> None:
    """Its tip moves by F L^3 / 3 EI across, and by F L / EA along."""
    content = hanging_bar(
        sections={"bar": {"A": 2e-3, "Iy": 3e-6, "Iz": 3e-6, "J": 6e-6}},
        nodes={"wall": [0, 0, 0], "tip": [2, 0, 0]},
        members={
            "arm": {
                "nodes": ["wall", "tip"], "section": "bar", "material": "steel", "kind": "frame",
                "groups": ["g"],
            }
        },
        supports={"wall": {"node": "wall", "fixed": ["ux", "uz", "ry"]}},
        context={"air": {"unit": "degC", "range": [-20, 40]}},
        effects={
            "pull": {"kind": "nodal_load", "forces": {"tip": [500.0, 0.0, -500.0]}},
            "warmth": {
                "kind": "temperature", "groups": {"g": 1.0},
                "delta": {"context": "air", "minus": 10.0},
            },
            "soft": {
                "kind": "stiffness_temperature", "group": "g", "rate": -0.002, "kink": 0.0,
                "below": -0.01, "of": of,
            },
        },
        sensors={
            name: {"kind": "displacement", "node": "tip", "direction": way, "unit": "mm"}
            for name, way in (("x", [1, 0, 0]), ("z", [0, 0, -1]))
        },
    )  # fmt: skip
    shown = Simulator(read_model(content, "arm")).predict({"air": np.array([-10.0, 0.0, 20.0])})
    change = np.array([0.1, 0.0, -0.04])
    across = 5e5 * 2.0**3 / (3 * MODULUS * 3e-6 * (1 + bends * change))
    along = 5e5 * 2.0 / (MODULUS * 2e-3 * (1 + stretches * change))
    np.testing.assert_allclose(shown, np.column_stack([along, across]), rtol=1e-9)


def test_two_bases_that_give_way_stand_one_behind_the_other() -> None:
    """A hanging bar sinks by F L / EA, and by F / k of each of them."""
    soft = {"kind": "support_flexibility", "support": "top", "dof": "uz"}
    rod = LOAD * LENGTH / (MODULUS * AREA)
    for given in ((), (5e7,), (5e7, 2e7), (2e7, 5e7), (5e7, 2e7, 1e7)):
        bases = {f"base {n}": {**soft, "stiffness": k} for n, k in enumerate(given)}
        model = read_model(hanging_bar(effects={"pull": PULL, **bases}), "test")
        shown = Simulator(model).predict({})
        expected = rod + sum(LOAD / stiffness for stiffness in given)
        np.testing.assert_allclose(shown, [[expected]], rtol=1e-12)


def test_a_stiffness_follows_members_that_warm_late() -> None:
    """The order of the effects does not matter, and lag and stiffness are those of hand."""
    rate = {"kind": "stiffness_temperature", "group": "bottom", "rate": -0.01}
    late = {"kind": "thermal_lag", "time_constant": 5.0}
    one, other = readings(bridge(a=rate, b=late)), readings(bridge(b=late, a=rate))
    np.testing.assert_array_equal(one, other)
    air, felt = CONTEXTS["temperature"], CONTEXTS["temperature"].copy()
    for row in range(1, ROWS):  # dT/dt = (air - T) / 5 h, the air straight between rows
        slope = air[row] - air[row - 1]
        felt[row] = air[row] - 5 * slope
        felt[row] += (felt[row - 1] - air[row - 1] + 5 * slope) * np.exp(-1 / 5)
    np.testing.assert_allclose(one, readings(bridge(a=rate), temperature=felt), rtol=1e-9)


def test_permanent_loads_creep_and_no_others() -> None:
    """Response = that to all loads + growth * that to tank, snow and ballast alone."""
    ballast = {"kind": "dead_load", "group": "bottom", "force_per_length": 2e3}
    still = {"crowd": np.zeros(ROWS), "cart": np.full(ROWS, -9.0), "temperature": np.full(ROWS, 10)}
    plain, alone = readings(bridge(ballast=ballast)), readings(bridge(ballast=ballast), **still)
    lean = {"kind": "load_eccentricity", "effect": ["tank", "people"], "share": 0.2}
    creep = {"kind": "creep", "amplitude": 0.4}
    growth = 0.4 * np.log10(1 + CONTEXTS["time"] / 86400)[:, None]
    shown = readings(bridge(ballast=ballast, creep=creep))
    np.testing.assert_allclose(shown, plain + growth * alone, rtol=1e-9, atol=1e-9)
    first = readings(bridge(creep=creep, lean=lean))
    np.testing.assert_allclose(first, readings(bridge(lean=lean, creep=creep)), rtol=1e-12)
    later = readings(bridge(creep={**creep, "onset": 12 * HOUR}))
    np.testing.assert_array_equal(later[:13], readings(bridge())[:13])
    began = 0.4 * np.log10(1 + np.maximum(CONTEXTS["time"] - 12 * HOUR, 0) / 86400)[:, None]
    expected = readings(bridge()) + began * readings(bridge(), **still)
    np.testing.assert_allclose(later, expected, rtol=1e-9, atol=1e-9)


def test_a_load_on_members_leans_too() -> None:
    """Snow on a bar of the south side loses what that of the north side gains."""
    snow = {"kind": "member_load", "uniform": [0, 0, 1e3]}
    lean = {"kind": "load_eccentricity", "effect": "deep", "share": 0.1}
    for side, factor in (("s", 0.8), ("n", 1.2)):
        deep = {**snow, "member": f"a{side}-b{side}"}
        leaning = readings(bridge(deep=deep, lean=lean))
        scaled = readings(bridge(deep={**deep, "factor": factor}))
        np.testing.assert_allclose(leaning, scaled, rtol=1e-9, atol=1e-9)


def test_idle_members_stay_in_the_middle_of_their_play() -> None:
    """Bars that slip, the loads off them: nothing moves, whatever rounding says."""
    slip = {"kind": "joint_slip", "group": ["bottom", "webs", "bracing"], "slip": 1e-3}
    cold = {"crowd": 0.0, "cart": -9.0, "temperature": 10.0}
    content = bridge(slip=slip)
    kept = {k: v for k, v in content.effects.items() if k not in ("tank", "snow")}
    shown = Simulator(content.model_copy(update={"effects": kept})).predict({**CONTEXTS, **cold})
    np.testing.assert_allclose(shown, 0.0, atol=1e-6)
    warm = Simulator(bridge(slip={**slip, "group": "bracing"})).predict(CONTEXTS)
    assert np.isfinite(warm).all()
