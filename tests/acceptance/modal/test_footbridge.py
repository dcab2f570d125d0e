"""A measured steel footbridge: its modes have their names by shape, and trade places in the model.

The model is that of the owners' program, read back from its matrices; the modes were measured at 58
channels. Expected figures are those that the shared data state.
"""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.diagnosis import diagnose_modes
from rga.model import Model, read_model
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.simulator import ModalSimulator

DATA = Path(__file__).parents[4] / "shared" / "measured" / "footbridge" / "footbridge.json"
pytestmark = pytest.mark.skipif(not DATA.exists(), reason="the shared measurements are not here")
#: of what sections are made: stiffnesses are given, not sections
MODULUS, RATIO = 2e11, 0.3
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
WEST = ("n2", "n3")
#: scatter of a frequency of the model that is right in everything that one asks for
SCATTER = 0.01


@cache
def content() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(DATA.read_text())
    return found


def section(member: dict[str, Any]) -> dict[str, float]:
    shear = MODULUS / (2 * (1 + RATIO))
    own = {"A": member["EA"] / MODULUS}
    if member["kind"] == "frame":
        own |= {"Iy": member["EIy"] / MODULUS, "Iz": member["EIz"] / MODULUS}
        own |= {"J": member["GJ"] / shear}
    return own


def footbridge(**factors: float) -> Model:
    """The model, its lateral bearings times a factor at the `west` or `east` end."""
    data = content()
    sections = [section(member) for member in data["members"]]
    fixed: dict[str, list[str]] = {}
    for node, dof in data["fixed"]:
        fixed.setdefault(node, []).append(DOFS[dof])
    end = {True: factors.get("west", 1.0), False: factors.get("east", 1.0)}
    measured = data["measured"]
    channels = [f"{node} {dof}" for node, dof in measured["channels"]]
    shapes = np.array(measured["shapes"])
    model = {
        "rga_model": 1,
        "name": "footbridge",
        "materials": {"steel": {"E": MODULUS, "nu": RATIO}},
        "sections": {f"s{number}": one for number, one in enumerate(sections)},
        "nodes": data["nodes"],
        "members": {
            f"m{number}": {
                "nodes": [one["a"], one["b"]], "section": f"s{number}", "material": "steel",
                "kind": one["kind"], "groups": [one["group"]],
            }
            for number, one in enumerate(data["members"])
        },
        "supports": {node: {"node": node, "fixed": dofs} for node, dofs in fixed.items()},
        "springs": [
            {
                "node": one["node"], "dof": f"u{one['dof']}",
                "stiffness": one["k"] * (end[one["node"] in WEST] if one["dof"] == "y" else 1.0),
            }
            for one in data["springs"]
        ],
        "masses": {node: {"node": node, "mass": mass} for node, mass in data["masses"].items()},
        "points": {
            name: {"node": node, "direction": [float(dof == axis) for axis in DOFS[:3]]}
            for name, (node, dof) in zip(channels, measured["channels"], strict=True)
        },
        "modes": {
            name: {"near": near, "within": 0.2, "shape": dict(zip(channels, shape, strict=True))}
            for name, near, shape in zip("abcde", measured["f"], shapes.T.tolist(), strict=True)
        },
        "sensors": {
            f"f {name}": {"kind": "frequency", "mode": name, "unit": "Hz"} for name in "abcde"
        },
    }  # fmt: skip
    return read_model(model, str(DATA))


def misfit(predicted: FloatArray) -> float:
    """Squares of the relative differences of frequencies, in their scatter."""
    return float(np.sum((np.log(predicted / content()["measured"]["f"]) / SCATTER) ** 2))


def test_the_model_repeats_the_frequencies_of_its_owners_and_their_shapes() -> None:
    pairing, frequencies, _ = ModalSimulator(footbridge()).pair()
    np.testing.assert_allclose(frequencies[:5], [4.660, 4.875, 6.654, 9.901, 11.381], rtol=0.0025)
    assert pairing.computed.tolist() == [1, 0, 2, 3, 4]
    assert pairing.others == ()
    mac = pairing.mac[np.arange(5), pairing.computed]
    np.testing.assert_allclose(mac, [0.97, 0.99, 0.95, 0.97, 0.90], atol=0.006)


def modal_record(model: Model) -> ModalRecord:
    """The five modes as one window, by the scatter of one test."""
    measured = content()["measured"]
    nothing = np.full(5, np.nan)
    return ModalRecord(
        time=np.zeros(5), start=0.0, duration=nothing, frequency=np.array(measured["f"]),
        frequency_sd=np.array(measured["sd_f"]), damping=nothing, points=tuple(model.points),
        shapes=np.array(measured["shapes"]).T, realness=np.ones(5), hint=("",) * 5, contexts={},
        left_out=(), sha256="",
    )  # fmt: skip


@pytest.mark.thorough
def test_the_diagnosis_finds_the_lateral_bearings_of_the_west_end() -> None:
    """And neither modulus, mass, deck nor frame, which would be named by the order of the modes."""
    model = footbridge()
    findings = diagnose_modes(model, modal_record(model))
    assert findings.verdict == "partial"
    (cause,) = findings.causes
    assert (cause.effect["kind"], cause.effect["dof"]) == ("support_flexibility", "uy")
    assert set(cause.effect["node"]) == set(WEST)
    # Behind the spring of the model it leaves a fifth to a third of that.
    behind, own = cause.effect["stiffness"]["value"], 35e6
    assert 0.2 < behind / (behind + own) < 0.35
    rivals = [(one["kind"], one.get("dof"), len(one.get("node", []))) for one in cause.rivals]
    assert rivals == [("support_flexibility", "uy", 4)]
    assert findings.gap.after < 0.1 * findings.gap.before
    assert "mode c" in findings.unexplained.looks_like


def test_softer_bearings_at_the_west_end_explain_most_and_swap_the_modes_back() -> None:
    before = misfit(ModalSimulator(footbridge()).predict()[0])
    soft = ModalSimulator(footbridge(west=0.27))
    after = misfit(soft.predict()[0])
    assert 500 < before < 700
    assert after < 0.12 * before
    assert soft.pair()[0].computed.tolist() == [0, 1, 2, 3, 4]


def test_shapes_refuse_what_frequencies_alone_would_take() -> None:
    """Softer bearings at the east end move the frequencies nearly as well."""
    look = {}
    for end, factor in (("west", 0.27), ("east", 0.15)):
        simulator = ModalSimulator(footbridge(**{end: factor}))
        assert misfit(simulator.predict()[0]) < 70
        pairing, _, _ = simulator.pair()
        look[end] = pairing.mac[np.arange(5), pairing.computed]
    assert look["west"].min() > 0.89
    assert look["east"].min() < 0.75
