"""All mistakes of a model file are told at once, each with its key."""

import pickle
from typing import Any

import pytest

from rga.errors import InputError, SeveralMistakes
from rga.model import read_effect, read_model


def mistakes(content: Any) -> list[str]:
    with pytest.raises(InputError) as refused:
        read_model(content, "model.json")
    error = refused.value
    if isinstance(error, SeveralMistakes):
        assert len(set(error.mistakes)) == len(error.mistakes) > 1
        return list(error.mistakes)
    return [error.what]


def test_one_mistake_is_one_line(two_bars: dict[str, Any]) -> None:
    two_bars["sections"]["bar"]["A"] = -1
    with pytest.raises(InputError) as refused:
        read_model(two_bars, "model.json")
    assert not isinstance(refused.value, SeveralMistakes)
    assert str(refused.value) == (
        "sections.bar.A: Input should be greater than 0 (value -1) (model.json): "
        "see `rga schema model` for what is right"
    )


def test_values_and_names_are_told_together(two_bars: dict[str, Any]) -> None:
    two_bars["colour"] = "red"
    two_bars["sections"]["bar"]["A"] = "x"
    two_bars["members"]["west"]["nodes"] = ["Q", "P"]
    two_bars["effects"]["warmth"]["delta"]["contxt"] = "load"
    two_bars["effects"]["weight"]["kind"] = "ghost"
    two_bars["supports"]["E"]["node"] = "R"
    found = mistakes(two_bars)
    for begin in (
        "colour: this key is unknown",
        "sections.bar.A: Input should be a valid number",
        "members.west.nodes: there is no 'Q' in nodes",
        "members.west.nodes: there is no 'P' in nodes",
        "effects.warmth.delta.contxt: this key is unknown",
        "effects.weight.kind: 'ghost' is no kind of effect; known are",
        "supports.E.node: there is no 'R' in nodes",
    ):
        assert len([one for one in found if one.startswith(begin)]) == 1
    assert len(found) == 7


def test_names_of_what_cannot_be_read_are_known(two_bars: dict[str, Any]) -> None:
    two_bars["sections"]["bar"]["A"] = 0
    two_bars["nodes"]["T"] = "top"
    two_bars["context"]["load"]["range"] = [1, 0]
    two_bars["members"]["east"]["kind"] = "rope"
    assert [one.split(":")[0] for one in mistakes(two_bars)] == [
        "sections.bar.A",
        "nodes.T",
        "members.east.kind",
        "context.load",
    ]


@pytest.mark.parametrize("table", ["nodes", "members", "sections", "materials", "supports"])
def test_a_part_that_is_missing_is_one_mistake(table: str, two_bars: dict[str, Any]) -> None:
    del two_bars[table]
    assert mistakes(two_bars) == [f"{table}: Field required"]


def test_of_the_forms_of_a_value_the_nearest_is_told(two_bars: dict[str, Any]) -> None:
    two_bars["effects"]["warmth"]["delta"] = "hot"
    (found,) = mistakes(two_bars)
    assert found.startswith("effects.warmth.delta: Input should be a valid number, unable to parse")
    assert found.endswith("(value 'hot')")
    two_bars["effects"]["warmth"]["delta"] = {"times": 2.0}
    assert mistakes(two_bars) == ["effects.warmth.delta.context: Field required"]


def test_two_that_miss_keys_are_two_mistakes(two_bars: dict[str, Any]) -> None:
    two_bars["springs"] = [{"node": "T"}, {"node": "T", "dof": "ux", "stiffness": 1e6}]
    assert mistakes(two_bars) == [
        "springs.0.dof: Field required",
        "springs.0.stiffness: Field required",
    ]


def test_many_are_counted_in_words_and_kept_all(two_bars: dict[str, Any]) -> None:
    for number in range(30):
        bar = {**two_bars["members"]["west"], "section": f"section {number}"}
        two_bars["members"][f"bar {number}"] = bar
    with pytest.raises(SeveralMistakes) as refused:
        read_model(two_bars, "model.json")
    lines = str(refused.value).split("\n")
    assert lines[0].startswith("30 mistakes (model.json): ")
    assert lines[-1] == "  ... and 10 more"
    assert len(lines) == 1 + SeveralMistakes.MOST + 1
    assert len(refused.value.mistakes) == 30


def test_the_list_passes_from_process_to_process() -> None:
    error = SeveralMistakes(["a: b", "c: d"], "model.json", "mend them")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.mistakes) == (str(error), error.mistakes)


def test_an_effect_that_does_not_fit_is_named(two_bars: dict[str, Any]) -> None:
    two_bars["effects"]["warmth"]["groups"] = {"deck": 1.0}
    assert mistakes(two_bars) == ["effects.warmth: groups: there is no group 'deck' in the model"]
    with pytest.raises(ValueError, match=r"effects\.warmth\.kind: 'ghost' is no kind"):
        read_effect({"kind": "ghost"}, "warmth")


def test_the_ends_of_a_member_are_named(two_bars: dict[str, Any]) -> None:
    two_bars["members"]["west"]["end_springs"] = {"end": {"ry": 1e6}}
    with pytest.raises(InputError, match=r"members\.west\.end_springs: 'end' is no end of a"):
        read_model(two_bars, "model.json")
