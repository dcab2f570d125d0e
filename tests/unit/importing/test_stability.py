"""Parts that no support holds as a whole are found, and how they move."""

from typing import Any

import pytest

from rga.importing.stability import free_motions

ALL = ["ux", "uy", "uz"]


def content(**parts: Any) -> dict[str, Any]:
    nodes = {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 0, 3]}
    members = {"AB": {"nodes": ["A", "B"]}, "BC": {"nodes": ["B", "C"]}}
    return {"nodes": nodes, "members": members, "supports": {}, **parts}


def held(**dofs: list[str]) -> dict[str, Any]:
    return {node: {"node": node, "fixed": fixed} for node, fixed in dofs.items()}


class TestFreeMotions:
    @pytest.mark.parametrize(
        ("parts", "said"),
        [
            ({"supports": held(A=ALL, B=ALL)}, "can turn about an axis along x"),
            ({"supports": held(A=ALL, B=ALL), "plane": "xz"}, ""),
            ({"supports": held(A=["ux", "uz"]), "plane": "xz"}, "can turn about an axis along y"),
            ({"supports": held(A=["uz"], B=["uz"]), "plane": "xz"}, "can move along x"),
            ({"supports": held(A=[*ALL, "rx", "ry", "rz"])}, ""),
            (
                {
                    "supports": held(A=ALL, B=["uy", "uz"]),
                    "springs": [{"node": "C", "dof": "uy", "stiffness": 1.0}],
                },
                "",
            ),
        ],
    )
    def test_a_structure_that_can_move_is_named(self, parts: dict[str, Any], said: str) -> None:
        assert [how for _, how in free_motions(content(**parts))] == ([said] if said else [])

    def test_parts_that_nothing_joins_are_found_one_by_one(self) -> None:
        alone = content(supports=held(A=[*ALL, "rx", "ry", "rz"]))
        alone["nodes"]["D"] = [9, 9, 9]
        assert [which for which, _ in free_motions(alone)] == ["node D"]
