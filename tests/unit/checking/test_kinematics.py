"""Motions that deform no member: as many as the structure has, and where it has them."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rga.checking import check, kinematics
from rga.checking.kinematics import free_motions
from rga.model import read_model
from rga.model.structure import build_structure


def motions(content: dict[str, Any]) -> NDArray[np.float64]:
    return free_motions(build_structure(read_model(content, "model")).arrays)


def truss(panels: int, without: tuple[str, ...] = ()) -> dict[str, Any]:
    """A plane truss with a diagonal in every panel."""
    pairs = [(f"L{k}", f"L{k + 1}") for k in range(panels)]
    pairs += [(f"U{k}", f"U{k + 1}") for k in range(panels)]
    pairs += [(f"L{k}", f"U{k}") for k in range(panels + 1)]
    pairs += [(f"L{k}", f"U{k + 1}") for k in range(panels)]
    names = {f"{a}-{b}": [a, b] for a, b in pairs if f"{a}-{b}" not in without}
    last = f"L{panels}"
    return {
        "rga_model": 1,
        "name": "truss",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": {
            **{f"L{k}": [2.0 * k, 0, 0] for k in range(panels + 1)},
            **{f"U{k}": [2.0 * k, 0, 2] for k in range(panels + 1)},
        },
        "members": {
            name: {"nodes": pair, "section": "bar", "material": "steel"}
            for name, pair in names.items()
        },
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": last, "fixed": ["uz"]},
        },
    }


def test_a_truss_stands_and_one_without_diagonals_has_a_motion_for_each() -> None:
    assert len(motions(truss(6))) == 0
    assert len(motions(truss(6, ("L1-U2",)))) == 1
    three = motions(truss(6, ("L1-U2", "L3-U4", "L5-U6")))
    assert three.shape == (3, 14, 6)
    assert np.abs(three).max(axis=(1, 2)) == pytest.approx(1.0)


def test_every_motion_is_told() -> None:
    without = ("L1-U2", "L3-U4", "L5-U6")
    found = check(read_model(truss(6, without), "truss")).findings
    said = [one for one in found if "nothing resists a motion" in one.what]
    assert len(said) == 3
    assert len({one.what for one in said}) == 3


def test_motions_of_one_node_are_told_of_it_alone() -> None:
    content = truss(4)
    content["nodes"]["X"] = [4.0, 0, 5.0]
    content["members"]["mast"] = {"nodes": ["U2", "X"], "section": "bar", "material": "steel"}
    (one,) = motions(content)
    moving = [list(content["nodes"])[k] for k in np.flatnonzero(np.abs(one).any(axis=1))]
    assert moving == ["X"]
    (said,) = (one for one in check(read_model(content, "m")).findings if one.severity == "error")
    assert said.what == "nothing resists a motion of node 'X' in ux"
    assert said.where == "member 'mast'"


def test_large_structures_give_the_same_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    content = truss(40, ("L7-U8", "L30-U31"))
    dense = motions(content)
    monkeypatch.setattr(kinematics, "FEW", 10)
    sparse = motions(content)
    assert len(dense) == len(sparse) == 2
    spans = (one.reshape(2, -1) for one in (dense, sparse))
    bases = [np.linalg.qr(one.T)[0] for one in spans]
    assert np.linalg.svd(bases[0].T @ bases[1])[1] == pytest.approx([1.0, 1.0])
    assert len(motions(truss(40))) == 0


FRAME = {"section": "I", "material": "steel", "kind": "frame"}


def cantilever(**member: Any) -> dict[str, Any]:
    return {
        "rga_model": 1,
        "name": "cantilever",
        "materials": {"steel": {"E": 2e11}},
        "sections": {"I": {"A": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}},
        "nodes": {"A": [0, 0, 0], "B": [3, 1, 2]},
        "members": {"beam": {"nodes": ["A", "B"], **FRAME, **member}},
        "supports": {"A": {"node": "A", "fixed": ["ux", "uy", "uz", "rx", "ry", "rz"]}},
    }


@pytest.mark.parametrize(
    ("member", "ways"),
    [
        ({}, 0),
        ({"releases": {"i": ["ry"]}}, 1),
        ({"releases": {"i": ["ry", "rz"]}}, 2),
        ({"releases": {"i": ["ux"]}}, 1),
        ({"releases": {"j": ["rx", "ry", "rz"]}}, 0),  # what nothing stiffens is held
        ({"end_springs": {"i": {"ry": 1e6}}}, 0),
    ],
)
def test_releases_in_space(member: dict[str, Any], ways: int) -> None:
    content = cantilever(**member)
    assert len(motions(content)) == ways
    assert check(read_model(content, "m")).ok == (ways == 0)


def test_restraints_of_every_kind_hold() -> None:
    content = cantilever(releases={"i": ["ry", "rz"]})
    for held in (
        {"springs": [{"node": "B", "dof": dof, "stiffness": 1e6} for dof in ("uy", "uz")]},
        {"supports": {**content["supports"], "B": {"node": "B", "fixed": ["uy", "uz"]}}},
        {"springs": [{"node": "A", "to": "B", "dof": d, "stiffness": 1e6} for d in ("uy", "uz")]},
        {"ties": [{"nodes": ["A", "B"], "dofs": ["uy", "uz"]}]},
    ):
        assert len(motions({**content, **held})) == 0
    inclined = {**content["supports"], "B": {"node": "B", "along": [0, 1, 1]}}
    assert len(motions({**content, "supports": inclined})) == 1


@pytest.mark.parametrize("seed", range(40))
def test_what_the_solver_refuses_has_a_motion_and_what_it_takes_has_none(seed: int) -> None:
    draw = np.random.default_rng(seed)
    panels = int(draw.integers(2, 5))
    content = truss(panels)
    for name in draw.choice(list(content["members"]), int(draw.integers(0, 3)), replace=False):
        del content["members"][name]
    if draw.random() < 0.5:
        content["sections"]["bar"] |= {"Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}
        for name in draw.choice(list(content["members"]), 4, replace=False):
            ends = {"i": ["ry"]} if draw.random() < 0.3 else {}
            content["members"][name] |= {"kind": "frame", "releases": ends}
    model = read_model(content, "random")
    found = check(model)
    assert (len(motions(content)) == 0) == found.ok, str(found)
