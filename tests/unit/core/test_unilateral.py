"""Members and supports with play or slack, against solutions by hand."""

from typing import Any

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.model import read_effect, read_model

E, AREA, ALPHA = 2e11, 1e-3, 1.2e-5


def model(nodes: dict[str, Any], bars: dict[str, list[str]], **more: Any) -> rga.Model:
    """A plane truss of one section, loaded by the context `load` [N] and warmed by `warm` [K]."""
    return read_model(
        {
            "rga_model": 1,
            "name": "slack",
            "plane": "xz",
            "materials": {"steel": {"E": E, "nu": 0.3, "alpha": ALPHA, "density": 7850}},
            "sections": {"bar": {"A": AREA, "Iy": 1e-8, "Iz": 1e-8, "J": 1e-8}},
            "nodes": nodes,
            "members": {
                name: {"nodes": ends, "section": "bar", "material": "steel", "groups": ["all"]}
                for name, ends in bars.items()
            },
            "context": {
                "load": {"unit": "N", "range": [-1e5, 1e5]},
                "warm": {"unit": "K", "range": [-50, 50]},
            },
            **more,
        },
        "model",
    )


def hanger(**effects: Any) -> rga.Model:
    return model(
        {"top": [0, 0, 2], "low": [0, 0, 0]},
        {"rod": ["top", "low"]},
        supports={
            "wall": {"node": "top", "fixed": ["ux", "uz"]},
            "guide": {"node": "low", "fixed": ["ux"]},
        },
        effects={
            "pull": {
                "kind": "nodal_load", "forces": {"low": [0, 0, -1]}, "factor": {"context": "load"},
            },
            **effects,
        },
        sensors={
            "z": {"kind": "displacement", "node": "low", "direction": [0, 0, 1], "unit": "m"},
            "gauge": {"kind": "strain", "member": "rod", "unit": "strain"},
            "force": {"kind": "force", "member": "rod", "unit": "N"},
        },
    )  # fmt: skip


def test_a_joint_slips_to_either_side() -> None:
    loads = np.array([-4e4, -1.0, 1.0, 4e4])
    slipping = hanger(slip={"kind": "joint_slip", "member": "rod", "slip": 0.003})
    simulator = rga.Simulator(slipping)
    shown = simulator.predict({"load": loads, "warm": 0.0})
    np.testing.assert_allclose(
        shown[:, 0], -(loads * 2 / (E * AREA) + 0.003 * np.sign(loads)), rtol=1e-10
    )
    np.testing.assert_allclose(shown[:, 1], loads / (E * AREA), rtol=1e-10)
    np.testing.assert_allclose(shown[:, 2], loads, rtol=1e-10)
    assert simulator.plan({"load": loads, "warm": 0.0}).path == "C4"


def test_without_slip_it_is_the_plain_bar() -> None:
    loads = {"load": np.linspace(-1e5, 1e5, 7), "warm": 0.0}
    tight = rga.Simulator(hanger(slip={"kind": "joint_slip", "member": "rod", "slip": 0.0}))
    np.testing.assert_allclose(
        tight.predict(loads), rga.Simulator(hanger()).predict(loads), rtol=1e-10, atol=1e-15
    )


def test_a_rod_that_is_pushed_holds_nothing() -> None:
    rod = rga.Simulator(hanger(rod={"kind": "tension_only", "member": "rod", "slack": 0.0}))
    assert rod.predict({"load": 1e4, "warm": 0.0})[0, 2] == pytest.approx(1e4)
    with pytest.raises(InputError, match="nothing that holds"):
        rod.predict({"load": -1e4, "warm": 0.0})


def test_a_rod_that_was_tightened_pulls_at_once() -> None:
    nodes = {"a": [0, 0, 0], "b": [1, 0, 0], "c": [2, 0, 0]}
    more: dict[str, Any] = {
        "supports": {
            "a": {"node": "a", "fixed": ["ux", "uz"]},
            "b": {"node": "b", "fixed": ["uz"]},
            "c": {"node": "c", "fixed": ["ux", "uz"]},
        },
        "effects": {
            "push": {
                "kind": "nodal_load", "forces": {"b": [1, 0, 0]}, "factor": {"context": "load"},
            },
            "tight": {"kind": "tension_only", "member": "rod", "slack": -1e-4},
        },
        "sensors": {
            "x": {"kind": "displacement", "node": "b", "direction": [1, 0, 0], "unit": "m"}
        },
    }  # fmt: skip
    taut = rga.Simulator(model(nodes, {"bar": ["a", "b"], "rod": ["b", "c"]}, **more))
    stiffness = E * AREA
    for load in (-6e4, -1e4, 0.0, 1e4, 4.9e4):
        found = taut.predict({"load": load, "warm": 0.0})[0, 0]
        both = (load + stiffness * 1e-4) / (2 * stiffness)
        assert found == pytest.approx(both if both < 1e-4 else load / stiffness, rel=1e-6)


