"""Large displacements, against closed forms and against equilibrium by hand."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

import rga
from rga import _core
from rga.errors import InputError, UnstableStructureError
from rga.model import read_model
from rga.model.structure import build_structure
from rga.simulation.response import patterns

E, ALPHA = 2e11, 1.2e-5
FIXED = ["ux", "uy", "uz", "rx", "ry", "rz"]
Ends = tuple[list[str], list[str], dict[str, Any], dict[str, Any]]
"""Held at the left and at the right end; what else the first and the last member have."""


def model(**parts: Any) -> rga.Model:
    """A model of one material, its geometry nonlinear unless said otherwise."""
    return read_model(
        {
            "rga_model": 1,
            "name": "geometry",
            "plane": "xz",
            "materials": {"steel": {"E": E, "nu": 0.25, "alpha": ALPHA, "density": 7850}},
            "analysis": {"geometry": "nonlinear"},
            **parts,
        },
        "model",
    )


def force(nodes: dict[str, list[float]], context: str) -> dict[str, Any]:
    return {"kind": "nodal_load", "forces": nodes, "factor": {"context": context}}


def moves(node: str, direction: list[float]) -> dict[str, Any]:
    return {"kind": "displacement", "node": node, "direction": direction, "unit": "m"}


def reacts(node: str, direction: list[float]) -> dict[str, Any]:
    return {"kind": "reaction", "node": node, "direction": direction, "unit": "N"}


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
    loads = simulator.request(values, 23).loads(structure, np.arange(23))
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


# --- columns

LENGTH, COUNT = 6.0, 16
COLUMN = {"A": 1e-2, "Iy": 1e-7, "Iz": 1e-7, "J": 1e-7}
EI, EA = E * 1e-7, E * 1e-2
EULER = np.pi**2 * EI / LENGTH**2


def column(ends: Ends, **parts: Any) -> rga.Model:
    """A straight member along x in COUNT parts: pushed, loaded across, and warmed."""
    left, right, first, last = ends
    parts_of = [f"m{k}" for k in range(COUNT)]
    common = {"section": "column", "material": "steel", "kind": "frame", "groups": ["all"]}
    members: dict[str, Any] = {
        name: {"nodes": [f"n{k}", f"n{k + 1}"], **common} for k, name in enumerate(parts_of)
    }
    members["m0"] |= first
    members[parts_of[-1]] |= last
    end, half = f"n{COUNT}", COUNT // 2
    fibre = {"kind": "strain", "z": 0.1, "at": 0.0, "unit": "strain"}
    content: dict[str, Any] = {
        "sections": {"column": COLUMN},
        "nodes": {f"n{k}": [LENGTH * k / COUNT, 0, 0] for k in range(COUNT + 1)},
        "members": members,
        "supports": {"left": {"node": "n0", "fixed": left}, "right": {"node": end, "fixed": right}},
        "context": {
            "push": {"unit": "N", "range": [0, 1e4]},
            "across": {"unit": "N/m", "range": [0, 10]},
            "side": {"unit": "N", "range": [0, 10]},
            "warm": {"unit": "K", "range": [-50, 50]},
        },
        "effects": {
            "push": force({end: [-1, 0, 0]}, "push"),
            "side": force({end: [0, 0, 1]}, "side"),
            "across": {
                "kind": "member_load", "member": parts_of, "uniform": [0, 0, 1],
                "factor": {"context": "across"},
            },
            "warm": {"kind": "temperature", "groups": {"all": 1}, "delta": {"context": "warm"}},
        },
        "sensors": {
            "middle": moves(f"n{half}", [0, 0, 1]),
            "end": moves(end, [0, 0, 1]),
            "turn": {"kind": "rotation", "node": "n0", "direction": [0, -1, 0], "unit": "rad"},
            "base": {**fibre, "member": "m0"},
            "fibre": {**fibre, "member": f"m{half}"},
            "quarter": {**fibre, "member": f"m{COUNT // 4}", "at": 0.5},
            "force": {"kind": "force", "member": f"m{half}", "unit": "N"},
            "left": reacts("n0", [0, 0, 1]),
            "right": reacts(end, [0, 0, 1]),
            "pushed": reacts("n0", [1, 0, 0]),
        },
    }  # fmt: skip
    return model(**{**content, **parts})


PINNED: Ends = ["ux", "uz"], ["uz"], {}, {}
CLAMPED: Ends = FIXED, ["uy", "uz", "rx", "ry", "rz"], {}, {}
IMMOVABLE: Ends = ["ux", "uz"], ["ux", "uz"], {}, {}
STILL = {"push": 0.0, "across": 0.0, "side": 0.0, "warm": 0.0}


@pytest.mark.parametrize("share", [0.5, 0.9, -4.0])
def test_a_beam_column_under_a_uniform_load(share: float) -> None:
    """Timoshenko and Gere, Theory of Elastic Stability, 1961, section 1.4; tension: k imaginary."""
    push, across = share * EULER, 0.1
    k = np.emath.sqrt(push / EI)
    u = k * LENGTH / 2
    moment = across * EI / push * (1 / np.cos(u) - 1)
    x = LENGTH * (COUNT // 4 + 0.5) / COUNT - LENGTH / 2
    expected = {
        "middle": moment / push - across * LENGTH**2 / (8 * push),
        "turn": across * LENGTH**3 / (8 * EI) * (np.tan(u) - u) / u**3,
        "fibre": -push / EA + 0.1 * moment / EI,
        "quarter": -push / EA + 0.1 * across / push * (np.cos(k * x) / np.cos(u) - 1),
        "force": -push,
        "left": -across * LENGTH / 2,
        "right": -across * LENGTH / 2,
        "pushed": push,
    }
    simulator = rga.Simulator(column(PINNED))
    (shown,) = simulator.predict({**STILL, "push": push, "across": across})
    read = dict(zip(simulator.model.sensors, shown, strict=True))
    for name, value in expected.items():
        assert read[name] == pytest.approx(np.real(value), rel=3e-5), name


def test_a_column_that_leans_on_its_base() -> None:
    """A cantilever with the moment H L + P delta at its base, delta = H (tan kL - kL) / (P k)."""
    push, side = 0.2 * EULER, 0.2
    k = np.sqrt(push / EI)
    delta = side * (np.tan(k * LENGTH) - k * LENGTH) / (push * k)
    simulator = rga.Simulator(column((FIXED, [], {}, {})))
    (shown,) = simulator.predict({**STILL, "push": push, "side": side})
    read = dict(zip(simulator.model.sensors, shown, strict=True))
    assert read["end"] == pytest.approx(delta, rel=1e-4)
    bending = read["base"] - read["force"] / EA
    assert bending == pytest.approx(-0.1 * (side * LENGTH + push * delta) / EI, rel=1e-4)


def turning_spring(stiffness: float) -> float:
    """Critical load of a column between equal springs: tan(u) = -2 u EI / (c L), u = k L / 2."""
    u = brentq(
        lambda u: np.sin(u) + 2 * u * EI / (stiffness * LENGTH) * np.cos(u), np.pi / 2, np.pi
    )
    return float(4 * u**2 * EI / LENGTH**2)


SPRING = 2 * EI / LENGTH


@pytest.mark.parametrize(
    ("ends", "critical"),
    [
        (PINNED, EULER),
        (CLAMPED, 4 * EULER),
        ((FIXED, [], {}, {}), EULER / 4),
        ((*CLAMPED[:3], {"releases": {"j": ["ry"]}}), 2.0457 * EULER),
        (
            (
                *CLAMPED[:2],
                {"end_springs": {"i": {"ry": SPRING}}},
                {"end_springs": {"j": {"ry": SPRING}}},
            ),
            turning_spring(SPRING),
        ),
    ],
    ids=["pinned", "clamped", "cantilever", "propped", "springs"],
)
def test_columns_buckle_at_their_critical_load(ends: Ends, critical: float) -> None:
    simulator = rga.Simulator(column(ends))
    simulator.predict({**STILL, "push": 0.9998 * critical})
    words = r"buckles .* beyond 99.* % of its load .*, node 'n\d+' gives way in uz \(row 1\)"
    with pytest.raises(UnstableStructureError, match=words):
        simulator.predict({**STILL, "push": 1.0004 * critical})


def test_a_column_that_shears_buckles_earlier() -> None:
    """P = Pe / (1 + Pe / GA_s), Engesser."""
    shear = E / 2.5 * 1e-6
    critical = EULER / (1 + EULER / shear)
    simulator = rga.Simulator(column(PINNED, sections={"column": {**COLUMN, "Asz": 1e-6}}))
    simulator.predict({**STILL, "push": 0.9995 * critical})
    with pytest.raises(UnstableStructureError, match="buckles"):
        simulator.predict({**STILL, "push": 1.0005 * critical})


def test_a_warm_bar_that_cannot_lengthen() -> None:
    simulator = rga.Simulator(column(IMMOVABLE))
    critical = EULER / EA / ALPHA
    for warm in (-40.0, 0.99 * critical):
        (shown,) = simulator.predict({**STILL, "warm": warm})
        read = dict(zip(simulator.model.sensors, shown, strict=True))
        assert read["force"] == pytest.approx(-EA * ALPHA * warm, rel=1e-9)
        assert read["fibre"] == pytest.approx(-ALPHA * warm, rel=1e-9)
        assert read["pushed"] == pytest.approx(EA * ALPHA * warm, rel=1e-9)
        assert read["middle"] == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(UnstableStructureError, match="buckles"):
        simulator.predict({**STILL, "warm": 1.01 * critical})


def test_a_cold_tie_rod() -> None:
    """A beam in tension between immovable pins: cooling stiffens it against a load across."""
    cold, across = -0.4, 0.01
    tension = -EA * ALPHA * cold
    u = np.sqrt(tension / EI) * LENGTH / 2
    sag = across * LENGTH**2 / (8 * tension) - across * EI / tension**2 * (1 - 1 / np.cosh(u))
    simulator = rga.Simulator(column(IMMOVABLE))
    shown = simulator.predict({**STILL, "warm": cold, "across": across})
    assert shown[0, 0] == pytest.approx(sag, rel=1e-4)


def test_small_loads_are_those_of_linear_geometry() -> None:
    """What geometry adds grows with the square of the load."""
    load = np.array([1.0, 2.0])
    contexts: dict[str, Any] = {
        "push": load,
        "across": 0.001 * load,
        "side": 0.01 * load,
        "warm": 0.0,
    }
    ends: Ends = (FIXED, ["uz"], {}, {})
    curved = rga.Simulator(column(ends)).predict(contexts)
    straight = rga.Simulator(column(ends, analysis={"geometry": "linear"})).predict(contexts)
    names = list(rga.Simulator(column(ends)).model.sensors)
    one, two = np.abs(curved - straight)[:, [names.index(name) for name in ("middle", "quarter")]]
    np.testing.assert_allclose(two / one, 4.0, rtol=0.05)
    np.testing.assert_allclose(curved, straight, rtol=1e-3, atol=1e-12)


def test_derivatives_of_a_column() -> None:
    simulator, step = rga.Simulator(column(PINNED)), 0.01
    at = {"push": 0.5 * EULER, "across": 5.0, "side": 0.0, "warm": 10.0}
    found = simulator.jacobian(at)[0]
    for number, (name, width) in enumerate((("push", 1e4), ("across", 10.0))):
        slope = sum(
            weight
            * (
                simulator.predict({**at, name: at[name] + k * step * width})
                - simulator.predict({**at, name: at[name] - k * step * width})
            )[0]
            for k, weight in ((1, 45 / 60), (2, -9 / 60), (3, 1 / 60))
        ) / (step * width)
        size = np.abs(slope) + 1e-3 * np.abs(simulator.predict(at)[0]) / width + 1e-12
        np.testing.assert_allclose(found[:, number] / size, slope / size, rtol=0, atol=1e-6)


# --- a truss in space with all kinds of restraints


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
