"""Model files: what is refused, with the key, the value and what would be right."""

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from rga.errors import InputError, UnstableStructureError
from rga.model import load_model, model_content, model_schema, read_model, write_model
from rga.simulation import Simulator

Change = Callable[[dict[str, Any]], object]

REFUSED: dict[str, tuple[Change, list[str]]] = {
    "unknown key": (lambda m: m.update(colour="red"), ["colour", "unknown"]),
    "unknown key of a member": (lambda m: m["members"]["west"].update(size=1), ["west.size"]),
    "missing node": (lambda m: m["members"]["west"].update(nodes=["W", "X"]), ["west", "'X'"]),
    "no length": (lambda m: m["nodes"].update(T=[0, 0, 0]), ["west", "no length"]),
    "missing section": (lambda m: m["members"]["west"].update(section="x"), ["section", "'x'"]),
    "missing support node": (lambda m: m["supports"]["W"].update(node="Q"), ["'Q'"]),
    "a unit of another kind": (
        lambda m: next(iter(m["sensors"].values())).update(unit="kg"),
        ["'kg'", "mm"],
    ),
    "a negative area": (lambda m: m["sections"]["bar"].update(A=-1), ["A", "greater than 0"]),
    "an infinite node": (lambda m: m["nodes"].update(T=[0, 0, float("inf")]), ["nodes.T"]),
    "a range that falls": (
        lambda m: m["context"]["load"].update(range=[1, 0]),
        ["context.load", "must grow"],
    ),
    "an unknown kind": (lambda m: m["effects"].update(x={"kind": "ghost"}), ["'ghost'", "known"]),
    "an unknown context": (
        lambda m: m["effects"]["warmth"].update(delta={"context": "sun"}),
        ["'sun'"],
    ),
    "an unknown group": (lambda m: m["effects"]["warmth"].update(groups={"deck": 1}), ["'deck'"]),
    "an onset that is no time": (
        lambda m: m["effects"]["warmth"].update(onset="soon"),
        ["soon"],
    ),
    "a sensor named like a context": (
        lambda m: m["sensors"].update(load=m["sensors"]["D1"]),
        ["sensors.load", "same name"],
    ),
    "another version": (lambda m: m.update(rga_model=2), ["rga_model"]),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case: str, two_bars: dict[str, Any]) -> None:
    change, expected = REFUSED[case]
    change(two_bars)
    with pytest.raises(InputError) as refused:
        read_model(two_bars, "model.json")
    for part in (*expected, "model.json"):
        assert part in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_member_in_two_warm_groups_is_refused(two_bars: dict[str, Any]) -> None:
    two_bars["members"]["west"]["groups"].append("west side")
    two_bars["effects"]["warmth"]["groups"]["west side"] = 1.0
    with pytest.raises(InputError, match="in both"):
        read_model(two_bars, "model.json")


def test_a_mechanism_names_node_and_direction(two_bars: dict[str, Any]) -> None:
    two_bars["supports"]["E"]["fixed"] = ["uy", "uz"]
    del two_bars["members"]["east"]
    model = read_model(two_bars, "model.json")
    with pytest.raises(UnstableStructureError, match=r"node '\w' in u[xz]"):
        Simulator(model).predict({"temperature": 0.0, "load": 0.0})


def test_a_key_that_stands_twice_is_refused(tmp_path: Path, two_bars: dict[str, Any]) -> None:
    text = json.dumps(two_bars).replace('"nodes": {', '"nodes": {"W": [0, 0, 0], ', 1)
    (tmp_path / "model.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="'W' stands twice"):
        load_model(tmp_path / "model.json")


def test_a_mistake_of_yaml_is_told_by_its_line(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text("nodes:\n  A: [0, 0\nmembers: 3\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"no YAML text: .* in line 3") as raised:
        load_model(path)
    assert "unicode string" not in str(raised.value)


def test_a_key_that_stands_twice_in_yaml_is_refused(
    tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    text = yaml.safe_dump(two_bars, sort_keys=False)
    (tmp_path / "model.yaml").write_text(text, encoding="utf-8")
    assert load_model(tmp_path / "model.yaml").nodes.keys() == two_bars["nodes"].keys()
    again = text.replace("nodes:\n", "nodes:\n  W: [0, 0, 0]\n", 1)
    (tmp_path / "model.yaml").write_text(again, encoding="utf-8")
    with pytest.raises(InputError, match="'W' stands twice below line"):
        load_model(tmp_path / "model.yaml")


def test_what_is_written_is_read_back(tmp_path: Path, two_bars: dict[str, Any]) -> None:
    model = read_model(copy.deepcopy(two_bars), "test")
    write_model(model, tmp_path / "model.json")
    again = load_model(tmp_path / "model.json")
    assert model_content(again) == model_content(model)
    assert len(again.sha256) == 64
    assert [path.name for path in tmp_path.iterdir()] == ["model.json"]


def test_the_schema_takes_what_is_a_model(two_bars: dict[str, Any]) -> None:
    example = Path(__file__).parents[3] / "examples" / "rdso45m" / "model.json"
    validator = jsonschema.Draft202012Validator(model_schema())
    validator.validate(json.loads(example.read_text(encoding="utf-8")))
    validator.validate(two_bars)
    two_bars["effects"]["warmth"]["colour"] = "red"
    assert not validator.is_valid(two_bars)


@pytest.mark.parametrize(
    ("effect", "expected"),
    [
        ({"kind": "elastic_modulus", "material": "steel"}, "factor"),
        ({"kind": "support_spring", "support": "W", "dof": "ux", "stiffness": 1e6}, "holds ux"),
    ],
)
def test_effects_that_do_nothing_are_refused(
    effect: dict[str, Any], expected: str, two_bars: dict[str, Any]
) -> None:
    two_bars["effects"]["hidden"] = effect
    with pytest.raises(InputError, match=expected):
        read_model(two_bars, "model.json")


def test_a_byte_order_mark_before_a_file_is_passed_over(
    two_bars: dict[str, Any], tmp_path: Path
) -> None:
    path = tmp_path / "model.json"
    path.write_text(json.dumps(two_bars), encoding="utf-8-sig")
    assert load_model(path).name == two_bars["name"]