def panel(diagonals: dict[str, list[str]], **effects: Any) -> rga.Model:
    """A square panel on two pins, pushed sideways at its top."""
    return model(
        {"a": [0, 0, 0], "b": [3, 0, 0], "c": [0, 0, 3], "d": [3, 0, 3]},
        {"left": ["a", "c"], "right": ["b", "d"], "beam": ["c", "d"], **diagonals},
        supports={n: {"node": n, "fixed": ["ux", "uz"]} for n in "ab"},
        effects={
            "push": {
                "kind": "nodal_load", "forces": {"c": [1, 0, -0.2]}, "factor": {"context": "load"},
            },
            **effects,
        },
        sensors={
            f"{node} {name}": {"kind": "displacement", "node": node, "direction": way, "unit": "mm"}
            for node in "cd"
            for name, way in (("x", [1, 0, 0]), ("z", [0, 0, 1]))
        }
        | {"right bar": {"kind": "strain", "member": "right", "unit": "microstrain"}},
    )  # fmt: skip


def test_crossed_rods_take_turns() -> None:
    """Only the diagonal in tension carries, as in a panel that has but that one."""
    both = {"up": ["a", "d"], "down": ["c", "b"]}
    rods = {"kind": "tension_only", "member": ["up", "down"], "slack": 0.0}
    crossed = rga.Simulator(panel(both, rods=rods))
    for load, taut in ((5e4, "up"), (-5e4, "down")):
        alone = rga.Simulator(panel({taut: both[taut]}))
        at = {"load": load, "warm": 0.0}
        np.testing.assert_allclose(crossed.predict(at), alone.predict(at), rtol=1e-9, atol=1e-12)


