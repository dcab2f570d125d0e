"""The drawing of a structure: every part once, within its box."""

from typing import Any

import pytest

from rga.dashboard.svg.structure import WIDE, elevations, outline
from rga.model import read_model
from rga.report.drawing.places import Named
from served.bridges import long_bridge

NOTHING = Named(frozenset(), frozenset())


@pytest.mark.parametrize("panels", [4, 100])
def test_every_part_is_drawn_once_within_the_box(panels: int) -> None:
    model = read_model(long_bridge(panels), "long")
    (view,) = elevations(model, NOTHING, {})
    high = float(view.box.split()[3])
    assert sorted(one.number for one in view.dots) == list(range(len(model.sensors)))
    assert sorted(one.number for one in view.bars) == list(range(len(model.members)))
    assert all(0 <= one.x <= WIDE and 0 <= one.y <= high for one in view.dots)
    assert all(0 <= one.x <= WIDE and 0 <= one.y <= high for one in view.names)


def test_names_are_those_that_matter_most() -> None:
    model = read_model(long_bridge(100), "long")
    (view,) = elevations(model, NOTHING, {"S77": 9.0, "S200": 8.0})
    assert {"S77", "S200"} <= {one.words for one in view.names}


def test_what_is_named_is_marked(measured_bridge: dict[str, Any]) -> None:
    model = read_model(measured_bridge, "small")
    (view,) = elevations(model, Named(frozenset({"L0-L1"}), frozenset({"L4"})), {})
    assert [one.name for one in view.bars if one.marked] == ["L0-L1"]
    assert [(one.name, one.marked) for one in view.feet] == [("west", False), ("east", True)]
    assert not any(one.marked for one in outline(model).bars)
