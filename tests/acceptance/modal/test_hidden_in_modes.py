"""Effects hidden in measured modes are found, and where nothing is hidden nothing is named.

The truth is a frame with scatter, solved by plain NumPy; who analyses it holds a truss.
"""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from functools import cache

import numpy as np
import pytest

from independent.modal_bridge import Hidden, Parked, bridge, measured
from rga.diagnosis import diagnose_modes
from rga.errors import InputError
from rga.findings import Findings
from rga.model import Model, read_effect
from rga.model.schema import ContextVariable
from rga.records.modal.record import ModalRecord
from rga.simulation import ModalSimulator

ONSET = 20
#: time of that window [s]
BEGUN = 3600.0 * ONSET
DECK = {f"b{at}{side}": 400.0 for at in range(7) for side in "ns"}
#: what moves all modes alike
COMMON = {"elastic_modulus", "mass_factor", "added_mass", "clock_rate"}
thorough = pytest.mark.thorough


@cache
def diagnosed(seed: int, make: Callable[[], Hidden]) -> Findings:
    return diagnose_modes(*measured(seed, make()))


def kinds(findings: Findings) -> set[str]:
    """Of the first cause, and of what the data cannot separate from it."""
    first = findings.causes[0]
    return {str(one["kind"]) for one in (first.effect, *first.rivals)}


def nothing() -> Hidden:
    return Hidden()


def wrong_clock() -> Hidden:
    return Hidden(clock=1.01)


def soft_bracing() -> Hidden:
    return Hidden(stiffness={"bottom bracing": 0.5})


def soft_bracing_later() -> Hidden:
    return Hidden(stiffness={"bottom bracing": 0.5}, onset=ONSET)


def soft_bearings() -> Hidden:
    return Hidden(spring={"b0n": 1.5e7, "b0s": 1.5e7})


def heavier_deck() -> Hidden:
    return Hidden(mass=DECK, onset=ONSET)


def weak_post() -> Hidden:
    return Hidden(stiffness={"b0n-t1n": 0.5}, onset=ONSET)


def lost_lateral() -> Hidden:
    return Hidden(stiffness={"b0n-b1s": 0.02})


@pytest.mark.parametrize("make", [nothing, wrong_clock])
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 12))]
)
def test_nothing_is_named_where_nothing_is_hidden(make: Callable[[], Hidden], seed: int) -> None:
    findings = diagnosed(seed, make)
    assert findings.causes == []
    assert findings.verdict in ("nothing_wrong", "unknown")


SEEDS = [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 6))]


@thorough
@pytest.mark.parametrize("clock", [1.1, 0.9])
def test_a_clock_that_is_off_by_a_tenth_is_among_what_is_named(clock: float) -> None:
    findings = diagnose_modes(*measured(0, Hidden(clock=clock)))
    assert findings.verdict == "ambiguous"
    assert {"elastic_modulus", "clock_rate"} <= kinds(findings) <= COMMON


@thorough
@pytest.mark.parametrize("drift", [0.0, 0.02])
def test_frequencies_that_drift_are_no_state_that_a_bracing_explains(drift: float) -> None:
    model, record = measured(0, soft_bracing(), windows=60)
    ends = 1.0 - drift * record.time / np.ptp(record.time)
    findings = diagnose_modes(model, replace(record, frequency=record.frequency * ends))
    assert findings.causes[0].effect["group"] == "bottom bracing"
    assert findings.verdict == ("partial" if drift else "named")


@thorough
@pytest.mark.parametrize("seed", range(6))
def test_a_soft_bracing_is_named_with_its_size(seed: int) -> None:
    cause = diagnosed(seed, soft_bracing).causes[0]
    assert (cause.effect["kind"], cause.effect["group"]) == ("member_stiffness", "bottom bracing")
    low, high = cause.effect["factor"]["ci90"]
    assert low - 0.05 < 0.5 < high + 0.05


@pytest.mark.parametrize("seed", SEEDS)
def test_soft_bearings_are_named_at_their_end(seed: int) -> None:
    findings = diagnosed(seed, soft_bearings)
    effect = findings.causes[0].effect
    assert (effect["kind"], effect["dof"]) == ("support_flexibility", "uy")
    assert set(effect["support"]) == {"west n", "west s"}
    assert findings.gap.after < 0.1 * findings.gap.before
    assert findings.gap.held_out.gain > 0


