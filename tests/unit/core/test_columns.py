"""Columns and beams under large displacements, against closed forms."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import rga
from plane_models import ALPHA, FIXED, E, force, model, moves, reacts
from rga.errors import UnstableStructureError

Ends = tuple[list[str], list[str], dict[str, Any], dict[str, Any]]
"""Held at the left and at the right end; what else the first and the last member have."""


LENGTH, COUNT = 6.0, 16
COLUMN = {"A": 1e-2, "Iy": 1e-7, "Iz": 1e-7, "J": 1e-7}
EI, EA = E * 1e-7, E * 1e-2
EULER = np.pi**2 * EI / LENGTH**2


def column(ends: Ends, count: int = COUNT, **parts: Any) -> rga.Model:
    """A straight member along x in some parts: pushed, loaded across, and warmed."""
    left, right, first, last = ends
    parts_of = [f"m{k}" for k in range(count)]
    common = {"section": "column", "material": "steel", "kind": "frame", "groups": ["all"]}
    members: dict[str, Any] = {
        name: {"nodes": [f"n{k}", f"n{k + 1}"], **common} for k, name in enumerate(parts_of)
    }
    members["m0"] |= first
    members[parts_of[-1]] |= last
    end, half = f"n{count}", count // 2
    fibre = {"kind": "strain", "z": 0.1, "at": 0.0, "unit": "strain"}
    content: dict[str, Any] = {
        "sections": {"column": COLUMN},
        "nodes": {f"n{k}": [LENGTH * k / count, 0, 0] for k in range(count + 1)},
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
            "quarter": {**fibre, "member": f"m{count // 4}", "at": 0.5},
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


@pytest.mark.parametrize(("count", "short"), [(4, 4.6e-3), (8, 2.7e-4)])
def test_more_members_meet_the_closed_form(count: int, short: float) -> None:
    """What `simulation.md` says of few members: deflections that are a little too small."""
    push, across = 0.9 * EULER, 0.1
    u = np.sqrt(push / EI) * LENGTH / 2
    moment = across * EI / push * (1 / np.cos(u) - 1)
    exact = moment / push - across * LENGTH**2 / (8 * push)
    simulator = rga.Simulator(column(PINNED, count))
    middle = simulator.predict({**STILL, "push": push, "across": across})[0, 0]
    assert (exact - middle) / exact == pytest.approx(short, rel=0.1)


@pytest.mark.parametrize(("turn", "off"), [(0.05, 1.1e-3), (0.1, 4.6e-3), (0.2, 1.85e-2)])
def test_a_cantilever_that_turns_far(turn: float, off: float) -> None:
    """The elastica, Timoshenko and Gere, section 2.7: what `simulation.md` says is off."""

    def along(root: float, weight: Any) -> float:
        angle = turn - root**2
        return float(weight(angle) * 2 * root / np.sqrt(2 * (np.sin(turn) - np.sin(angle))))

    reach, rise = (
        quad(along, 1e-9, np.sqrt(turn), args=(weight,))[0] for weight in (np.ones_like, np.sin)
    )
    bent = column(
        (FIXED, ["uy"], {}, {}),
        effects={"side": force({f"n{COUNT}": [0, 0, 1]}, "side")},
        context={"side": {"unit": "N", "range": [0, 1e3]}},
    )
    shown = rga.Simulator(bent).predict({"side": EI * (reach / LENGTH) ** 2})[0]
    end = dict(zip(bent.sensors, shown, strict=True))["end"]
    assert end / (LENGTH * rise / reach) - 1 == pytest.approx(off, rel=0.05)
