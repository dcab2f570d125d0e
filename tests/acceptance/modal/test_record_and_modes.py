"""Gauges and modes in one diagnosis: each shows what the other cannot.

The truth is a frame with scatter, solved by plain NumPy; who analyses it holds a truss.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest

from independent.mixed_bridge import mixed
from independent.modal_bridge import Hidden, bridge
from rga.diagnosis import diagnose
from rga.findings import Findings

thorough = pytest.mark.thorough
GROUPS = {member["groups"][0] for member in bridge()["members"].values()}
#: window in which it is
ONSET = 20
DECK = {f"b{at}{side}": 400.0 for at in range(7) for side in "ns"}
THOROUGH = [pytest.param(seed, marks=thorough) for seed in range(6)]


@cache
def diagnosed(seed: int, make: Callable[[], Hidden], heavier: float = 1.0) -> Findings:
    model, record, modal = mixed(seed, make(), heavier=heavier)
    return diagnose(model, record, modal=modal)


@cache
def by_gauges(seed: int, make: Callable[[], Hidden], heavier: float = 1.0) -> Findings:
    model, record, _ = mixed(seed, make(), heavier=heavier)
    return diagnose(model, record)


def kinds(findings: Findings) -> set[str]:
    """Of the first cause, and of what the data cannot separate from it."""
    first = findings.causes[0]
    return {str(one["kind"]) for one in (first.effect, *first.rivals)}


def nothing() -> Hidden:
    return Hidden()


def wrong_clock() -> Hidden:
    return Hidden(clock=1.01)


def fast_clock() -> Hidden:
    return Hidden(clock=1.1)


def stiffer() -> Hidden:
    return Hidden(stiffness=dict.fromkeys(GROUPS, 1.06))


def heavier_deck() -> Hidden:
    return Hidden(mass=DECK)


def soft_bracing() -> Hidden:
    return Hidden(stiffness={"bottom bracing": 0.5})


def soft_bearings() -> Hidden:
    return Hidden(spring={"b0n": 1.5e7, "b0s": 1.5e7})


def weak_post_later() -> Hidden:
    return Hidden(stiffness={"b0n-t1n": 0.6}, onset=ONSET)


def weak_post_and_bracing() -> Hidden:
    return Hidden(stiffness={"b0n-t1n": 0.6, "bottom bracing": 0.5})


@pytest.mark.parametrize("make", [nothing, pytest.param(wrong_clock, marks=thorough)])
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=thorough) for k in range(1, 12))])
def test_nothing_is_named_where_nothing_is_hidden(make: Callable[[], Hidden], seed: int) -> None:
    findings = diagnosed(seed, make)
    assert findings.causes == []
    assert findings.verdict in ("nothing_wrong", "unknown")


@pytest.mark.parametrize("seed", [0, *THOROUGH[1:]])
def test_modes_tell_a_stiffer_bridge_from_lighter_loads(seed: int) -> None:
    assert kinds(by_gauges(seed, stiffer)) == {"elastic_modulus", "load_scale"}
    cause = diagnosed(seed, stiffer).causes[0]
    assert cause.effect["kind"] == "elastic_modulus"
    low, high = cause.effect["factor"]["ci90"]
    assert low - 0.01 < 1.06 < high + 0.01


@pytest.mark.parametrize("seed", THOROUGH)
def test_loads_that_are_heavier_than_said_are_among_what_is_named(seed: int) -> None:
    assert "load_scale" in kinds(diagnosed(seed, nothing, 1.05))


@pytest.mark.parametrize("seed", THOROUGH)
def test_a_heavier_deck_shows_in_modes_alone_and_is_no_stiffness(seed: int) -> None:
    assert by_gauges(seed, heavier_deck).causes == []
    findings = diagnosed(seed, heavier_deck)
    assert findings.verdict == "ambiguous"
    assert kinds(findings) <= {"added_mass", "mass_factor", "clock_rate"}
    assert findings.gap.held_out.gain > 0


@pytest.mark.parametrize("make", [soft_bracing, soft_bearings])
@pytest.mark.parametrize("seed", THOROUGH)
def test_what_is_lateral_shows_in_modes(seed: int, make: Callable[[], Hidden]) -> None:
    assert by_gauges(seed, make).causes == []
    (cause,) = diagnosed(seed, make).causes
    expected = "member_stiffness" if make is soft_bracing else "support_flexibility"
    assert cause.effect["kind"] == expected


@thorough
def test_a_cause_of_each_is_named_with_its_size() -> None:
    findings = diagnosed(0, weak_post_and_bracing)
    found = {one.effect.get("member", one.effect.get("group")): one for one in findings.causes}
    assert found.keys() == {"b0n-t1n", "bottom bracing"}
    for place, size in weak_post_and_bracing().stiffness.items():
        low, high = found[place].effect["factor"]["ci90"]
        assert low - 0.05 < size < high + 0.05


@pytest.mark.parametrize("seed", THOROUGH)
def test_a_record_behind_an_onset_has_it_from_the_modes(seed: int) -> None:
    model, record, modal = mixed(seed, weak_post_later())
    findings = diagnose(model, replace(record, start=3600.0 * 30), modal=modal)
    (cause,) = findings.causes
    assert (cause.effect["member"], cause.onset) == ("b0n-t1n", 3600.0 * ONSET)
    assert findings.verdict == "named"


@thorough
def test_a_clock_that_is_off_by_a_tenth_stays_a_rival_of_masses() -> None:
    findings = diagnosed(0, fast_clock)
    assert findings.verdict == "ambiguous"
    assert "clock_rate" in kinds(findings)
