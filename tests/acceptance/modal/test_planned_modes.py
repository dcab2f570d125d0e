"""What is planned after a diagnosis by modes parts the rivals when it is done, and names nothing.

What is done is simulated by plain NumPy: a frame with scatter, of which who plans holds a truss.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from independent.mixed_bridge import mixed
from independent.modal_bridge import PANEL, PANELS, Hidden, Parked, bridge, measured
from rga.diagnosis import diagnose, diagnose_modes
from rga.findings import Findings
from rga.planning.planner import plan
from rga.planning.result import Plan, PlannedTruck

thorough = pytest.mark.thorough
SEEDS = [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 4))]
DECK = {f"b{at}{side}": 400.0 for at in range(7) for side in "ns"}
GROUPS = {member["groups"][0] for member in bridge()["members"].values()}
HEAVY = {"added_mass", "mass_factor"}
WINDOWS, MORE = 40, 10


def nothing() -> Hidden:
    return Hidden()


def heavier_deck() -> Hidden:
    return Hidden(mass=DECK)


def softer() -> Hidden:
    return Hidden(stiffness=dict.fromkeys(GROUPS, 0.85))


def kinds(findings: Findings) -> set[str]:
    """Of the first cause, and of what the data cannot separate from it."""
    first = findings.causes[0]
    return {str(one["kind"]) for one in (first.effect, *first.rivals)}


@cache
def planned(seed: int, make: Callable[[], Hidden]) -> tuple[Findings, Plan]:
    """With modes alone, and one test that may be made."""
    model, record = measured(seed, make(), windows=WINDOWS)
    findings = diagnose_modes(model, record)
    return findings, plan(model, findings, sensors=0, positions=1)


def apart(found: Plan, one: str, other: str) -> list[int]:
    """Numbers of the separations of two kinds."""
    return [
        number
        for number, pair in enumerate(found.separations)
        if {one, other}
        == {words.split(":")[0].split(" of ")[0] for words in (pair.one, pair.other)}
    ]


def as_parked(truck: PlannedTruck, position: float) -> Parked:
    """The truck of a plan on the nodes of the deck, by the lever rule."""
    mass: dict[str, float] = {}
    places = position - np.append(0.0, np.cumsum(truck.spacings))
    for load, place in zip(truck.loads, places, strict=True):
        left = min(int(place // PANEL), PANELS - 1)
        share = place / PANEL - left
        for side in "ns":
            for at, part in ((left, 1.0 - share), (left + 1, share)):
                node = f"b{at}{side}"
                mass[node] = mass.get(node, 0.0) + part * 1e3 * load / 9.80665 / 2
    return Parked(mass, (WINDOWS, WINDOWS + MORE))


@pytest.mark.parametrize("make", [heavier_deck, pytest.param(softer, marks=thorough)])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_parked_mass_stands_first(seed: int, make: Callable[[], Hidden]) -> None:
    findings, found = planned(seed, make)
    assert findings.verdict == "ambiguous"
    assert {"elastic_modulus", "added_mass", "mass_factor", "clock_rate"} <= kinds(findings)
    assert found.ranked[0].kind == "parked mass"
    (test,) = found.tests
    assert test.position is not None
    for number in apart(found, "elastic modulus", "mass factor"):
        pair = found.separations[number]
        assert pair.d_perp > 3.5
        assert pair.simulated.won >= 0.9
    # What a clock does to all frequencies a softer structure does as well, with a truck or not.
    (number,) = apart(found, "elastic modulus", "clock rate")
    assert found.separations[number].d_perp < 0.01
    assert not found.separations[number].separated
    others = {one.kind: max(one.d_perp) for one in found.ranked if one.kind != "parked mass"}
    assert others["more windows"] < 1.0
    assert others["accelerometer"] < 1.0


@pytest.mark.parametrize("make", [heavier_deck, pytest.param(softer, marks=thorough)])
@pytest.mark.parametrize("seed", SEEDS)
def test_doing_it_tells_mass_from_modulus(seed: int, make: Callable[[], Hidden]) -> None:
    found = planned(seed, make)[1]
    position = found.tests[0].position
    assert found.truck is not None
    assert position is not None
    truck = as_parked(found.truck, position)
    done = diagnose_modes(*measured(seed, make(), windows=WINDOWS + MORE, parked=truck))
    if make is heavier_deck:
        assert kinds(done) <= HEAVY
    else:
        assert kinds(done) == {"elastic_modulus", "clock_rate"}
    null = diagnose_modes(*measured(seed, nothing(), windows=WINDOWS + MORE, parked=truck))
    assert null.causes == []


def lateral() -> Hidden:
    return Hidden(spring={"b0n": 3e6, "b0s": 3e6})


@thorough
def test_what_the_record_says_of_the_model_as_it_is_stands_beside_it() -> None:
    findings, found = planned(0, lateral)
    assert findings.verdict == "named"
    odds = {one.words: one.log_odds for one in findings.explanations}
    assert odds["the model as it is"] == 0.0
    pair = found.separations[-1]
    assert pair.other == "the model as it is"
    assert pair.log_odds == findings.explanations[0].log_odds > 100.0


@pytest.mark.parametrize(
    ("truck", "warning"),
    [
        pytest.param(
            "40,40@4", "the mass of 8.16 t that is to be parked is 0.18 of the ", marks=thorough
        ),
        pytest.param(
            "4000,4000@4", "no parked mass is planned: 816 t make it doubtful", marks=thorough
        ),
    ],
)
def test_a_mass_that_is_large_for_the_structure_is_told(truck: str, warning: str) -> None:
    model, _ = measured(0, lateral(), windows=WINDOWS)
    findings, small = planned(0, lateral)
    assert not [one for one in small.warnings if "parked" in one]
    found = plan(model, findings, sensors=0, positions=1, truck=truck)
    (told,) = [one for one in found.warnings if "parked" in one]
    assert told.startswith(warning)
    stands = found.ranked[0].kind == "parked mass"
    assert stands == told.startswith("the mass")
    assert ("which is more than is practical" in found.sentence) == stands


@pytest.mark.parametrize("seed", SEEDS)
def test_gauges_under_a_known_load_tell_a_modulus_from_a_clock(seed: int) -> None:
    model, record, modal = mixed(seed, softer())
    alone = diagnose_modes(model, modal)
    assert {"elastic_modulus", "clock_rate"} <= kinds(alone)
    found = plan(model, alone, sensors=0, positions=2)
    (number,) = apart(found, "elastic modulus", "clock rate")
    static = {one.kind: one for one in found.ranked}["set context"]
    assert static.expected[number] > 0.9
    assert any(test.contexts for test in found.tests)
    assert found.separations[number].separated
    # The record has both loads between the ends of their ranges.
    assert kinds(diagnose(model, record, modal=modal)) == {"elastic_modulus"}