def with_temperature(seed: int, late: float, hidden: Hidden) -> tuple[Model, ModalRecord]:
    """Days that the model does not follow, and a change of all modes in the 31st of 60 hours."""
    model, record = measured(seed, hidden, windows=60)
    air = 10.0 + 12.0 * np.sin(2 * np.pi * record.time / 86_400.0)
    softer = np.exp(-2e-4 * (air - 10.0))
    softer *= np.where(record.time >= 31 * 3600.0, late, 1.0)
    model = model.model_copy(
        update={"context": {"air": ContextVariable(unit="degC", range=(-20.0, 40.0))}}
    )
    return model, replace(record, frequency=record.frequency * softer, contexts={"air": air})


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 6))])
def test_warm_days_that_the_model_does_not_follow_are_no_cause(seed: int) -> None:
    findings = diagnose_modes(*with_temperature(seed, 1.0, nothing()))
    assert findings.causes == []


@thorough
def test_beside_warm_days_a_change_is_found_when_it_came() -> None:
    findings = diagnose_modes(*with_temperature(0, 0.96, nothing()))
    assert findings.verdict == "ambiguous"
    assert findings.causes[0].onset == 31 * 3600.0
    assert {"elastic_modulus", "clock_rate", "mass_factor"} <= kinds(findings) <= COMMON


def following(model: Model) -> Model:
    """The same, whose members soften as it gets warm."""
    groups = list(model.groups)
    effects = {
        "warm": {
            "kind": "temperature",
            "groups": dict.fromkeys(groups, 1.0),
            "delta": {"context": "air", "minus": 10.0},
        },
        "softer": {"kind": "stiffness_temperature", "group": groups, "rate": -4e-4},
    }
    for name, effect in effects.items():
        model = model.extended({name: read_effect(effect, name)})
    return model


@thorough
@pytest.mark.parametrize("make", [nothing, soft_bracing])
def test_a_model_that_follows_the_weather_is_compared_at_its_temperatures(
    make: Callable[[], Hidden],
) -> None:
    hidden = make()
    model, record = with_temperature(0, 1.0, hidden)
    findings = diagnose_modes(following(model), record)
    named = [(one.effect["kind"], one.effect["group"]) for one in findings.causes]
    assert named == ([("member_stiffness", "bottom bracing")] if hidden.stiffness else [])


@thorough
def test_a_context_that_was_not_measured_is_asked_for() -> None:
    model, record = with_temperature(0, 1.0, nothing())
    with pytest.raises(InputError, match="context 'air', which drives the structure"):
        diagnose_modes(following(model), replace(record, contexts={}))


@thorough
@pytest.mark.parametrize("seed", range(6))
def test_mass_is_not_told_from_modulus_by_modes_alone(seed: int) -> None:
    findings = diagnosed(seed, heavier_deck)
    assert findings.verdict in ("ambiguous", "partial")
    assert {"elastic_modulus", "added_mass"} <= kinds(findings) <= {*COMMON, "member_stiffness"}
    assert findings.causes[0].onset == BEGUN
    assert "truck of known mass" in findings.causes[0].separated_by


def load_on_top() -> Hidden:
    return Hidden(mass={"t3n": 3000.0}, onset=ONSET)


def lamp_on_top() -> Hidden:
    return Hidden(mass={"t3n": 1000.0}, onset=ONSET)


@pytest.mark.parametrize(
    ("make", "left"), [(load_on_top, 0.2), pytest.param(lamp_on_top, 0.7, marks=thorough)]
)
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 4))])
def test_something_heavy_is_found_where_the_model_states_no_mass(
    make: Callable[[], Hidden], left: float, seed: int
) -> None:
    findings = diagnosed(seed, make)
    (first,) = findings.causes
    assert first.onset == BEGUN
    near = {one["node"]: one for one in (first.effect, *first.rivals)}
    assert set(near) <= {"t3n", "t3s"}
    low, high = near["t3n"]["mass"]["ci90"]
    assert low < make().mass["t3n"] < high
    assert findings.gap.after < left * findings.gap.before


