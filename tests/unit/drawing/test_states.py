"""Deformed shapes and diagrams against closed forms."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from every_kind_bridge import bridge
from rga.arrays import FloatArray
from rga.drawing.content import asked, gather
from rga.drawing.scene.scene import make_scene
from rga.drawing.sheet.states import _same_signs
from rga.drawing.states.deformed import member_curves
from rga.drawing.states.diagrams import Quantity
from rga.drawing.states.response import drawn_response
from rga.errors import UnstableStructureError
from rga.model import Model, read_model
from rga.simulation import results

EI, SPAN, FORCE = 2e11 * 1e-5, 3.0, 5000.0
X = np.linspace(0.0, SPAN, 13)


def node_displacements(model: Model, contexts: dict[str, float]) -> FloatArray:
    """Of all nodes, float[nodes, 6] [m, rad]."""
    return results(model, contexts).displacements[0]


def deflection(model: Model) -> FloatArray:
    """Of the one member, downward [m]."""
    moved = node_displacements(model, {"crane": FORCE / 1000})
    return -member_curves(make_scene(model), moved)[0, :, 2]


class TestDeformed:
    def test_a_cantilever_bends_as_its_closed_form_says(self, beam: Callable[..., Model]) -> None:
        exact = FORCE * X**2 * (3 * SPAN - X) / (6 * EI)
        assert deflection(beam()) == pytest.approx(exact, rel=1e-9, abs=1e-12)

    def test_a_spring_at_its_root_adds_a_turn(self, beam: Callable[..., Model]) -> None:
        bent = FORCE * X**2 * (3 * SPAN - X) / (6 * EI)
        exact = bent + FORCE * SPAN * X / 3e6
        soft = deflection(beam({"end_springs": {"i": {"ry": 3e6}}}))
        assert soft == pytest.approx(exact, rel=1e-9, abs=1e-12)

    def test_a_released_end_does_not_follow_its_node(self, beam: Callable[..., Model]) -> None:
        """The far end is pinned and sinks: w = w0 (3 s2 - s3) / 2, whatever turns the node has."""
        model = beam({"releases": {"j": ["ry"]}})
        moved = np.zeros((2, 6))
        moved[1] = [0.0, 0.0, -0.01, 0.0, 0.7, 0.0]
        share = X / SPAN
        curve = -member_curves(make_scene(model), moved)[0, :, 2]
        assert curve == pytest.approx(0.01 * (3 * share**2 - share**3) / 2, abs=1e-15)

    def test_a_member_released_at_both_ends_stays_straight(
        self, beam: Callable[..., Model]
    ) -> None:
        model = beam({"releases": {"i": ["ry"], "j": ["ry"]}})
        moved = np.array([[0, 0, 0, 0, 0.3, 0], [0, 0, -0.01, 0, -0.2, 0]], dtype=float)
        curve = -member_curves(make_scene(model), moved)[0, :, 2]
        assert curve == pytest.approx(0.01 * X / SPAN, abs=1e-15)

    def test_curves_of_any_structure_meet_its_nodes(self) -> None:
        model = bridge()
        moved = node_displacements(model, dict.fromkeys(model.context, 1.0))
        scene = make_scene(model)
        curves = member_curves(scene, moved)
        assert curves[:, 0] == pytest.approx(moved[scene.ends[:, 0], :3], abs=1e-15)
        assert curves[:, -1] == pytest.approx(moved[scene.ends[:, 1], :3], abs=1e-15)

    def test_a_frame_member_in_space_bends_about_both_axes(
        self, beam: Callable[..., Model]
    ) -> None:
        """Cut in two the member has a node in its middle, which lies on the curve of the whole."""
        fixed = {"wall": {"node": "a", "fixed": ["ux", "uy", "uz", "rx", "ry", "rz"]}}
        load = {"kind": "nodal_load", "forces": {"b": [10, 700, -1000, 30, 400, -90]}}
        own = {"section": "s", "material": "m", "kind": "frame", "local_y": [0.2, 1, 0.5]}
        nodes = {"a": [0, 0, 0], "b": [2, 1, 0.5], "c": [1, 0.5, 0.25]}
        parts = {"plane": None, "supports": fixed, "effects": {"load": load}, "nodes": nodes}
        cut = beam(members={"ac": {"nodes": ["a", "c"], **own}, "cb": {"nodes": ["c", "b"], **own}},
                   **parts)  # fmt: skip
        del nodes["c"]
        whole = beam(members={"ab": {"nodes": ["a", "b"], **own}}, **parts)
        middle = member_curves(make_scene(whole), node_displacements(whole, {"crane": 0}))[0, 6]
        assert middle == pytest.approx(node_displacements(cut, {"crane": 0})[2, :3], rel=1e-9)

    def test_the_scale_is_round_and_stated(self, beam: Callable[..., Model]) -> None:
        drawn = gather(beam(), asked({"deformed": True, "contexts": {"crane": 5}})).response
        assert drawn is not None
        shape = drawn.deformed
        assert shape is not None
        assert shape.largest == pytest.approx(FORCE * SPAN**3 / (3 * EI))
        assert (shape.at, shape.scale, drawn.contexts) == ("b", 5.0, "crane = 5 kN")

    def test_where_nothing_moves_at_mid_range_contexts_stand_at_their_upper_ends(
        self, beam: Callable[..., Model]
    ) -> None:
        model = beam(context={"crane": {"unit": "kN", "range": [-5, 5]}})
        drawn = gather(model, asked({"deformed": True}))
        assert drawn.response is not None
        assert drawn.response.deformed is not None
        assert drawn.response.deformed.largest == pytest.approx(FORCE * SPAN**3 / (3 * EI))
        assert drawn.response.contexts == "crane = 5 kN"
        assert [mark.at for mark in drawn.loads] == ["crane = 5 kN"]
        still = gather(model, asked({"deformed": True, "contexts": {"crane": 0}})).response
        assert still is not None
        assert still.contexts == "crane = 0 kN"

    def test_forces_without_displacements_of_nodes_are_something(
        self, beam: Callable[..., Model]
    ) -> None:
        fixed = ["ux", "uz", "ry"]
        crane = {"kind": "member_load", "member": "ab", "uniform": [0, 0, -1e3],
                 "factor": {"context": "crane"}}  # fmt: skip
        model = beam(
            supports={node: {"node": node, "fixed": fixed} for node in ("a", "b")},
            effects={"crane": crane},
        )
        drawn = gather(model, asked({"forces": "M"})).response
        assert drawn is not None
        assert drawn.contexts == "crane = 5 kN"

    def test_a_mechanism_is_refused(self, beam: Callable[..., Model]) -> None:
        loose = beam(supports={"pin": {"node": "a", "fixed": ["ux", "uz"]}})
        with pytest.raises(UnstableStructureError, match="can move"):
            gather(loose, asked({"deformed": True}))
        assert gather(loose, asked({})).response is None


def outline(model: Model, quantity: Quantity) -> FloatArray:
    """The diagram of the first member: values with their sides, float[stations, 3]."""
    drawn = drawn_response(make_scene(model), {"crane": FORCE / 1000}, [quantity])
    (diagram,) = drawn.diagrams
    return np.outer(diagram.values[0], diagram.sides[0])


class TestDiagrams:
    def test_axial_forces_are_those_of_joints(self, two_bars: dict[str, Any]) -> None:
        model = read_model(two_bars, "two bars")
        contexts = {name: sum(one.range) / 2 for name, one in model.context.items()}
        scene = make_scene(model)
        forces = drawn_response(scene, contexts, ["N"]).diagrams[0].values
        assert forces[:, 0] == pytest.approx(forces[:, 1])
        top = scene.ends[0, 0] if (scene.ends == scene.ends[0, 0]).sum() == 2 else scene.ends[0, 1]
        away = np.where(scene.ends[:, :1] == top, 1.0, -1.0) * scene.axes[:, 0]
        load = gather(model, asked({"contexts": contexts})).loads[0]
        pushed = load.forces[load.nodes == top].sum(axis=0)
        assert away.T @ forces[:, 0] + pushed == pytest.approx(np.zeros(3), abs=1e-6)

    @pytest.mark.parametrize("local_y", [[0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    @pytest.mark.parametrize("nodes", [["a", "b"], ["b", "a"]])
    def test_moments_stand_on_the_side_in_tension(
        self, beam: Callable[..., Model], local_y: list[float], nodes: list[str]
    ) -> None:
        """Of a cantilever under a load at its tip that is the upper side, however its axes lie."""
        drawn = outline(beam({"local_y": local_y, "nodes": nodes}), "M")
        x = np.linspace(0.0, SPAN, 21)
        exact = FORCE * (SPAN - x if nodes == ["a", "b"] else x)
        assert drawn[:, 2] == pytest.approx(exact, abs=1e-6 * FORCE)
        assert drawn[:, :2] == pytest.approx(np.zeros((21, 2)), abs=1e-6)

    def test_a_load_along_a_member_bends_it_into_a_parabola(
        self, beam: Callable[..., Model]
    ) -> None:
        ends = {"l": {"node": "a", "fixed": ["ux", "uz"]}, "r": {"node": "b", "fixed": ["uz"]}}
        snow = {"kind": "member_load", "member": "ab", "uniform": [0, 0, -800]}
        model = beam(supports=ends, effects={"snow": snow})
        x = np.linspace(0.0, SPAN, 21)
        sag = outline(model, "M")[:, 2]
        assert -sag == pytest.approx(800 * x * (SPAN - x) / 2, abs=1e-6)
        shear = np.abs(outline(model, "V")[:, 2])
        assert shear == pytest.approx(np.abs(800 * (SPAN / 2 - x)), abs=1e-6)

    def test_a_force_between_the_nodes_is_a_jump_of_shear_and_a_peak_of_moment(
        self, beam: Callable[..., Model]
    ) -> None:
        ends = {"l": {"node": "a", "fixed": ["ux", "uz"]}, "r": {"node": "b", "fixed": ["uz"]}}
        push = {"kind": "member_load", "member": "ab", "point": [0, 0, -FORCE], "x": 1.01}
        model = beam(supports=ends, effects={"push": push})
        shear, moment = drawn_response(make_scene(model), {}, ["V", "M"]).diagrams
        (jump,) = np.flatnonzero(np.diff(shear.positions[0]) == 0)
        assert shear.positions[0, jump] == pytest.approx(1.01 / SPAN)
        sides = shear.values[0, jump : jump + 2]
        assert np.abs(np.diff(sides)) == pytest.approx(FORCE)
        assert {jump, jump + 1} <= set(shear.told(0))
        assert moment.largest == pytest.approx(FORCE * 1.01 * (SPAN - 1.01) / SPAN)
        assert moment.positions[0, moment.told(0)[0]] == pytest.approx(1.01 / SPAN)

    def test_values_are_told_at_both_ends_and_where_they_are_largest_between(
        self, beam: Callable[..., Model]
    ) -> None:
        fixed = ["ux", "uz", "ry"]
        snow = {"kind": "member_load", "member": "ab", "uniform": [0, 0, -800]}
        model = beam(
            supports={node: {"node": node, "fixed": fixed} for node in ("a", "b")},
            effects={"snow": snow},
        )
        (diagram,) = drawn_response(make_scene(model), {}, ["M"]).diagrams
        values = diagram.values[0, diagram.told(0)]
        assert sorted(np.abs(values)) == pytest.approx(
            [800 * SPAN**2 / 24, 800 * SPAN**2 / 12, 800 * SPAN**2 / 12]
        )

    def test_what_is_even_is_told_once(self, two_bars: dict[str, Any]) -> None:
        model = read_model(two_bars, "two bars")
        (diagram,) = drawn_response(make_scene(model), {}, ["N"]).diagrams
        assert [len(diagram.told(member)) for member in range(2)] == [1, 1]

    def test_in_space_components_are_drawn_by_their_names(self) -> None:
        scene = make_scene(bridge())
        contexts = dict.fromkeys(bridge().context, 1.0)
        drawn = drawn_response(scene, contexts, ["M", "My", "V", "Vz", "Mz", "T"]).diagrams
        for general, own in (drawn[:2], drawn[2:4]):
            assert np.array_equal(general.values, own.values)
            assert np.array_equal(general.sides, own.sides)
        assert [one.unit for one in drawn] == ["N m", "N m", "N", "N", "N m", "N m"]
        assert np.array_equal(drawn[4].sides, -scene.axes[:, 1])

    def test_stretches_are_cut_where_values_pass_zero(self) -> None:
        stretches = _same_signs(np.array([0.0, 0.5, 1.0]), np.array([2.0, -2.0, -1.0]))
        assert [part.tolist() for part, _ in stretches] == [[0.0, 0.25], [0.25, 0.5, 1.0]]
        assert [values.tolist() for _, values in stretches] == [[2.0, 0.0], [0.0, -2.0, -1.0]]
