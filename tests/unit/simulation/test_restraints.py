"""What is said of a structure that can move: a support is lacking, or something within."""

from typing import Any

import pytest

from rga.checking import check
from rga.errors import InputError, UnstableStructureError
from rga.model import read_model
from rga.simulation import Simulator

BARS = [("A", "B"), ("B", "C"), ("A", "D"), ("D", "B"), ("B", "E"), ("D", "E"), ("E", "C")]
PINNED, ROLLER = {"node": "A", "fixed": ["ux", "uz"]}, {"node": "C", "fixed": ["uz"]}


def bridge(supports: dict[str, Any], *without: tuple[str, str], **keys: Any) -> dict[str, Any]:
    return {
        "rga_model": 1,
        "name": "bridge",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11}},
        "sections": {"bar": {"A": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}},
        "nodes": {"A": [0, 0, 0], "B": [2, 0, 0], "C": [4, 0, 0], "D": [1, 0, 2], "E": [3, 0, 2]},
        "members": {
            f"{i}-{j}": {"nodes": [i, j], "section": "bar", "material": "steel"}
            for i, j in BARS
            if (i, j) not in without
        },
        "supports": supports,
        "sensors": {
            "D": {"kind": "displacement", "unit": "mm", "node": "B", "direction": [0, 0, 1]}
        },
        "effects": {"load": {"kind": "nodal_load", "forces": {"B": [0, 0, -1000]}}},
        **keys,
    }


SUPPORT = "a support seems missing: add it, or a spring or member to what is held"
MEMBER = "add a member, a support or a stiffness there"
#: case -> content, remedy
LOOSE: dict[str, tuple[dict[str, Any], str]] = {
    "one pin": (bridge({"west": PINNED}), SUPPORT),
    "no support along x": (bridge({"west": ROLLER, "east": {**ROLLER, "node": "A"}}), SUPPORT),
    "three rollers side by side": (
        bridge({n: {"node": n, "fixed": ["uz"]} for n in "ABC"}), SUPPORT,
    ),
    "a spring that turns a bar": (
        bridge({"west": PINNED}, springs=[{"node": "A", "dof": "ry", "stiffness": 1e6}]), SUPPORT,
    ),
    "a member": (bridge({"west": PINNED, "east": ROLLER}, ("D", "E")), MEMBER),
    "in space": (
        bridge({"west": PINNED, "east": ROLLER}, plane=None),
        SUPPORT + ", or state the plane of a plane structure",
    ),
    "in space, held": (
        bridge({n: {"node": n, "fixed": ["ux", "uy", "uz"]} for n in "ABC"}
               | {"D": {"node": "D", "fixed": ["uy"]}}, plane=None),
        MEMBER + ", or hold the plane",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", LOOSE)
def test_a_support_is_named_first_where_the_whole_can_leave(case: str) -> None:
    content, remedy = LOOSE[case]
    model = read_model({k: v for k, v in content.items() if v is not None}, "m.json")
    with pytest.raises(UnstableStructureError) as told:
        Simulator(model).predict({})
    assert told.value.remedy == remedy
    loose = [one for one in check(model).findings if "nothing resists" in one.what]
    assert loose
    assert {one.remedy for one in loose} == {remedy}


@pytest.mark.parametrize(
    "held",
    [
        {"supports": {"west": PINNED, "east": ROLLER}},
        {"supports": {"west": PINNED}, "springs": [{"node": "C", "dof": "uz", "stiffness": 1e7}]},
        {"supports": {"west": PINNED, "east": {"node": "C", "along": [0.5, 0, 1]}}},
    ],
)
def test_what_is_held_stands(held: dict[str, Any]) -> None:
    model = read_model({**bridge({}), **held}, "m.json")
    assert check(model).ok


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"node": "B"}, "a displacement sensor needs 'direction'"),
        ({"direction": [0, 0, 1]}, "a displacement sensor needs 'node'"),
        ({}, "a displacement sensor needs 'node' and 'direction'"),
    ],
)
def test_a_sensor_is_told_what_it_lacks_and_no_more(keys: dict[str, Any], said: str) -> None:
    content = bridge({"west": PINNED, "east": ROLLER})
    content["sensors"]["D"] = {"kind": "displacement", "unit": "mm", **keys}
    with pytest.raises(InputError) as told:
        read_model(content, "m.json")
    assert told.value.what.endswith(said)
