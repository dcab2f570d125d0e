"""Every kind of the vocabulary shows, waits for its onset, and does nothing unless told to."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from every_kind_bridge import CONTEXTS, HOUR, ROW, bridge, readings
from rga.errors import InputError
from rga.model import Effect
from rga.simulation import Simulator


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
    Case("stiffness_temperature", "rate", GROUPS, 0.01, more=(("of", "both"),)),
    Case("stiffness_temperature", "below", GROUPS, -0.01, more=(("kink", 15.0),)),
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
    no_value = {"sensor_fault", "sensor_swap", "mode_swap"}
    of_modes = {"added_mass", "mass_factor", "clock_rate"}
    assert {case.kind for case in CASES} | loads | no_value | of_modes == set(Effect.vocabulary)


def test_a_kind_is_one_file_that_says_all_of_it() -> None:
    homes = {
        kind: known.__module__
        for kind, known in Effect.vocabulary.items()
        if known.__module__.startswith("rga.")
    }
    assert {kind: home.rpartition(".")[2] for kind, home in homes.items()} == {k: k for k in homes}
    model = bridge()
    for kind in homes:
        known = Effect.vocabulary[kind]
        assert known.__doc__
        if places := list(known.places(model)):
            assert known.action is not Effect.action
            sizes = [form for place in places for form in known.forms(model, place)]
            assert bool(known.usual) == any(sizes)


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


def test_derivatives_of_a_stiffness_by_the_temperature() -> None:
    for more in ({}, {"kink": 15.0}):
        own = {"kind": "stiffness_temperature", "group": "bottom", "rate": -0.01, **more}
        simulator = Simulator(bridge(own=own))
        assert simulator.plan(CONTEXTS).path == "C2"
        expected = derivative(simulator, "temperature", CONTEXTS)
        found = simulator.jacobian(CONTEXTS)[:, :, 0]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7 * np.abs(expected).max())
