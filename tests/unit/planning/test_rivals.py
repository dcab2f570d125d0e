"""The explanations between which findings leave a choice, two by two."""

from typing import Any

import pytest

from made_findings import cause, findings, tried
from planned_bridge import EAST, GAIN, SOFT, WEST
from rga.errors import InputError
from rga.findings.phrases import effect_words
from rga.model import Model
from rga.planning.rivals import NEAREST, rival_pairs, told_apart, working_sensors


def estimated(content: dict[str, Any], name: str, value: float) -> dict[str, Any]:
    return {**content, name: {"value": value, "ci90": sorted([0.9 * value, 1.1 * value])}}


SUNK = estimated(EAST, "displacement", -0.004)
OTHER = estimated(WEST, "displacement", -0.004)
WEAK = estimated(SOFT, "factor", 0.7)
FAULT = {"kind": "sensor_fault", "sensor": "D1", "mode": "stuck"}


def kinds(pairs: Any) -> list[tuple[list[str], list[str]]]:
    """Kinds and places of the effects of both explanations."""

    def of(one: Any) -> list[str]:
        return sorted(str(next(iter(effect.place.values()))) for effect in one.effects.values())

    return [(of(one), of(other)) for one, other in pairs]


def test_a_cause_and_its_rivals_two_by_two(model: Model) -> None:
    pairs = rival_pairs(model, findings(cause(SUNK, OTHER, WEAK)))
    assert kinds(pairs) == [
        (["east"], ["west"]), (["east"], ["L2-L3"]), (["west"], ["L2-L3"]),
    ]  # fmt: skip


def test_other_causes_stand_beside_every_rival(model: Model) -> None:
    ((one, other),) = kinds(rival_pairs(model, findings(cause(WEAK), cause(SUNK, OTHER))))
    assert one == ["L2-L3", "east"]
    assert other == ["L2-L3", "west"]


def test_rivals_are_as_they_were_fitted_together(model: Model) -> None:
    together = tried(WEAK, estimated(WEST, "displacement", -0.009))
    found = findings(cause(WEAK), cause(SUNK, OTHER), explanations=(together,))
    ((_, other),) = rival_pairs(model, found)
    values = [unknown.prior.value(unknown.centre) for unknown in other.unknowns]
    assert sorted(values) == pytest.approx([-0.009, 0.7])


def test_without_rivals_it_is_held_against_what_was_tried_and_nothing(model: Model) -> None:
    found = findings(cause(SUNK), explanations=(tried(WEAK), tried(SUNK), tried()))
    assert kinds(rival_pairs(model, found)) == [(["east"], ["L2-L3"]), (["east"], [])]


def test_few_rivals_are_kept_and_the_advised_one_among_them(model: Model) -> None:
    members = ["L0-L1", "L1-L2", "L3-L4", "U1-U2", "U2-U3", "L2-L3"]
    many = [estimated({**SOFT, "member": one}, "factor", 0.7) for one in members]
    advice = f"against {effect_words(many[-1])}: measure it"
    with_advice = kinds(rival_pairs(model, findings(cause(SUNK, *many, separated_by=advice))))
    named = {name for pair in with_advice for one in pair for name in one}
    assert len(named) == NEAREST + 1
    assert "L2-L3" in named
    without = kinds(rival_pairs(model, findings(cause(SUNK, *many))))
    assert "L2-L3" not in {name for pair in without for one in pair for name in one}


def test_broken_channels_are_no_explanation_and_measure_nothing(model: Model) -> None:
    assert rival_pairs(model, findings(cause(FAULT))) == []
    working = working_sensors(model, findings(cause(FAULT), cause(GAIN)))
    assert working == [name for name in model.sensors if name != "D1"]


@pytest.mark.parametrize(
    ("effect", "words"),
    [
        ({**SUNK, "support": "north"}, "north"),
        ({**SUNK, "colour": "red"}, "support_settlement, colour"),
        ({"kind": "gremlin"}, "gremlin"),
    ],
)
def test_effects_that_do_not_fit_the_model_are_refused(
    model: Model, effect: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        rival_pairs(model, findings(cause(effect, OTHER)))


def test_what_the_record_tells_apart_is_known(model: Model) -> None:
    odds = {"a settlement": 90.0, "the model as it is": 1.5}
    several = [{**tried(), "words": k, "log_odds": v} for k, v in odds.items()]
    found = findings(cause(SUNK), explanations=tuple(several))
    assert told_apart(found, "a settlement", "the model as it is") == 88.5
    assert told_apart(found, "a settlement", "another") is None


def test_rivals_that_their_priors_alone_tell_apart_are_not_told_apart() -> None:
    odds = {"a settlement": 90.0, "another": 1.5, "a third": 89.0}
    several = [{**tried(), "words": k, "log_odds": v} for k, v in odds.items()]
    found = findings(cause(SUNK, OTHER), explanations=tuple(several))
    assert told_apart(found, "a settlement", "another") is None
    assert told_apart(found, "a settlement", "a third") == 1.0
