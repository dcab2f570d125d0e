"""What there is to draw of a model."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from every_kind_bridge import bridge
from rga.drawing.content import asked, gather
from rga.drawing.scene.loads import load_marks
from rga.drawing.scene.scene import make_scene
from rga.drawing.scene.sensors import sensor_marks
from rga.drawing.scene.supports import support_marks
from rga.drawing.sheet.legend import load_words
from rga.drawing.views import axonometry, views_of
from rga.errors import InputError
from rga.model import Model, read_model


class TestScene:
    def test_a_model_without_members_is_refused(self, beam: Callable[..., Model]) -> None:
        with pytest.raises(InputError, match="nothing to draw"):
            make_scene(beam(members={}))

    def test_the_largest_sizes_are_numbers(self, beam: Callable[..., Model]) -> None:
        scene = make_scene(beam(nodes={"a": [0, 0, 0], "b": [1e30, 0, 0]}))
        assert scene.extent == 1e30

    def test_members_go_by_their_first_group(self, small_bridge: dict[str, Any]) -> None:
        scene = make_scene(read_model(small_bridge, "bridge"))
        assert scene.groups == ("bottom chord", "top chord", "verticals", "diagonals")
        assert np.bincount(scene.group).tolist() == [4, 2, 3, 4]

    @pytest.mark.parametrize(
        ("fixed", "sort"),
        [
            (["ux", "uz", "ry"], "fixed"),
            (["ux", "uz"], "pinned"),
            (["uz"], "links"),
            (["ry"], "links"),
            (["ux", "uy", "uz", "rx"], "pinned"),
        ],
    )
    def test_supports_of_a_plane(
        self, beam: Callable[..., Model], fixed: list[str], sort: str
    ) -> None:
        scene = make_scene(beam(supports={"one": {"node": "a", "fixed": fixed}}))
        (mark,) = support_marks(scene)
        assert mark.sort == sort
        assert mark.outward.tolist() == [-1.0, 0.0, 0.0]

    def test_supports_at_one_node_are_drawn_as_one(self, beam: Callable[..., Model]) -> None:
        halves = {"x": {"node": "a", "fixed": ["ux"]}, "z": {"node": "a", "along": [0, 0, 2]}}
        (mark,) = support_marks(make_scene(beam(supports=halves)))
        assert (mark.name, mark.sort) == ("x, z", "pinned")
        assert mark.held.tolist() == [[1, 0, 0], [0, 0, 1]]


class TestLoads:
    def test_forces_are_those_at_the_contexts(self, beam: Callable[..., Model]) -> None:
        scene = make_scene(beam())
        (mark,) = load_marks(scene, None, {"crane": 3})
        assert mark.forces.tolist() == [[0, 0, -3000]]
        assert load_words(mark).replace("\u00a0", " ") == "crane: up to 3.00 kN at crane = 3 kN"

    def test_what_is_nothing_at_mid_range_is_drawn_at_the_upper_end(
        self, beam: Callable[..., Model]
    ) -> None:
        both = {"crane": {"unit": "kN", "range": [-4, 4]}}
        (mark,) = load_marks(make_scene(beam(context=both)))
        assert mark.at == "crane = 4 kN"
        assert load_marks(make_scene(beam(context=both)), None, {"crane": 0}) == []

    def test_a_load_that_is_not_there_is_told(self, beam: Callable[..., Model]) -> None:
        scene = make_scene(beam())
        with pytest.raises(InputError, match=r"no load 'wind'.*it has crane"):
            load_marks(scene, ["wind"])
        with pytest.raises(InputError, match="puts no force"):
            load_marks(scene, ["crane"], {"crane": 0})
        with pytest.raises(InputError, match="no context variable 'snow'"):
            load_marks(scene, None, {"snow": 1})

    def test_every_kind_of_load_has_its_place(self) -> None:
        scene = make_scene(bridge())
        marks = {mark.name: mark for mark in load_marks(scene)}
        assert list(marks) == ["people", "cart", "tank", "snow"]
        path = [scene.nodes[node] for node in ("as", "bs", "cs")]
        assert marks["cart"].path == tuple(path)
        # The axles are a metre apart, and stand in the middle of the eight metres.
        assert sorted(marks["cart"].points[:, 0]) == [3.5, 4.5]
        snow = marks["snow"].along
        assert {one.member for one in snow} == {scene.members["bs-bn"], scene.members["as-an"]}
        assert {float(np.linalg.norm(one.forces[0])) for one in snow} == {np.hypot(500, 2000)}

    def test_axles_stand_where_the_context_says(self) -> None:
        (mark,) = load_marks(make_scene(bridge()), ["cart"], {"cart": 2.0})
        assert sorted(mark.points[:, 0]) == [1.0, 2.0]
        assert mark.forces[:, 2].tolist() == [-3e4, -2e4]

    def test_a_point_load_stands_on_its_member(self, beam: Callable[..., Model]) -> None:
        point = {"kind": "member_load", "member": "ab", "point": [3, 0, -7], "x": 1.0}
        (mark,) = load_marks(make_scene(beam(effects={"point": point})))
        assert mark.points.tolist() == [[1.0, 0.0, 0.0]]
        assert mark.forces.tolist() == [[3.0, 0.0, -7.0]]

    def test_beside_a_response_stand_only_loads_that_act(self, beam: Callable[..., Model]) -> None:
        one = {"kind": "nodal_load", "forces": {"b": [0, 0, -1000]}}
        loads = {name: {**one, "factor": {"context": name}} for name in ("crane", "wind")}
        ranges = {"crane": [0, 8], "wind": [-4, 4]}
        model = beam(
            context={name: {"unit": "kN", "range": ends} for name, ends in ranges.items()},
            effects=loads,
        )
        assert [mark.name for mark in gather(model, asked({"deformed": True})).loads] == ["crane"]


class TestSensors:
    def test_a_gauge_sits_on_the_side_of_its_fibre(self, beam: Callable[..., Model]) -> None:
        strain = {"kind": "strain", "member": "ab", "unit": "microstrain", "at": 0.25}
        top, bottom = {**strain, "z": 0.1}, {**strain, "z": -0.1}
        scene = make_scene(beam(sensors={"top": top, "bottom": bottom, "again": top}))
        marks = sensor_marks(scene, [])
        assert [mark.side.tolist() for mark in marks[:2]] == [[0, 0, 1], [0, 0, -1]]
        assert marks[0].point.tolist() == [0.75, 0.0, 0.0]
        assert [mark.place for mark in marks] == [0, 0, 1]

    def test_a_gauge_stands_ahead_of_a_node_where_a_load_comes_from(
        self, beam: Callable[..., Model]
    ) -> None:
        way = {"kind": "displacement", "node": "b", "unit": "mm"}
        sensors = {"down": {**way, "direction": [0, 0, -1]}, "up": {**way, "direction": [0, 0, 1]}}
        marks = gather(beam(sensors=sensors), asked({})).sensors
        assert [mark.ahead for mark in marks] == [True, False]


class TestViews:
    def test_a_plane_structure_has_one_view(self, beam: Callable[..., Model]) -> None:
        (view,) = views_of(make_scene(beam()))
        assert (view.right, view.up, view.straight) == ((1, 0, 0), (0, 0, 1), True)

    def test_a_column_is_upright_in_its_view(self, beam: Callable[..., Model]) -> None:
        (view,) = views_of(make_scene(beam(plane="yz", nodes={"a": [0, 0, 0], "b": [0, 0, 3]})))
        assert view.flat(np.array([0.0, 0.0, 3.0])).tolist() == [0.0, 3.0]

    def test_in_space_there_are_an_axonometry_elevations_and_a_plan(self) -> None:
        titles = [one.title for one in views_of(make_scene(bridge()))]
        assert titles[0] == "axonometry"
        assert titles[-1] == "plan"
        assert len(titles) == 4

    def test_an_axonometry_keeps_the_upright_up(self) -> None:
        view = axonometry(make_scene(bridge()))
        upward = view.flat(np.array([0.0, 0.0, 1.0]))
        assert upward[0] == 0
        assert upward[1] > 0.8
        assert np.array([view.right, view.up]) @ view.towards == pytest.approx([0, 0])
