"""Modes that a model expects, as a check looks at them."""

from typing import Any

import pytest

from rga import ModelBuilder
from rga.checking import check
from rga.model import Model, read_model
from rga.model.io import model_content


def mast(modes: dict[str, Any], density: float = 7850.0, axis: str = "xy") -> Model:
    """A column whose head sways in two directions, of which some are measured."""
    build = ModelBuilder("mast").add_material("steel", E=2.1e11, density=density)
    build.add_section("tube", A=8e-3, Iy=2e-5, Iz=6e-5, J=4e-5)
    for at in range(4):
        build.add_node(f"n{at}", z=2.0 * at)
        if at:
            build.add_member(f"n{at - 1}", f"n{at}", "tube", kind="frame", material="steel")
    content: dict[str, Any] = model_content(build.support("n0", "fixed").build())
    ways = {"x": [1, 0, 0], "y": [0, 1, 0]}
    points = {
        f"{way}{at}": {"node": f"n{at}", "direction": ways[way]} for way in axis for at in (2, 3)
    }
    return read_model({**content, "points": points, "modes": modes}, "mast.json")


def told(model: Model) -> list[str]:
    findings = [str(one) for one in check(model).findings if one.severity != "note"]
    return [one for one in findings if "mode" in one or "mass" in one]


TWO = {"a": {"near": 2.0, "computed": 1}, "b": {"near": 3.0, "computed": 2}}


def test_modes_that_the_points_see_are_sound() -> None:
    assert told(mast(TWO)) == []


@pytest.mark.parametrize(("axis", "unseen"), [("x", "b"), ("y", "a")])
def test_a_mode_that_moves_no_point_is_known_by_its_frequency_alone(axis: str, unseen: str) -> None:
    (one,) = told(mast(TWO, axis=axis))
    assert "every point stands still in it: it is known by its frequency alone" in one
    assert f"(mode '{unseen}')" in one


@pytest.mark.parametrize(("near", "same"), [(2.001, True), (2.1, False)])
def test_two_modes_that_look_the_same(near: float, same: bool) -> None:
    shape = {"x2": 0.5, "x3": 1.0, "y2": 0.0, "y3": 0.0}
    modes = {"a": {"near": 2.0, "shape": shape}, "b": {"near": near, "shape": shape}}
    found = [one for one in told(mast(modes)) if "cannot be told apart" in one]
    assert len(found) == same
    across = {"x2": 0.0, "x3": 0.0, "y2": 0.5, "y3": 1.0}
    assert told(mast({**modes, "b": {"near": near, "shape": across}})) == []


def test_a_model_of_modes_without_masses_is_an_error() -> None:
    (one,) = told(mast({"a": {"near": 2.0}}, density=0.0))
    assert one.startswith("error: nothing that can move has a mass")
    assert one.endswith("state densities or masses")