def test_a_stop_takes_the_expansion_beyond_its_gap() -> None:
    length, gap, stiffness = 5.0, 0.001, 4e7
    warm = np.array([-30.0, 0.0, 10.0, 30.0])
    bar = model(
        {"fast": [0, 0, 0], "end": [length, 0, 0]},
        {"bar": ["fast", "end"]},
        supports={
            "fast": {"node": "fast", "fixed": ["ux", "uz"]},
            "joint": {"node": "end", "fixed": ["uz"]},
        },
        effects={
            "warmth": {
                "kind": "temperature", "groups": {"all": 1.0}, "delta": {"context": "warm"},
            },
            "stop": {
                "kind": "support_gap", "support": "joint", "dof": "ux", "gap": gap,
                "stiffness": stiffness,
            },
        },
        sensors={
            "force": {"kind": "force", "member": "bar", "unit": "N"},
            "stop": {"kind": "reaction", "node": "end", "direction": [1, 0, 0], "unit": "N"},
        },
    )  # fmt: skip
    free = ALPHA * warm * length
    beyond = free - np.clip(free, -gap, gap)
    force = -beyond / (length / (E * AREA) + 1 / stiffness)
    shown = rga.Simulator(bar).predict({"warm": warm, "load": 0.0})
    np.testing.assert_allclose(shown[:, 0], force, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(shown[:, 1], force, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("effects", "words"),
    [
        (
            {
                "a": {"kind": "joint_slip", "member": "rod", "slip": 1e-3},
                "b": {"kind": "tension_only", "member": "rod", "slack": 0.0},
            },
            "two of joint_slip and tension_only",
        ),
        ({"a": {"kind": "tension_only", "member": "rod", "slack": 0.0, "onset": 3.0}}, "no onset"),
        (
            {
                "a": {
                    "kind": "support_gap",
                    "support": "guide",
                    "dof": "ux",
                    "gap": 0.0,
                    "stiffness": 1e7,
                }
            },
            "holds ux",
        ),
    ],
)
def test_what_makes_no_sense_is_refused(effects: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        rga.Simulator(hanger(**effects)).predict({"load": 1.0, "warm": 0.0})


def test_a_truss_whose_diagonals_all_slip() -> None:
    """Statics alone gives the forces; play makes each diagonal longer or shorter beside them."""
    panels, slip = 12, 1.4e-5
    nodes = {f"L{k}": [3.0 * k, 0, 0] for k in range(panels + 1)}
    nodes |= {f"U{k}": [3.0 * k, 0, 3.0] for k in range(1, panels)}
    chords = [(f"L{k}", f"L{k + 1}") for k in range(panels)]
    chords += [(f"U{k}", f"U{k + 1}") for k in range(1, panels - 1)]
    chords += [(f"L{k}", f"U{k}") for k in range(1, panels)]
    half = panels // 2
    diagonals = [("L0", "U1"), (f"U{panels - 1}", f"L{panels}")]
    diagonals += [(f"U{k}", f"L{k + 1}") for k in range(1, half)]
    diagonals += [(f"L{k}", f"U{k + 1}") for k in range(half, panels - 1)]
    bars = {"-".join(ends): list(ends) for ends in [*chords, *diagonals]}
    slopes = ["-".join(ends) for ends in diagonals]
    bridge = model(
        nodes,
        bars,
        supports={
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": f"L{panels}", "fixed": ["uz"]},
        },
        effects={
            "crowd": {
                "kind": "nodal_load",
                "forces": {f"L{k}": [0, 0, -1.0 - 0.3 * k] for k in range(1, panels)},
                "factor": {"context": "load"},
            },
            "slips": {"kind": "joint_slip", "member": slopes, "slip": {"context": "warm"}},
        },
        sensors={
            "D": {"kind": "displacement", "node": "L4", "direction": [0, 0, 1], "unit": "m"},
            **{name: {"kind": "force", "member": name, "unit": "N"} for name in slopes},
        },
    )
    load = np.array([1e5, -3e4, 10.0, 0.1, -1e-3])
    pull = bridge.extended(
        {"unit": read_effect({"kind": "nodal_load", "forces": {"L4": [0, 0, 1.0]}}, "unit")}
    )
    tight = rga.Simulator(bridge).predict({"load": load, "warm": 0.0})
    loose = rga.Simulator(bridge).predict({"load": load, "warm": slip})
    virtual = rga.Simulator(pull).predict({"load": np.zeros(1), "warm": 0.0})[0, 1:]
    apart = np.sign(tight[:, 1:]) @ virtual * slip
    assert np.allclose(loose[:, 1:], tight[:, 1:], rtol=1e-6, atol=1e-9)
    assert np.allclose(loose[:, 0] - tight[:, 0], apart, rtol=1e-6)


def crossed(panels: int, **law: Any) -> rga.Model:
    """A truss with crossed diagonals of which every member has a law."""
    nodes = {
        f"{side}{k}": [3.0 * k, 0, z] for side, z in (("L", 0), ("U", 3)) for k in range(panels + 1)
    }
    bars = [(f"{side}{k}", f"{side}{k + 1}") for side in "LU" for k in range(panels)]
    bars += [(f"L{k}", f"U{k}") for k in range(panels + 1)]
    bars += [(f"{a}{k}", f"{b}{k + 1}") for a, b in ("LU", "UL") for k in range(panels)]
    return model(
        nodes,
        {"-".join(ends): list(ends) for ends in bars},
        supports={
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": f"L{panels}", "fixed": ["uz"]},
        },
        effects={
            "crowd": {
                "kind": "nodal_load",
                "forces": {f"L{k}": [0.2 * k, 0, -1.0 - 0.3 * k] for k in range(1, panels)},
                "factor": {"context": "load"},
            },
            "wind": {
                "kind": "nodal_load",
                "forces": {f"U{k}": [1.0, 0, 0.4 - 0.1 * k] for k in range(panels)},
                "factor": {"context": "warm"},
            },
            "laws": {"group": "all", **law},
        },
        sensors={
            name: {"kind": "displacement", "node": name, "direction": [0, 0, 1], "unit": "m"}
            for name in nodes
        },
    )


def test_a_row_is_what_it_is_beside_any_others() -> None:
    """Many members slip, and hold each other: rows lead on to the sides of rows near them."""
    bridge = crossed(8, kind="joint_slip", slip=3e-4)
    draw = np.random.default_rng(5)
    load, wind = draw.uniform(-1e5, 1e5, 60), draw.uniform(-50, 50, 60)
    simulator = rga.Simulator(bridge)
    together = simulator.predict({"load": load, "warm": wind})
    alone = [
        simulator.predict({"load": load[k : k + 1], "warm": wind[k : k + 1]})[0]
        for k in range(len(load))
    ]
    assert together == pytest.approx(np.array(alone), rel=1e-11, abs=1e-13)
    stiff = bridge.model_copy(update={"effects": {k: bridge.effects[k] for k in ("crowd", "wind")}})
    plain = rga.Simulator(stiff).predict({"load": load, "warm": wind})
    assert abs(together - plain).max() > 3e-4


@pytest.mark.parametrize("slack", [0.0, 3e-4])
def test_rods_alone_hold_nothing_however_small(slack: float) -> None:
    """A truss takes compression somewhere; elongations of metres would be no answer."""
    simulator = rga.Simulator(crossed(4, kind="tension_only", slack=slack))
    for load in (1.0, 1e3, 1e5):
        with pytest.raises(InputError, match="nothing that holds the structure"):
            simulator.predict({"load": [0.0, load], "warm": [0.0, 0.0]})
    idle = simulator.predict({"load": [0.0], "warm": [0.0]})
    assert abs(idle).max() <= 2 * slack
