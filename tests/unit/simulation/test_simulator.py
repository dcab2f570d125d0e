"""The simulator: closed forms, superposition, onsets, axles, friction."""

from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import read_model
from rga.simulation import Simulator

L, EA, ALPHA = 5.0, 2e9, 1.2e-5


def bar(**more: Any) -> dict[str, Any]:
    """A bar of length L [m] along x, fixed on the left, pulled at the right by `pull` [N]."""
    return {
        "rga_model": 1,
        "name": "bar",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": ALPHA}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": {"A": [0, 0, 0], "B": [L, 0, 0]},
        "members": {
            "AB": {"nodes": ["A", "B"], "section": "bar", "material": "steel", "groups": ["all"]}
        },
        "supports": {
            "A": {"node": "A", "fixed": ["ux", "uy", "uz"]},
            "B": {"node": "B", "fixed": ["uy", "uz"]},
        },
        "context": {
            "pull": {"unit": "N", "range": [0, 1e6]},
            "temperature": {"unit": "degC", "range": [-20, 40]},
        },
        "effects": {
            "pull": {
                "kind": "nodal_load",
                "forces": {"B": [1, 0, 0]},
                "factor": {"context": "pull"},
            },
            "warmth": {
                "kind": "temperature",
                "groups": {"all": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
        },
        "sensors": {
            "u": {"kind": "displacement", "node": "B", "direction": [1, 0, 0], "unit": "mm"},
            "e": {"kind": "strain", "member": "AB", "unit": "microstrain"},
            "t": {"kind": "strain", "member": "AB", "unit": "microstrain", "total": True},
            "r": {"kind": "reaction", "node": "A", "direction": [1, 0, 0], "unit": "kN"},
        },
        **more,
    }


def with_effect(**effect: Any) -> Simulator:
    content = bar()
    content["effects"]["hidden"] = effect
    return Simulator(read_model(content, "test"))


def test_a_bar_by_hand() -> None:
    pull, dt = 1e5, 20.0
    (shown,) = Simulator(read_model(bar(), "test")).predict({"pull": pull, "temperature": 10 + dt})
    strain = pull / EA
    expected = [
        (strain + ALPHA * dt) * L * 1e3,
        strain * 1e6,
        (strain + ALPHA * dt) * 1e6,
        -pull / 1e3,
    ]
    assert shown == pytest.approx(expected, rel=1e-12)


def test_superposition() -> None:
    simulator = Simulator(read_model(bar(), "test"))
    both, one, other = simulator.predict({"pull": [3e4, 3e4, 0], "temperature": [25, 10, 25]})
    assert both == pytest.approx(one + other, rel=1e-12)


def test_a_frozen_bearing_by_hand() -> None:
    stiffness = 4e8
    simulator = with_effect(kind="support_spring", support="B", dof="ux", stiffness=stiffness)
    (shown,) = simulator.predict({"pull": 1e5, "temperature": 10.0})
    assert shown[0] == pytest.approx(1e5 / (EA / L + stiffness) * 1e3, rel=1e-12)


def test_a_bearing_that_slides_dissipates() -> None:
    """A push and its release leave what friction holds back, as a block on a spring does."""
    mu, weight = 0.1, 1e5
    held = mu * weight
    simulator = with_effect(
        kind="bearing_friction", support="B", dof="ux", mu=mu, permanent_force=weight
    )
    pull = np.array([0.0, 5e3, 3e4, 0.0])
    shown = simulator.predict({"pull": pull, "temperature": np.full(4, 10.0)})[:, 0]
    forces = np.array([0.0, 0.0, 3e4 - held, held])
    assert shown == pytest.approx(forces / (EA / L) * 1e3, abs=1e-12)


def test_reactions_with_friction_balance_the_load() -> None:
    content = bar()
    for name, node in (("far", "A"), ("near", "B")):
        content["sensors"][name] = {
            "kind": "reaction", "node": node, "direction": [1, 0, 0], "unit": "N",
        }  # fmt: skip
    content["effects"]["rests"] = {
        "kind": "bearing_friction", "support": "B", "dof": "ux", "mu": 0.1, "permanent_force": 1e5,
    }  # fmt: skip
    pull = np.array([0.0, 5e3, 3e4, 0.0])
    shown = Simulator(read_model(content, "test")).predict({"pull": pull, "temperature": 10.0})
    far, near = shown[:, -2], shown[:, -1]
    assert near == pytest.approx([0.0, -5e3, -1e4, 1e4], abs=1e-6)
    assert far + near + pull == pytest.approx(np.zeros(4), abs=1e-6)


@pytest.mark.parametrize(
    ("effect", "half"),
    [
        ({"kind": "sensor_bias", "sensor": "u", "offset": 2.0}, 1.0),
        ({"kind": "sensor_bias", "sensor": "u", "offset": 2.0, "profile": "ramp"}, 0.5),
    ],
)
def test_onsets(effect: dict[str, Any], half: float) -> None:
    simulator = with_effect(**effect, onset=10.0, end=20.0)
    time = np.array([0.0, 9.0, 15.0, 20.0])
    shown = simulator.predict({"time": time, "pull": 0.0, "temperature": 10.0})[:, 0]
    assert shown == pytest.approx([0.0, 0.0, 2.0 * half, 2.0])


def test_a_stiffness_with_an_onset() -> None:
    simulator = with_effect(kind="member_stiffness", member="AB", factor=0.5, onset=1.0)
    shown = simulator.predict({"time": [0.0, 1.0], "pull": 1e5, "temperature": 10.0})[:, 0]
    assert shown[1] == pytest.approx(2 * shown[0], rel=1e-12)


def test_axles_share_by_the_lever_rule_and_reverse() -> None:
    content = bar()
    content["context"]["train"] = {"unit": "m", "range": [-10, 20]}
    content["effects"]["pull"] = {
        "kind": "axle_load",
        "path": ["A", "B"],
        "forces": [100.0, 50.0],
        "offsets": [0.0, 2.0],
        "direction": [1, 0, 0],
        "position": {"context": "train"},
    }
    simulator = Simulator(read_model(content, "test"))
    forward = simulator.predict({"train": [-1.0, 1.0, 4.0, 5.5], "temperature": 10.0})[:, 0]
    shares = [0.0, 100 * 1 / L, 100 * 4 / L + 50 * 2 / L, 50 * 3.5 / L]
    assert forward == pytest.approx(np.array(shares) / (EA / L) * 1e3, abs=1e-15)
    backward = simulator.predict({"train": [4.0, 1.0, -1.0], "temperature": 10.0})[:, 0]
    shares = [100 * 4 / L, 100 * 1 / L + 50 * 3 / L, 50 * 1 / L]
    assert backward == pytest.approx(np.array(shares) / (EA / L) * 1e3, abs=1e-15)


def test_the_jacobian_of_a_linear_response() -> None:
    jacobian = Simulator(read_model(bar(), "test")).jacobian({"pull": 1e5, "temperature": 20.0})
    assert jacobian[0, 0] == pytest.approx([L / EA * 1e3, ALPHA * L * 1e3], rel=1e-9)


def test_contexts_that_are_missing_or_not_finite() -> None:
    simulator = Simulator(read_model(bar(), "test"))
    with pytest.raises(InputError, match="'temperature' is missing"):
        simulator.predict({"pull": 1.0})
    with pytest.raises(InputError, match="row 2"):
        simulator.predict({"pull": [1.0, float("nan")], "temperature": 1.0})


@pytest.mark.parametrize("pull", [np.array(["2020"], "datetime64[D]"), ["1"], [True], [10**400]])
def test_contexts_that_are_no_numbers(pull: object) -> None:
    simulator = Simulator(read_model(bar(), "test"))
    with pytest.raises(InputError, match="'pull' holds no numbers"):
        simulator.predict({"pull": pull, "temperature": 1.0})  # type: ignore[dict-item]


def test_same_bits_again() -> None:
    simulator = Simulator(read_model(bar(), "test"))
    contexts = {"pull": np.linspace(0, 1e5, 50), "temperature": np.linspace(-10, 30, 50)}
    assert (simulator.predict(contexts) == simulator.predict(contexts)).all()


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_support_that_gives_way_later_is_rigid_until_then() -> None:
    effect = {"kind": "support_flexibility", "support": "A", "dof": "ux", "stiffness": 1e7}
    simulator = with_effect(**effect, onset=5.0)
    before = simulator.predict({"time": [0.0, 1.0], "pull": 1e5, "temperature": 10.0})[:, 0]
    assert before == pytest.approx(1e3 * 1e5 * L / EA)
    after = simulator.predict({"time": [4.0, 5.0], "pull": 1e5, "temperature": 10.0})[:, 0]
    assert after == pytest.approx([before[0], before[0] + 1e3 * 1e5 / 1e7])
