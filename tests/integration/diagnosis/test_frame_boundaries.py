"""What a frame gets wrong at its bases, joints and sections: found, and nothing where all is right.

The readings come from physics of their own (rga_bench.synthetic.physics.frame).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from findings_invariants import check_invariants
from rga.diagnosis.search.hypothesis import hypotheses
from rga.findings.phrases import effect_words
from rga.model import Effect, Model, read_effect, read_model
from rga.records.record import Record
from rga.report.pages.cards import values
from rga.simulation import Simulator
from rga.simulation.perturbation.trials import Vicinity
from rga_bench.synthetic.noise import autoregressive, stream
from rga_bench.synthetic.physics.frame import (
    Array,
    Frame,
    FrameSpring,
    Geometry,
    Stiffness,
    deformation_stiffness,
)

E, NU = 2.1e11, 0.3
AREA, BENDS, TWISTS = 78e-4, 57e-6, 6e-7
HEIGHT, SPAN, FLANGE = 4.0, 6.0, 0.1
ROWS = 120
NODES = {
    "W": [0, 0, 0],
    "TW": [0, 0, HEIGHT],
    "M": [SPAN / 2, 0, HEIGHT],
    "TE": [SPAN, 0, HEIGHT],
    "E": [SPAN, 0, 0],
}
MEMBERS = {"west": "W TW", "beam 1": "TW M", "beam 2": "M TE", "east": "E TE"}
MOVES = {"ux": [1, 0, 0], "uz": [0, 0, 1]}
SD = {"mm": 0.05, "mrad": 0.03, "microstrain": 2.0}
#: standard deviations of EA and EI of the members as built, and of the channels' gains
BUILT, GAIN = 0.005, 0.002


def portal(base: tuple[str, ...] = ("ux", "uz", "ry"), **more: Any) -> Model:
    """A portal frame under a horizontal and a vertical force, its beam drawn as two members."""
    steel = {"section": "HEB", "material": "steel", "kind": "frame"}
    content = {
        "rga_model": 1,
        "name": "portal",
        "plane": "xz",
        "materials": {"steel": {"E": E, "nu": NU, "alpha": 1.2e-5}},
        "sections": {"HEB": {"A": AREA, "Iy": BENDS, "Iz": BENDS / 3, "J": TWISTS}},
        "nodes": NODES,
        "members": {
            name: {"nodes": nodes.split(), "groups": [name.split()[0]], **steel}
            for name, nodes in MEMBERS.items()
        },
        "supports": {
            "west base": {"node": "W", "fixed": [*base]},
            "east base": {"node": "E", "fixed": ["ux", "uz", "ry"]},
        },
        "context": {
            "wind": {"unit": "kN", "range": [-30, 30], "noise": 0.03},
            "weight": {"unit": "kN", "range": [0, 80], "noise": 0.05},
        },
        "effects": {
            "wind": {
                "kind": "nodal_load",
                "forces": {"TW": [1e3, 0, 0]},
                "factor": {"context": "wind"},
            },
            "weight": {
                "kind": "nodal_load",
                "forces": {"M": [0, 0, -1e3]},
                "factor": {"context": "weight"},
            },
        },
        "sensors": {
            **{
                f"{node} {dof}": {
                    "kind": "displacement", "node": node, "direction": MOVES[dof], "unit": "mm"
                }
                for node, dof in (("TW", "ux"), ("TE", "ux"), ("M", "uz"))
            },
            **{
                f"{node} tilt": {
                    "kind": "rotation", "node": node, "direction": [0, 1, 0], "unit": "mrad"
                }
                for node in ("TW", "TE")
            },
            **{
                f"{member} {at}": {
                    "kind": "strain", "member": member, "at": at, "z": z, "unit": "microstrain"
                }
                for member, at, z in (
                    ("west", 0.1, FLANGE),
                    ("west", 0.9, FLANGE),
                    ("east", 0.1, -FLANGE),
                    ("east", 0.9, FLANGE),
                    ("beam 1", 0.15, FLANGE),
                    ("beam 1", 0.9, -FLANGE),
                    ("beam 2", 0.85, FLANGE),
                )
            },
        },
        **more,
    }  # fmt: skip
    return read_model(content, "portal")


@dataclass(frozen=True)
class Truth:
    """What the frame is in truth.

    Attributes:
        base: rotational stiffness of the west base [N m/rad].
        joint: of the joint between the west column and the beam [N m/rad].
        bending: factors on EI, by member.
        off: how far gauges sit off their fibre along local z [m], by sensor.
    """

    base: float = np.inf
    joint: float = np.inf
    bending: dict[str, float] = field(default_factory=dict)
    off: dict[str, float] = field(default_factory=dict)

    def per_force(self, model: Model, build: Array) -> Array:
        """Readings under 1 kN of wind and of weight, float[2, sensors].

        Args:
            build: factors on EA and EI of the members as built.
        """
        # The beam begins at a node of its own, in the place of TW.
        names = [*NODES, "beam"]
        xyz = np.array([*NODES.values(), NODES["TW"]], dtype=float)
        ends = np.array([[names.index(n) for n in one.split()] for one in MEMBERS.values()])
        ends[1, 0] = names.index("beam")
        count = len(ends)
        geometry = Geometry.of(xyz, ends)
        bend = build * [self.bending.get(name, 1.0) for name in MEMBERS]
        section = Stiffness(
            E * AREA * build, E * BENDS * bend, E * BENDS / 3 * bend,
            np.full(count, E / 2 / (1 + NU) * TWISTS), np.full(count, np.inf),
        )  # fmt: skip
        held = {6 * node + dof for node in range(len(names)) for dof in (1, 3, 5)}
        held |= {6 * names.index(node) + dof for node in "WE" for dof in (0, 2, 4)}
        top, beam, foot = (6 * names.index(node) for node in ("TW", "beam", "W"))
        springs = [FrameSpring(top + dof, beam + dof, 1e12) for dof in (0, 2)]
        springs.append(FrameSpring(top + 4, beam + 4, min(self.joint, 1e12)))
        if np.isfinite(self.base):
            held.remove(foot + 4)
            springs.append(FrameSpring(foot + 4, None, self.base))
        frame = Frame.build(geometry, section, held, springs)
        force = np.zeros((len(frame.stiffness), 2))
        force[top, 0] = 1e3
        force[6 * names.index("M") + 2, 1] = -1e3
        u = frame.solve(force, np.zeros((count, 2))).u
        shape = geometry.modes @ u[geometry.dofs]
        moments = (deformation_stiffness(geometry.length, section) @ shape)[:, 4:]
        read = []
        for name, one in model.sensors.items():
            if one.kind != "strain":
                dof = 6 * names.index(str(one.node)) + (4 if one.kind == "rotation" else 0)
                dof += 2 if name == "M uz" else 0
                read.append(1e3 * u[dof])
                continue
            number = list(MEMBERS).index(str(one.member))
            moment = (1 - one.at) * -moments[number, 0] + one.at * moments[number, 1]
            long = shape[number, 0] / geometry.length[number]
            z = one.z + self.off.get(name, 0.0)
            read.append(1e6 * (long + z * moment / section.ei_y[number]))
        return np.array(read).T

    def record(self, model: Model, seed: int = 1) -> Record:
        """A record of the frame as built: two loads that vary, noise with memory."""
        rng = stream(seed, "portal")
        t = np.arange(ROWS)
        wind = 8 * np.sin(2 * np.pi * t / 37) + rng.normal(0, 4, ROWS)
        weight = 30 + 10 * np.cos(2 * np.pi * t / 53) + rng.normal(0, 4, ROWS)
        sd = np.array([SD[one.unit] for one in model.sensors.values()])
        gain, build = rng.normal(1.0, GAIN, len(sd)), rng.normal(1.0, BUILT, len(MEMBERS))
        shown = np.column_stack([wind, weight]) @ self.per_force(model, build) * gain
        shown += autoregressive(rng, ROWS, sd, np.full(len(sd), 0.5))
        measured = {
            "wind": wind + rng.normal(0, 0.03, ROWS),
            "weight": weight + rng.normal(0, 0.05, ROWS),
        }
        return Record(60.0 * t, 0.0, "seconds", tuple(model.sensors), shown, measured)


PINNED = ("ux", "uz")
OFF = "beam 1 0.15"
BASE = {"kind": "support_flexibility", "support": "west base", "dof": "ry"}
HOLDS = {**BASE, "kind": "support_spring"}
JOINT = {"kind": "end_flexibility", "member": "beam 1", "at_end": "i"}
THINNER = {"kind": "bending_stiffness", "member": "west"}
GAUGE = {"kind": "gauge_position", "sensor": OFF}
#: what is hidden, how the model has the west base, the cause that tells it, its parameter
HIDDEN = {
    "a soft base": (Truth(base=1.2e7), ("ux", "uz", "ry"), BASE, "stiffness", 1.2e7),
    "a pin that holds": (Truth(base=3e6), PINNED, HOLDS, "stiffness", 3e6),
    "a semi-rigid joint": (Truth(joint=2e7), ("ux", "uz", "ry"), JOINT, "stiffness", 2e7),
    "EI lost": (Truth(bending={"west": 0.75}), ("ux", "uz", "ry"), THINNER, "factor", 0.75),
    "a gauge off its fibre": (Truth(off={OFF: -0.05}), ("ux", "uz", "ry"), GAUGE, "z", -0.05),
}
hidden_ones = pytest.mark.parametrize("hidden", HIDDEN)


def simulated(model: Model, effect: dict[str, Any] | None) -> Array:
    """Readings under 1 kN of wind and of weight, float[2, sensors]."""
    more = {} if effect is None else {"hidden": read_effect(effect, "hidden")}
    loads = {"time": np.arange(2.0), "wind": np.array([1.0, 0.0]), "weight": np.array([0.0, 1.0])}
    return Simulator(model.extended(more)).predict(loads)


@hidden_ones
def test_the_simulation_is_that_of_other_physics(hidden: str) -> None:
    truth, fixed, place, parameter, value = HIDDEN[hidden]
    model = portal(fixed)
    expected = truth.per_force(model, np.ones(len(MEMBERS)))
    scale = np.abs(expected).max()
    found = simulated(model, {**place, parameter: value})
    # The springs that stand for rigid joints there are not quite rigid.
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5 * scale)
    assert np.abs(simulated(model, None) - expected).max() > 1e-2 * scale


@hidden_ones
def test_what_is_hidden_is_found(hidden: str) -> None:
    truth, fixed, place, parameter, value = HIDDEN[hidden]
    model = portal(fixed)
    findings = rga.diagnose(model, truth.record(model))
    check_invariants(findings)
    assert findings.verdict == "named"
    (cause,) = findings.causes
    assert {name: cause.effect[name] for name in place} == place
    low, high = cause.effect[parameter]["ci90"]
    middle, width = (low + high) / 2, high - low
    assert abs(value - middle) < width
    estimated = [name for name, one in cause.effect.items() if isinstance(one, dict)]
    assert estimated == [parameter]


@pytest.mark.parametrize("hidden", ["a semi-rigid joint", "a gauge off its fibre"])
def test_its_report_is_written(hidden: str, tmp_path: Path) -> None:
    truth, fixed, place, *_ = HIDDEN[hidden]
    model = portal(fixed)
    rga.diagnose(model, truth.record(model)).write(tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert all(str(name).replace("_", " ") in page for name in place.values())


@pytest.mark.parametrize("fixed", [("ux", "uz", "ry"), PINNED])
def test_a_frame_as_modelled_is_left_alone(fixed: tuple[str, ...]) -> None:
    model = portal(fixed)
    findings = rga.diagnose(model, Truth(base=np.inf if "ry" in fixed else 1.0).record(model))
    check_invariants(findings)
    assert findings.causes == []
    assert findings.verdict == "nothing_wrong"


def of_kind(model: Model, kind: str) -> list[dict[str, Any]]:
    """Places at which a kind is proposed."""
    proposed = hypotheses(model, list(model.sensors), set(model.context))
    return [dict(one.place) for one in proposed if one.name == kind]


def test_rotations_are_proposed_where_a_member_bends_with_them() -> None:
    rotation = [{"support": name, "dof": "ry"} for name in ("west base", "east base")]
    model = portal()
    assert [one for one in of_kind(model, "support_flexibility") if one["dof"][0] == "r"] == [
        *rotation,
        {"support": ["west base", "east base"], "dof": "ry"},
    ]
    assert of_kind(model, "support_spring") == []
    assert of_kind(portal(PINNED), "support_spring") == [rotation[0]]
    west = model.members["west"]
    for change in ({"kind": "truss"}, {"releases": {"i": ["ry"]}}):
        loose = type(west).model_validate({**west.model_dump(), **change})
        pinned = model.model_copy(update={"members": {**model.members, "west": loose}})
        places = of_kind(pinned, "support_flexibility")
        assert [one for one in places if one["dof"] == "ry"] == [rotation[1]]


def test_a_base_in_space_may_turn_about_both_axes_of_bending() -> None:
    fixed = ["ux", "uy", "uz", "rx", "ry", "rz"]
    bases = {"west base": {"node": "W", "fixed": fixed}, "east base": {"node": "E", "fixed": fixed}}
    places = of_kind(portal(plane=None, supports=bases), "support_flexibility")
    assert {one["dof"] for one in places} == {"ux", "uy", "uz", "rx", "ry"}  # rz twists a column


def test_joints_are_where_the_beam_meets_the_columns() -> None:
    assert of_kind(portal(), "end_flexibility") == [
        {"member": "beam 1", "at_end": "i"},
        {"member": "beam 2", "at_end": "j"},
        {"group": "beam"},
    ]


def test_an_end_at_which_a_member_runs_on_stays_rigid() -> None:
    model = portal()
    group = simulated(model, {"kind": "end_flexibility", "group": "beam", "stiffness": 2e7})
    ends = {
        name: read_effect(
            {"kind": "end_flexibility", "member": name, "at_end": end, "stiffness": 2e7}, name
        )
        for name, end in (("beam 1", "i"), ("beam 2", "j"))
    }
    np.testing.assert_allclose(group, simulated(model.extended(ends), None), rtol=1e-12)
    middle = {"kind": "end_flexibility", "member": "beam 1", "at_end": "j", "stiffness": 2e7}
    np.testing.assert_array_equal(simulated(model, middle), simulated(model, None))


def test_stiffnesses_of_rotations_have_their_own_unit() -> None:
    effect = {**BASE, "stiffness": {"value": 1.2e7, "ci90": [1.1e7, 1.3e7]}}
    assert effect_words(effect).endswith("stiffness 12 [11, 13] MN m/rad")
    assert effect_words({**effect, "dof": "uz"}).endswith("stiffness 12 [11, 13] MN/m")
    ((_, shown),) = values(effect, portal())
    assert "MN m/rad" in shown.replace("\u00a0", " ")


def trials(model: Model) -> Iterator[Effect]:
    """Every candidate at trial values, and from an onset on."""
    for one in hypotheses(model, list(model.sensors), set(model.context)):
        chosen = list(product(*(prior.trials for prior in one.priors.values())))
        yield from (one.effect(z) for z in chosen)
        yield one.beginning(600.0, "ramp").effect(chosen[0])


def test_every_trial_on_a_frame_reads_as_its_own_simulator() -> None:
    model = portal()
    draw = np.random.default_rng(5)
    contexts = {"time": 60.0 * np.arange(20)}
    contexts |= {name: draw.uniform(*one.range, 20) for name, one in model.context.items()}
    about = Vicinity(Simulator(model), contexts)
    scale = np.abs(about.read).max(0)
    for effect in trials(model):
        trial, response = about.trial({"trial": effect})
        apart = np.abs(trial.read(response) - trial.predict(contexts)).max(0)
        assert (apart < 1e-9 * scale).all(), effect
