"""Large displacements, against closed forms and against equilibrium by hand."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import rga
from plane_models import ALPHA, E, force, model, moves, reacts
from rga import _core
from rga.errors import InputError, UnstableStructureError
from rga.model.structure import build_structure
from rga.simulation.paths.response import patterns

# --- a shallow arch of two bars (von Mises)

HALF, RISE, AREA = 1.0, 0.1, 1e-3
BAR = float(np.hypot(HALF, RISE))


def arch(**parts: Any) -> rga.Model:
    bar = {"section": "bar", "material": "steel", "groups": ["bars"]}
    content: dict[str, Any] = {
        "sections": {"bar": {"A": AREA}},
        "nodes": {"W": [-HALF, 0, 0], "T": [0, 0, RISE], "E": [HALF, 0, 0]},
        "members": {"w": {"nodes": ["W", "T"], **bar}, "e": {"nodes": ["T", "E"], **bar}},
        "supports": {name: {"node": name, "fixed": ["ux", "uz"]} for name in "WE"},
        "context": {
            "load": {"unit": "N", "range": [0, 5e4]},
            "warm": {"unit": "K", "range": [-30, 30]},
        },
        "effects": {
            "load": force({"T": [0, 0, -1]}, "load"),
            "warm": {"kind": "temperature", "groups": {"bars": 1}, "delta": {"context": "warm"}},
        },
        "sensors": {
            "sinks": moves("T", [0, 0, -1]),
            "force": {"kind": "force", "member": "w", "unit": "N"},
            "gauge": {"kind": "strain", "member": "w", "unit": "strain"},
            "whole": {"kind": "strain", "member": "w", "unit": "strain", "total": True},
            "up": reacts("W", [0, 0, 1]),
            "in": reacts("W", [1, 0, 0]),
        },
    }
    return model(**{**content, **parts})


def arch_load(height: NDArray[np.float64], warm: float = 0.0) -> NDArray[np.float64]:
    """The load that holds the apex at a height."""
    length = np.hypot(HALF, height)
    tension = E * AREA * ((length - BAR) / BAR - ALPHA * warm)
    return np.asarray(-2 * tension * height / length)


def arch_peak(warm: float = 0.0) -> float:
    """Height of the apex [m] at which the load is largest: the slope of z (L / l - 1) vanishes."""
    free = BAR * (1 + ALPHA * warm)
    return float(np.sqrt(free ** (2 / 3) * HALF ** (4 / 3) - HALF**2))


@pytest.mark.parametrize("warm", [0.0, 20.0])
def test_the_arch_of_two_bars(warm: float) -> None:
    height = np.linspace(1.5 * RISE, arch_peak(warm) + 1e-4, 9)
    length = np.hypot(HALF, height)
    strain = (length - BAR) / BAR
    tension = E * AREA * (strain - ALPHA * warm)
    load = arch_load(height, warm)
    shown = rga.Simulator(arch()).predict({"load": load, "warm": warm})
    expected = [
        RISE - height,
        tension,
        strain - ALPHA * warm,
        strain,
        load / 2,
        -tension * HALF / length,
    ]
    np.testing.assert_allclose(shown, np.transpose(expected), rtol=1e-9, atol=1e-15)


def test_the_arch_does_not_snap_through_unseen() -> None:
    simulator = rga.Simulator(arch())
    largest = float(arch_load(np.array(arch_peak())))
    simulator.predict({"load": 0.9999 * largest, "warm": 0.0})
    for factor, share in ((1.001, "99.9"), (2.0, "50"), (20.0, "5"), (800.0, "0.12")):
        words = rf"beyond {share}.* % of its load .*, node 'T' gives way in uz \(row 2\)"
        with pytest.raises(UnstableStructureError, match=words):
            simulator.predict({"load": [0.5 * largest, factor * largest], "warm": 0.0})


def test_it_is_refused_beside_friction_and_slip() -> None:
    slip = {"kind": "joint_slip", "member": "w", "slip": 1e-4}
    friction = {"kind": "bearing_friction", "support": "W", "dof": "ux", "mu": 0.1}
    supports = {"W": {"node": "W", "fixed": ["uz"]}, "E": {"node": "E", "fixed": ["ux", "uz"]}}
    springs = [{"node": "W", "dof": "ux", "stiffness": 1e8}]
    for other in (slip, friction | {"permanent_force": 1e3}):
        effects = {"load": force({"T": [0, 0, -1]}, "load"), "other": other}
        loose = arch(effects=effects, supports=supports, springs=springs)
        with pytest.raises(InputError, match="not simulated together"):
            rga.Simulator(loose).predict({"load": 1.0})


def test_rows_have_the_same_bits_in_any_batch_and_on_any_thread() -> None:
    simulator = rga.Simulator(arch())
    load, warm = np.linspace(-3e4, 5e4, 23), np.linspace(-20, 30, 23)
    assert simulator.plan({"load": load, "warm": warm}).path == "C4"
    whole = simulator.predict({"load": load, "warm": warm})
    for part in (slice(0, 1), slice(5, 18), slice(22, None, -3)):
        some = simulator.predict({"load": load[part], "warm": warm[part]})
        np.testing.assert_array_equal(some, whole[part])
    structure = build_structure(simulator.model)
    values = simulator.resolve({"time": np.zeros(23), "load": load, "warm": warm})
    loads = simulator.assembly.request(values, 23).loads(structure, np.arange(23))
    given = structure.arrays, patterns(structure, loads), structure.outputs
    coefficients = np.column_stack([one.coefficient for one in loads])
    for threads in (1, 2, 5):
        found = _core.respond_nonlinear(*given, coefficients, threads)
        np.testing.assert_array_equal(found, whole)


def test_derivatives_of_the_arch() -> None:
    """Against differences of sixth order, with another step."""
    simulator, step = rga.Simulator(arch()), 0.004
    at = {"load": np.array([1e4, 4e4]), "warm": np.array([-10.0, 25.0])}
    found = simulator.jacobian(at)
    for number, (name, width) in enumerate((("load", 5e4), ("warm", 60.0))):
        slope = sum(
            weight
            * (
                simulator.predict({**at, name: at[name] + k * step * width})
                - simulator.predict({**at, name: at[name] - k * step * width})
            )
            for k, weight in ((1, 45 / 60), (2, -9 / 60), (3, 1 / 60))
        ) / (step * width)
        size = np.abs(slope) + 1e-3 * np.abs(simulator.predict(at)) / width
        np.testing.assert_allclose(found[:, :, number] / size, slope / size, rtol=0, atol=1e-7)


# --- a rope


@pytest.mark.parametrize("cold", [40.0, 0.01])
def test_a_rope_needs_tension(cold: float) -> None:
    """A straight line of bars holds a load across by the tension that cooling gives it."""
    bar = {"section": "bar", "material": "steel", "groups": ["rope"]}
    rope = model(
        sections={"bar": {"A": 1e-4}},
        nodes={"W": [-5, 0, 0], "M": [0, 0, 0], "E": [5, 0, 0]},
        members={"w": {"nodes": ["W", "M"], **bar}, "e": {"nodes": ["M", "E"], **bar}},
        supports={name: {"node": name, "fixed": ["ux", "uz"]} for name in "WE"},
        context={
            "load": {"unit": "N", "range": [0, 1e4]}, "cold": {"unit": "K", "range": [0, 60]}
        },
        effects={
            "load": force({"M": [0, 0, -1]}, "load"),
            "cold": {
                "kind": "temperature", "groups": {"rope": -1.0}, "delta": {"context": "cold"},
            },
        },
        sensors={
            "sag": moves("M", [0, 0, -1]),
            "force": {"kind": "force", "member": "w", "unit": "N"},
        },
    )  # fmt: skip
    sag = np.array([0.0, 1e-4, 0.02, 0.3, 2.0])
    length = np.hypot(5, sag)
    tension = E * 1e-4 * (length / 5 - 1 + ALPHA * cold)
    load = 2 * tension * sag / length
    simulator = rga.Simulator(rope)
    shown = simulator.predict({"load": load, "cold": cold})
    np.testing.assert_allclose(shown, np.transpose([sag, tension]), rtol=1e-9, atol=1e-15)
    with pytest.raises(UnstableStructureError, match=r"node 'M' in uz meets no resist.*\(row 1\)"):
        simulator.predict({"load": 100.0, "cold": 0.0})


def test_a_mast_in_space_is_in_equilibrium_where_it_has_moved() -> None:
    """Forces at moved nodes, by hand from the displacements shown, vanish or are reactions."""
    nodes = {
        "a": [0.0, 0, 0], "b": [4.0, 0, 0], "c": [2.0, 3, 0], "p": [1.5, 1, 3], "q": [2.5, 1, 6],
    }  # fmt: skip
    bars = [("a", "p"), ("b", "p"), ("c", "p"), ("p", "q"), ("a", "q"), ("b", "q"), ("c", "q")]
    along = np.array([1.0, 2.0, 2.0]) / 3
    held = {"a": ["ux", "uy", "uz"], "b": ["uy", "uz"], "c": ["ux", "uy"]}
    spring = {"node": "p", "to": "q", "dof": "ux", "stiffness": 2e6}
    ground = {"node": "b", "dof": "ux", "stiffness": 5e7}
    axes = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
    lowered, warm = -0.05, 80.0
    load = {"p": np.array([2e5, -1e5, -3e5]), "q": np.array([3e5, 4e5, -2e5])}
    mast = model(
        plane=None,
        sections={"bar": {"A": AREA}},
        nodes={**nodes, "r": [2.0, 6, 1]},
        members={
            f"{one}{two}": {
                "nodes": [one, two], "section": "bar", "material": "steel", "groups": ["all"],
            }
            for one, two in [*bars, ("r", "c"), ("r", "p"), ("r", "q")]
        },
        supports={
            **{name: {"node": name, "fixed": dofs} for name, dofs in held.items()},
            "c low": {"node": "c", "fixed": ["uz"]},
            "r slides": {"node": "r", "along": list(along)},
            "r too": {"node": "r", "along": [0, 1, -1]},
        },
        springs=[spring, ground],
        context={"t": {"unit": "K", "range": [0, 100]}},
        effects={
            "warm": {"kind": "temperature", "groups": {"all": 1}, "delta": {"context": "t"}},
            "load": {"kind": "nodal_load", "forces": {n: list(f) for n, f in load.items()}},
            "sinks": {
                "kind": "support_settlement", "support": "c low", "dof": "uz",
                "displacement": lowered,
            },
        },
        sensors={
            f"{kind} {node} {axis}": {
                "kind": kind, "node": node, "direction": way,
                "unit": "m" if kind == "displacement" else "N",
            }
            for kind in ("displacement", "reaction")
            for node in [*nodes, "r"]
            for axis, way in axes.items()
        },
    )  # fmt: skip
    (shown,) = rga.Simulator(mast).predict({"t": warm})
    names = [*nodes, "r"]
    moved, reaction = (dict(zip(names, part, strict=True)) for part in shown.reshape(2, -1, 3))
    place = {name: np.array(mast.nodes[name]) for name in names}
    out_of_balance = {name: load.get(name, np.zeros(3)) + reaction[name] for name in names}
    for member in mast.members.values():
        one, two = member.nodes
        drawn = np.linalg.norm(place[two] - place[one])
        apart = place[two] + moved[two] - place[one] - moved[one]
        length = np.linalg.norm(apart)
        pull = E * AREA * (length / drawn - 1 - ALPHA * warm) * apart / length
        out_of_balance[one] = out_of_balance[one] + pull
        out_of_balance[two] = out_of_balance[two] - pull
    between = 2e6 * (moved["q"] - moved["p"])[0]
    out_of_balance["p"][0] += between
    out_of_balance["q"][0] -= between
    assert max(np.abs(moved["q"])) > 0.04
    for name, left in out_of_balance.items():
        np.testing.assert_allclose(left, 0.0, atol=1e-3, err_msg=name)
    assert moved["c"][2] == pytest.approx(lowered)
    assert along @ moved["r"] == pytest.approx(0.0, abs=1e-12)
    assert np.cross(reaction["r"], np.cross(along, [0, 1, -1])) @ [1, 1, 1] != 0.0
    assert reaction["r"] @ np.cross(along, [0, 1, -1]) == pytest.approx(0.0, abs=1e-3)
    assert reaction["b"][0] == pytest.approx(-5e7 * moved["b"][0], rel=1e-9)
    whole = sum(np.cross(place[n] + moved[n], reaction[n] + load.get(n, 0.0)) for n in names)
    np.testing.assert_allclose(whole, sum_of_spring_moments(place, moved, between), atol=1e-2)


def sum_of_spring_moments(place: Any, moved: Any, force: float) -> Any:
    """A spring along x between two places off that line is no bar: it gives the nodes a moment."""
    arm = place["q"] + moved["q"] - place["p"] - moved["p"]
    return np.cross(arm, [force, 0.0, 0.0])


def test_two_loads_act_together() -> None:
    """One solve of their sum: the response of either alone does not add up to it."""
    half = force({"T": [0, 0, -0.5]}, "load")
    apart = rga.Simulator(arch(effects={"one": half, "two": half}))
    whole = rga.Simulator(arch()).predict({"load": 3e4, "warm": 0.0})
    np.testing.assert_allclose(apart.predict({"load": 3e4}), whole, rtol=1e-9)
    assert 2 * apart.predict({"load": 1.5e4})[0, 0] < 0.95 * whole[0, 0]
