"""A mast with points and modes to which files of other programs are read."""

import pytest

import rga
from rga.model import Model, read_model

POINTS = ("n1_x", "n1_y", "n2_x", "n2_y")


@pytest.fixture(scope="session")
def mast() -> Model:
    build = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    build.add_node("foot").add_node("middle", z="3 m").add_node("head", z="6 m")
    build.add_member("foot", "middle", "tube", kind="frame")
    build.add_member("middle", "head", "tube", kind="frame")
    build.support("foot", "fixed").context("air", "degC", (-20.0, 40.0))
    content = build.build().model_dump(mode="json", exclude_defaults=True)
    along = {"x": [1, 0, 0], "y": [0, 1, 0]}
    content["points"] = {
        f"n{node}_{axis}": {"node": name, "direction": along[axis]}
        for node, name in ((1, "middle"), (2, "head"))
        for axis in "xy"
    }
    content["modes"] = {"L1": {"near": 4.0, "computed": 1}, "V1": {"near": 7.0, "computed": 2}}
    return read_model(content, "a test")
