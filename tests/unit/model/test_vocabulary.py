"""Every kind of the vocabulary: its keys, its places, and that it does nothing unless told to."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rga.errors import InputError
from rga.model import Effect, Model, read_model
from rga.simulation import Simulator

HOUR = 3600.0
ROWS = 24
#: Contexts of the small bridge, float[rows] each; `knob` drives the parameter under test.
ROW = np.arange(ROWS)
CONTEXTS: dict[str, NDArray[np.float64]] = {
    "time": HOUR * ROW,
    "temperature": 12 + 9 * np.sin(0.7 * ROW),
    "crowd": 20 + 15 * np.cos(1.3 * ROW),
    "cart": 4 + 3.5 * np.sin(1.9 * ROW),
    "wind": 100 * np.cos(0.9 * ROW) ** 2,
    "knob": np.ones(ROWS),
}


def bridge(**effects: Any) -> Model:
    """Two pinned trusses of two panels, 4 m apart, with girders and a stringer that bend."""
    nodes = {
        f"{name}{side}": [x, y, z]
        for side, y in (("s", -2.0), ("n", 2.0))
        for name, x, z in (("a", 0, 0), ("b", 4, 0), ("c", 8, 0), ("t", 4, 3))
    }
    pinned = {
        "bottom": ["as-bs", "bs-cs", "an-bn", "bn-cn"],
        "webs": ["as-ts", "ts-cs", "an-tn", "tn-cn", "bs-ts", "bn-tn"],
        "bracing": ["as-bn", "an-bs", "bs-cn", "bn-cs", "bs-tn", "bn-ts", "ts-tn"],
    }
    members = {
        bar: {"nodes": bar.split("-"), "section": "bar", "material": "steel", "groups": [group]}
        for group, bars in pinned.items()
        for bar in bars
    }
    for girder in ("as-an", "bs-bn", "cs-cn"):
        members[girder] = {
            "nodes": girder.split("-"),
            "section": "girder",
            "material": "iron",
            "kind": "frame",
            "groups": ["floor"],
            "releases": {"i": ["rx"], "j": ["rx"]},
        }
    for first, last in ("ab", "bc"):
        members[f"stringer {first}{last}"] = {
            "nodes": [f"{first}s", f"{last}s"],
            "section": "girder",
            "material": "iron",
            "kind": "frame",
            "groups": ["stringer"],
        }
    down = {"unit": "mm", "kind": "displacement"}
    content = {
        "rga_model": 1,
        "name": "every kind",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}, "iron": {"E": 1e11, "alpha": 1e-5}},
        "sections": {
            "bar": {"A": 0.004, "Iy": 4e-6, "Iz": 4e-6, "J": 1e-6},
            "girder": {"A": 0.01, "Iy": 8e-5, "Iz": 6e-5, "J": 1e-5},
        },
        "nodes": nodes,
        "members": members,
        "supports": {
            "A": {"node": "as", "fixed": ["ux", "uy", "uz"]},
            "B": {"node": "an", "fixed": ["ux", "uz"]},
            "C": {"node": "cs", "fixed": ["uy", "uz"]},
            "D": {"node": "cn", "fixed": ["uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40]},
            "crowd": {"unit": "kN", "range": [0, 50]},
            "cart": {"unit": "m", "range": [0, 8]},
            "wind": {"unit": "Pa", "range": [0, 500]},
            "knob": {"unit": "-", "range": [0.5, 1.5]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {
                    "bottom": 1.0,
                    "webs": 0.8,
                    "bracing": 1.2,
                    "floor": 1.0,
                    "stringer": 1.0,
                },
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "people": {
                "kind": "nodal_load",
                "forces": {"bs": [0, 0, -800], "bn": [0, 300, -600]},
                "factor": {"context": "crowd"},
            },
            "cart": {
                "kind": "axle_load",
                "path": ["as", "bs", "cs"],
                "forces": [3e4, 2e4],
                "offsets": [0.0, 1.0],
                "position": {"context": "cart"},
            },
            "tank": {"kind": "nodal_load", "forces": {"tn": [500, 0, -2e4]}},
            "snow": {
                "kind": "member_load",
                "member": ["bs-bn", "as-an"],
                "uniform": [0, 500, -2e3],
            },
            **effects,
        },
        "sensors": {
            "D1": {**down, "node": "bs", "direction": [0, 0, 1]},
            "D2": {**down, "node": "tn", "direction": [0, 1, 0]},
            "D3": {**down, "node": "cs", "direction": [1, 0, 0]},
            "D4": {**down, "node": "cn", "direction": [1, 0, 0]},
            "S1": {"kind": "strain", "member": "as-bs", "unit": "microstrain"},
            "S2": {"kind": "strain", "member": "bs-bn", "unit": "microstrain", "y": 0.1},
            "S3": {"kind": "strain", "member": "bs-tn", "unit": "microstrain"},
            "F1": {"kind": "force", "member": "an-tn", "unit": "kN"},
            "R1": {"kind": "reaction", "node": "an", "direction": [0, 0, 1], "unit": "kN"},
            "T1": {"kind": "rotation", "node": "bn", "direction": [1, 0, 0], "unit": "mrad"},
        },
    }
    return read_model(content, "test")


def readings(model: Model, **changes: Any) -> NDArray[np.float64]:
    return Simulator(model).predict({**CONTEXTS, **changes})


@dataclass(frozen=True)
class Case:
    """A kind with one of its parameters.

    Attributes:
        kind, parameter: as in a model file.
        places: the forms that its place has; a list of parts shares one parameter.
        value, neutral: of the parameter; at the neutral one nothing changes.
        more: further keys.
        waits: before an onset nothing is changed, after it everything as without an onset.
    """

    kind: str
    parameter: str
    places: tuple[dict[str, Any], ...]
    value: float
    neutral: float | None = 0.0
    more: tuple[tuple[str, Any], ...] = ()
    waits: bool = True

    def effect(self, value: Any, place: int = 0, **more: Any) -> dict[str, Any]:
        return {
            "kind": self.kind,
            **self.places[place],
            **dict(self.more),
            self.parameter: value,
            **more,
        }


def forms(of: str, one: Any, *others: Any, **fixed: Any) -> tuple[dict[str, Any], ...]:
    """A place by name, a list of one, and a list of several."""
    return tuple({of: named, **fixed} for named in (one, [one], [one, *others]))


BARS = (*forms("member", "bs-tn", "bn-ts"), *forms("group", "bottom", "bracing"))
FRAMES = (*forms("member", "bs-bn", "as-an"), *forms("group", "floor"))
GROUPS = forms("group", "bottom", "bracing")
WIND = {"direction": (0, 1, 0), "context": "wind"}
CASES = [
    Case("elastic_modulus", "factor", forms("material", "steel", "iron"), 0.8, 1.0),
    Case("member_stiffness", "factor", BARS, 0.7, 1.0),
    Case("bending_stiffness", "factor", FRAMES, 0.7, 1.0),
    Case("stiffness_temperature", "rate", GROUPS, -0.01),
    Case("stiffness_temperature", "rate", GROUPS, 0.01, more=(("kink", 15.0),)),
    Case("added_axial_area", "area", GROUPS, 0.002),
    Case("floor_participation", "area", GROUPS, 0.003, more=(("connector_stiffness", 1e8),)),
    Case("joint_rigidity", "stiffness", GROUPS, 1e6),
    Case("end_flexibility", "stiffness", FRAMES, 1e6, None),
    Case("end_flexibility", "stiffness", FRAMES, 1e6, None, more=(("at_end", "i"),)),
    Case("rigid_end_zone", "length", forms("group", "floor"), 0.4),
    Case("joint_slip", "slip", BARS, 2e-4),
    Case("tension_only", "slack", BARS[:3], 1e-4, None),
    Case("support_spring", "stiffness", forms("support", "C", "D", dof="ux"), 1e7),
    Case("support_flexibility", "stiffness", forms("support", "C", "D", dof="uz"), 1e8, None),
    Case("support_settlement", "displacement", forms("support", "C", "D", dof="uz"), -0.002),
    Case("support_settlement", "displacement", forms("support", "A", "B", dof="ux"), 0.001),
    Case(
        "support_gap",
        "stiffness",
        forms("support", "C", "D", dof="ux"),
        1e8,
        more=(("gap", 2e-4),),
    ),
    Case(
        "bearing_friction",
        "mu",
        forms("support", "C", "D", dof="ux"),
        0.2,
        more=(("permanent_force", 2e4),),
        waits=False,
    ),
    Case("thermal_expansion", "factor", forms("material", "steel", "iron"), 1.3, 1.0),
    Case("thermal_gradient", "ratio", ({"axis": "vertical"}, {"axis": "lateral"}), 0.2),
    Case("thermal_gradient", "difference", ({"axis": "vertical"}, {"axis": "lateral"}), 4.0),
    Case("thermal_lag", "time_constant", ({},), 3.0, waits=False),
    Case("load_scale", "factor", forms("effect", "people", "cart"), 1.2, 1.0),
    Case("load_position", "offset", forms("effect", "cart"), 0.3),
    Case("load_eccentricity", "share", forms("effect", "people", "tank"), 0.1),
    Case("unmodelled_load", "rate", forms("group", "webs", "bottom", **WIND), 2.0),
    Case("dead_load", "force_per_length", GROUPS, 900.0),
    Case("creep", "amplitude", ({},), 0.3, waits=False),
    Case("sensor_bias", "offset", forms("sensor", "D1", "S1"), 0.5),
    Case("sensor_gain", "factor", forms("sensor", "D1", "S1"), -1.0, 1.0),
    Case("sensor_drift", "rate", forms("sensor", "D1", "S1"), 0.5, waits=False),
    Case("sensor_temperature", "rate", forms("sensor", "D1", "S1"), 0.02),
    Case("gauge_position", "y", forms("sensor", "S2"), 0.05),
    Case("gauge_position", "z", forms("sensor", "S2"), 0.05),
    Case("context_bias", "offset", forms("context", "temperature", "crowd"), 2.0),
    Case("context_gain", "factor", forms("context", "temperature", "crowd"), 1.1, 1.0),
    Case("clock_lag", "time", ({}, *forms("sensor", "D1", "S1")), 1000.0),
]
#: a tension that keeps a rod taut, and a spring that is no softer than the support
ALMOST = {"support_flexibility": 1e20, "end_flexibility": 1e20}


def name_of(case: Case) -> str:
    return f"{case.kind} {case.parameter}{dict(case.more) or ''}"


every = pytest.mark.parametrize("case", CASES, ids=name_of)


def test_no_kind_is_left_out() -> None:
    loads = {"temperature", "nodal_load", "member_load", "axle_load"}
    no_value = {"sensor_fault", "sensor_swap"}
    assert {case.kind for case in CASES} | loads | no_value == set(Effect.vocabulary)


@every
def test_each_place_shows_and_a_neutral_value_does_not(case: Case) -> None:
    plain = readings(bridge())
    scale = np.abs(plain).max(0)
    for place in range(len(case.places)):
        changed = readings(bridge(own=case.effect(case.value, place)))
        assert np.isfinite(changed).all()
        assert (np.abs(changed - plain) / scale).max() > 1e-5
        neutral = ALMOST.get(case.kind, case.neutral)
        if neutral is not None:
            same = readings(bridge(own=case.effect(neutral, place)))
            np.testing.assert_allclose(same, plain, rtol=1e-9, atol=1e-9 * scale.max())


@every
def test_a_list_of_places_shares_one_parameter(case: Case) -> None:
    for place in case.places:
        of, names = next(((k, v) for k, v in place.items() if isinstance(v, list)), ("", []))
        # A floor beside two groups is one chord, and another one beside each is two.
        if len(names) < 2 or case.kind == "floor_participation":
            continue
        shared = {"kind": case.kind, **place, **dict(case.more), case.parameter: case.value}
        apart = {f"own {name}": {**shared, of: name} for name in names}
        expected = readings(bridge(**apart))
        np.testing.assert_allclose(readings(bridge(own=shared)), expected, rtol=1e-9, atol=1e-9)


@every
def test_a_value_comes_as_a_number_an_estimate_or_from_a_context(case: Case) -> None:
    number = readings(bridge(own=case.effect(case.value)))
    ends = sorted([0.9 * case.value, 1.1 * case.value])
    estimate = {"value": case.value, "ci90": ends}
    np.testing.assert_array_equal(readings(bridge(own=case.effect(estimate))), number)
    driven = {"context": "knob", "times": case.value / 2, "minus": -1.0}
    followed = readings(bridge(own=case.effect(driven)))
    np.testing.assert_allclose(followed, number, rtol=1e-12, atol=1e-12 * np.abs(number).max())


@every
def test_an_onset_waits_and_a_ramp_ends_full(case: Case) -> None:
    if case.kind == "tension_only":
        return  # a member is a rod or it is none: an onset is refused
    plain, always = readings(bridge()), readings(bridge(own=case.effect(case.value)))
    onset, end = 6 * HOUR, 12 * HOUR
    scale = 1e-9 * np.abs(always).max()
    later = readings(bridge(own=case.effect(case.value, onset=onset)))
    ramp = case.effect(case.value, onset=onset, end=end, profile="ramp")
    if case.kind == "bearing_friction":
        with pytest.raises(InputError, match="share a structure"):
            readings(bridge(own=ramp))
        ramped = later
    else:
        ramped = readings(bridge(own=ramp))
        assert not np.allclose(ramped[7:12], later[7:12], rtol=0, atol=scale)
    for shown in (later, ramped):
        np.testing.assert_allclose(shown[:6], plain[:6], rtol=1e-9, atol=scale)
        assert np.isfinite(shown).all()
        if case.waits:
            np.testing.assert_allclose(shown[12:], always[12:], rtol=1e-9, atol=scale)
        else:
            assert not np.allclose(shown[12:], plain[12:], rtol=0, atol=scale)


#: a clock between rows has corners, and friction takes no mu that varies
SMOOTH = [case for case in CASES if case.kind not in ("clock_lag", "bearing_friction")]


def derivative(simulator: Simulator, by: str, contexts: dict[str, Any]) -> NDArray[np.float64]:
    """Fourth-order differences of the readings, float[rows, sensors]."""
    step = 2e-3
    ends = {k: simulator.predict({**contexts, by: contexts[by] + k * step}) for k in (-2, -1, 1, 2)}
    return np.asarray((8 * (ends[1] - ends[-1]) - (ends[2] - ends[-2])) / (12 * step))


@pytest.mark.parametrize("case", SMOOTH, ids=name_of)
def test_derivatives_by_a_context_that_drives_it(case: Case) -> None:
    driven = {"context": "knob", "times": case.value / 2, "minus": -1.0}
    simulator = Simulator(bridge(own=case.effect(driven)))
    at = {name: column[:8] for name, column in CONTEXTS.items()}
    at["knob"] = 1 + 0.2 * np.sin(ROW[:8])
    expected = derivative(simulator, "knob", at)
    found = simulator.jacobian(at)[:, :, -1]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


def test_a_stiffness_follows_the_temperature_by_hand() -> None:
    """Of a hanging bar: EA as below the kink, and straight in the temperature above it."""
    area, modulus, length, load = 0.004, 2e11, 3.0, 1e5
    hanging = {
        "rga_model": 1,
        "name": "bar",
        "plane": "xz",
        "materials": {"steel": {"E": modulus, "alpha": 0.0}},
        "sections": {"bar": {"A": area}},
        "nodes": {"top": [0, 0, length], "low": [0, 0, 0]},
        "members": {
            "bar": {"nodes": ["top", "low"], "section": "bar", "material": "steel", "groups": ["g"]}
        },
        "supports": {
            "top": {"node": "top", "fixed": ["ux", "uz"]},
            "low": {"node": "low", "fixed": ["ux"]},
        },
        "context": {"air": {"unit": "degC", "range": [-20, 40]}},
        "effects": {
            "pull": {"kind": "nodal_load", "forces": {"low": [0, 0, -load]}},
            "warmth": {
                "kind": "temperature",
                "groups": {"g": 1.0},
                "delta": {"context": "air", "minus": 10.0},
            },
        },
        "sensors": {
            "z": {"kind": "displacement", "node": "low", "direction": [0, 0, -1], "unit": "m"}
        },
    }
    air = np.array([-10.0, 5.0, 10.0, 13.0, 14.0, 30.0, 31.0])
    for more, above in (({}, air - 10), ({"kink": 12.0}, np.maximum(air - 12, 0))):
        own = {"kind": "stiffness_temperature", "group": "g", "rate": -0.02, **more}
        effects = {**hanging["effects"], "own": own}
        simulator = Simulator(read_model({**hanging, "effects": effects}, "test"))
        shown = simulator.predict({"air": air})[:, 0]
        expected = load * length / (modulus * area * (1 - 0.02 * above))
        np.testing.assert_allclose(shown, expected, rtol=1e-12)
        assert simulator.plan({"air": air}).path == "C2"
    with pytest.raises(InputError, match="leaves no stiffness"):
        simulator.predict({"air": 70.0})


def test_derivatives_of_a_stiffness_by_the_temperature() -> None:
    for more in ({}, {"kink": 15.0}):
        own = {"kind": "stiffness_temperature", "group": "bottom", "rate": -0.01, **more}
        simulator = Simulator(bridge(own=own))
        assert simulator.plan(CONTEXTS).path == "C2"
        expected = derivative(simulator, "temperature", CONTEXTS)
        found = simulator.jacobian(CONTEXTS)[:, :, 0]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


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


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"kind": "member_stiffness", "factor": 0.9}, "needs a place"),
    ({"kind": "joint_slip", "slip": 1e-3}, "needs a place"),
    ({"kind": "support_flexibility", "support": "D", "dof": "ux", "stiffness": 1e8}, "leaves ux"),
    ({"kind": "bearing_friction", "support": "A", "dof": "ux", "mu": 0.1}, "holds ux"),
    ({"kind": "added_axial_area", "group": "webs", "area": -0.1}, "below 0"),
    ({"kind": "floor_participation", "group": "webs", "area": 0.1}, "connector_stiffness"),
    ({"kind": "load_scale", "effect": "own stiffness", "factor": 1.1}, "name a load"),
    ({"kind": "load_eccentricity", "effect": "warmth", "share": 0.1}, "name a load"),
    (
        {
            "kind": "unmodelled_load",
            "group": "webs",
            "direction": [0, 0, 0],
            "context": "wind",
            "rate": 1.0,
        },
        "points nowhere",
    ),
    ({"kind": "sensor_swap", "sensors": ["D1", "D1"]}, "two that differ"),
]


@pytest.mark.parametrize(("effect", "words"), REFUSED, ids=lambda part: str(part)[:40])
def test_what_makes_no_sense_is_refused(effect: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        bridge(
            **{
                "own stiffness": {"kind": "member_stiffness", "group": "webs", "factor": 0.9},
                "own": effect,
            }
        )


def test_a_stiffness_needs_one_temperature_to_follow() -> None:
    own = {"kind": "stiffness_temperature", "group": "webs", "rate": 0.01}
    sun = {"kind": "temperature", "groups": {"webs": 1.0}}
    with pytest.raises(InputError, match="temperature and wind"):
        bridge(own=own, sun={**sun, "delta": {"context": "wind"}})
    with pytest.raises(InputError, match="kink"):
        bridge(own=own, sun={**sun, "delta": {"context": "temperature"}})