GROUPS = {member["groups"][0] for member in bridge()["members"].values()}
#: of a tenth of what the bridge weighs, on both of its sides
TRUCK = Parked({"b3n": 2000.0, "b3s": 2000.0}, (20, 40))


def heavier_always() -> Hidden:
    return Hidden(mass=DECK)


def softer() -> Hidden:
    return Hidden(stiffness=dict.fromkeys(GROUPS, 0.85))


@cache
def with_a_truck(seed: int, make: Callable[[], Hidden]) -> Findings:
    return diagnose_modes(*measured(seed, make(), parked=TRUCK))


@pytest.mark.parametrize("make", [heavier_always, softer])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 4))])
def test_a_parked_truck_tells_mass_from_modulus(make: Callable[[], Hidden], seed: int) -> None:
    heavy = {"added_mass", "mass_factor"}
    alone, told = diagnosed(seed, make), with_a_truck(seed, make)
    assert alone.verdict == told.verdict == "ambiguous"
    assert {"elastic_modulus", "added_mass", "mass_factor"} <= kinds(alone) <= COMMON
    if make is heavier_always:
        assert kinds(told) <= heavy
    else:
        # What a clock does to all frequencies a softer structure does as well, truck or not.
        assert kinds(told) == {"elastic_modulus", "clock_rate"}


@pytest.mark.parametrize("make", [nothing, pytest.param(wrong_clock, marks=thorough)])
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 12))]
)
def test_a_parked_truck_is_no_cause(make: Callable[[], Hidden], seed: int) -> None:
    findings = with_a_truck(seed, make)
    assert findings.causes == []
    assert findings.verdict in ("nothing_wrong", "unknown")


@thorough
@pytest.mark.parametrize("seed", range(4))
def test_a_weak_member_is_among_what_cannot_be_told_apart(seed: int) -> None:
    findings = diagnosed(seed, weak_post)
    first = findings.causes[0]
    near = [first.effect, *first.rivals]
    assert first.onset == BEGUN
    assert any(one.get("member") == "b0n-t1n" for one in near)
    weak = next(one for one in near if one.get("member") == "b0n-t1n")
    np.testing.assert_allclose(weak["factor"]["value"], 0.5, atol=0.1)


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=thorough)])
def test_a_lateral_that_is_lost_is_among_what_cannot_be_told_apart(seed: int) -> None:
    """Slopes at usual sizes promise little of what is lost altogether."""
    first, *others = diagnosed(seed, lost_lateral).causes
    assert others == []
    near = [first.effect, *first.rivals]
    lost = next(one for one in near if one.get("member") == "b0n-b1s")
    factor = lost["factor"]
    assert (factor["value"] if isinstance(factor, dict) else factor) < 0.3


def test_an_onset_is_told_as_the_record_writes_its_times() -> None:
    model, record = measured(0, soft_bracing_later(), modes=3)
    first = replace(record, start="2026-03-01T00:00:00+01:00")
    findings = diagnose_modes(model, first)
    assert findings.causes[0].onset == "2026-03-01T20:00:00+01:00"
    extended = ModalSimulator(findings.extended)
    times = {"time": record_times("2026-03-01T19:00:00+01:00", "2026-03-01T21:00:00+01:00")}
    before, after = extended.predict(times)
    assert (after < 0.99 * before).any()


def record_times(*stamps: str) -> list[float]:
    return [datetime.fromisoformat(one).timestamp() for one in stamps]


@pytest.mark.parametrize("make", [nothing, soft_bearings])
def test_few_modes_decide_nothing(make: Callable[[], Hidden]) -> None:
    model, record = measured(0, make(), modes=2)
    findings = diagnose_modes(model, record)
    assert (findings.verdict, findings.causes) == ("unknown", [])
    assert "3 are needed to decide" in findings.unexplained.looks_like
    if make is nothing:
        assert "these data cannot decide whether it is right" in findings.sentence()


@thorough
def test_causes_of_modes_without_shapes_are_no_certainty() -> None:
    model, record = measured(0, soft_bracing())
    blind = replace(record, points=(), shapes=record.shapes[:, :0])
    findings = diagnose_modes(model, blind)
    assert findings.verdict in ("partial", "unknown")
    assert "frequencies alone" in findings.unexplained.looks_like or not findings.causes
