"""Hypotheses: what they cost beforehand, where they stand, and which there are."""

import numpy as np
import pytest

from known_problem import candidate, candidates
from rga.diagnosis.search.hypothesis import LATE, hypotheses
from rga.diagnosis.search.linearised import Problem
from rga.model import Model


def test_priors_of_all_hypotheses_make_a_half(model: Model) -> None:
    """The other half is no effect at all; kinds count alike, and places of a kind."""
    found = hypotheses(model, list(model.sensors), list(model.context))
    assert sum(np.exp(one.log_prior) for one in found) == pytest.approx(0.5)
    by_kind: dict[str, float] = {}
    for one in found:
        by_kind[one.name] = by_kind.get(one.name, 0.0) + float(np.exp(one.log_prior))
    assert min(by_kind.values()) == pytest.approx(max(by_kind.values()))


def test_a_beginning_costs_what_moments_cost(nothing_off: Problem) -> None:
    always = candidate(nothing_off, "sensor_bias", sensor="D1")
    late = always.beginning(600.0, "ramp", 1200.0)
    assert late.log_prior - always.log_prior == pytest.approx(LATE)
    assert LATE < -1
    assert always.beginning_with(late) == late
    assert late.same_place(always)


def test_coordinates_become_parameters(nothing_off: Problem) -> None:
    one = candidate(nothing_off, "sensor_bias", sensor="D1")
    effect = one.beginning(600.0).effect([2.0])
    assert effect.model_dump()["offset"] == pytest.approx(2.0 * one.priors["offset"].value(1.0))
    assert (effect.kind, effect.onset) == ("sensor_bias", 600.0)


def test_effects_are_those_of_the_model_file(model: Model, nothing_off: Problem) -> None:
    """What is the same for all coordinates is checked once; no coordinate may tell."""
    for one in hypotheses(model, list(model.sensors), list(model.context)):
        for z in (-3.0, 0.4):
            effect = one.effect([z] * len(one.priors))
            values = {name: prior.value(z) for name, prior in one.priors.items()}
            assert effect == one.kind(kind=one.name, **one.place, **values)
            assert repr(effect) == repr(one.kind(kind=one.name, **one.place, **values))


def test_several_places_contain_one_of_them(nothing_off: Problem) -> None:
    several = [one for one in candidates(nothing_off, "member_stiffness") if "member" in one.place]
    one, other = several[:2]
    both = [one.place["member"], other.place["member"]]
    wide = one.__class__(one.kind, {**one.place, "member": both}, one.priors, 1, 1)
    assert wide.contains(one)
    assert wide.contains(other)
    assert not one.contains(wide)
    assert not wide.contains(several[2])
    assert not wide.contains(one.beginning(600.0))
    assert not one.same_place(other)


def test_what_is_not_there_has_no_hypothesis(model: Model) -> None:
    sensors = [name for name in model.sensors if name != "D1"]
    found = hypotheses(model, sensors, ["temperature"])
    named = [str(value) for one in found for value in one.place.values()]
    assert "D1" not in named
    assert "D2" in named
    assert "temperature" in named
    contexts = {one.place["context"] for one in found if one.name == "context_bias"}
    assert contexts == {"temperature"}
