"""Models built part by part."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from rga.building import ModelBuilder, circular_hollow, steel
from rga.errors import InputError
from rga.model import load_model, model_content
from rga.model.effects.loads.nodal_load import NodalLoad
from rga.simulation import Simulator


def beam() -> ModelBuilder:
    """A simply supported beam of two pieces."""
    builder = ModelBuilder("beam", plane="xz").add_material("steel", "S355")
    builder.add_section("beam", "IPE 300")
    for name, x in (("A", "0 m"), ("B", "3 m"), ("C", "6 m")):
        builder.add_node(name, x)
    builder.add_member("A", "B", "beam", kind="frame", groups="beams")
    builder.add_member("B", "C", "beam", kind="frame", groups="beams")
    return builder.support("A", "pinned").support("C", "roller along x")


class TestBuilding:
    def test_what_it_builds_is_the_model_file(self, tmp_path: Path) -> None:
        builder = beam().load_case("weight", uniform={"beams": (0, 0, "-8 kN/m")})
        model = builder.write(tmp_path / "model.json")
        read = load_model(tmp_path / "model.json")
        assert model_content(read) == model_content(model) == model_content(builder.build())
        assert read.members["A-B"].material == "steel"
        assert read.supports["C"].fixed == ["uz"]
        assert read.effects["weight"].place == {"member": ["A-B", "B-C"]}

    def test_the_strong_axis_carries_vertical_load_without_a_word(self) -> None:
        """By 5 q L^4 / 384 E Iy."""
        builder = beam().load_case("weight", uniform={"beams": (0, 0, "-8 kN/m")})
        builder.sensors("displacement", ["B"], direction="down")
        section = builder.build().sections["beam"]
        assert section.Iy > 10 * section.Iz
        sag = Simulator(builder.build()).predict({"time": np.zeros(1)})[0, 0]
        assert sag == pytest.approx(1e3 * 5 * 8000 * 6**4 / (384 * 2.1e11 * section.Iy), rel=1e-9)

    def test_a_builder_goes_on_with_a_model(self) -> None:
        first = beam().mass("B", "250 kg").build()
        second = ModelBuilder.of(first).load_case("one", down={"B": "1 kN"}).build()
        assert second.masses["B"].mass == 250.0
        assert ModelBuilder.of(second).build() == second
        assert first.effects == {}

    def test_parts_take_quantities_of_every_kind(self) -> None:
        builder = ModelBuilder("mixed", about={"client": "Roads office"})
        builder.add_material("own", E="70 GPa", alpha="23e-6/K", density="2.7 t/m^3",
                             yield_strength="240 MPa")  # fmt: skip
        builder.add_section("tube", circular_hollow("60.3 mm", "5 mm"))
        builder.add_section("own", A="12 cm2", Iy="80 cm4", Asz="4 cm^2",
                            fibres={"top": (0, "50 mm")})  # fmt: skip
        builder.add_node("A").add_node("B", "1 m", "200 cm", 3)
        ends = {"i": ["ry"]}, {"j": {"rz": "2 kN m/rad"}}
        builder.add_member("A", "B", "own", name="bar", kind="frame", local_y="y",
                           releases=ends[0], end_springs=ends[1])  # fmt: skip
        builder.support("A", "fixed").support("B", along=(1, 0, 1), name="skew")
        builder.spring("B", "uz", "24 kN/mm").spring("B", "rx", "5 kN m").tie("A", "B", "uy")
        model = builder.build()
        assert model.about.client == "Roads office"
        own = model.materials["own"]
        assert (own.E, own.alpha, own.density, own.yield_strength) == pytest.approx(
            (7e10, 2.3e-5, 2700.0, 2.4e8)
        )
        section = model.sections["own"]
        assert (section.A, section.Iy, section.Asz) == pytest.approx((1.2e-3, 8e-7, 4e-4))
        assert section.fibres == {"top": (0.0, 0.05)}
        assert model.nodes["B"] == (1.0, 2.0, 3.0)
        assert model.members["bar"].end_springs.j == {"rz": 2000.0}
        assert [spring.stiffness for spring in model.springs] == [2.4e7, 5000.0]
        assert model.supports["skew"].along == (1.0, 0.0, 1.0)
        assert len(model.supports["A"].fixed) == 6

    def test_loads_of_several_sorts_become_effects_with_one_factor(self) -> None:
        builder = beam().context("crowd", "kPa", (0, 5))
        builder.load_case("all", forces={"A": (0, 0, 0, 0, "2 kNm", 0)}, down={"B": "3 kN"},
                          points={"A-B": ("1.5 m", (0, 0, "-4 kN"))}, context="crowd")  # fmt: skip
        builder.load_case("plain", forces={"B": ("1 kN", 0, 0)}, factor=1.35)
        builder.axles("truck", ["A", "B", "C"], ["50 kN", 60000], "2.5 m", offsets=[0, "4 m"],
                      carried_by="members")  # fmt: skip
        builder.axles("cart", ["A", "B"], [1], "-2 m").axles("van", ["A", "B"], [1], "crowd")
        effects = builder.build().effects
        assert (effects.pop("cart").position, effects.pop("van").drivers()) == (-2.0, {"crowd"})
        assert list(effects) == ["all at nodes", "all on A-B", "plain", "truck"]
        nodal = effects["all at nodes"]
        assert isinstance(nodal, NodalLoad)
        assert nodal.forces == {"A": [0, 0, 0, 0, 2000, 0], "B": [0, 0, -3000]}
        assert effects["all on A-B"].drivers() == {"crowd"}
        assert effects["plain"].factor == 1.35
        assert (effects["truck"].forces, effects["truck"].position) == ([50000, 60000], 2.5)

    def test_warmth_takes_every_member_once_and_keeps_the_unit_of_its_context(self) -> None:
        builder = beam().context("air", "degC", ("250 K", "40 degC"), noise="0.3 K")
        builder.temperature("air", "283.15 K").sensors("displacement", ["C"], direction="x")
        model = builder.build()
        assert model.context["air"].range == pytest.approx((-23.15, 40.0))
        assert model.context["air"].noise == 0.3
        assert model.effects["warmth"].groups == {"beams": 1.0}
        moved = Simulator(model).predict({"air": np.array([10.0, 30.0])})[:, 0]
        assert moved == pytest.approx([0.0, 1e3 * 1.2e-5 * 20 * 6.0])

    def test_contexts_may_be_in_units_that_nobody_knows(self) -> None:
        model = beam().context("people", "people", (0, 80), noise=2).build()
        assert model.context["people"].unit == "people"
        with pytest.raises(InputError, match="'people' is no unit that is known"):
            beam().context("people", "people", (0, "2 kN"))

    def test_sensors_come_alike_in_numbers_and_at_fibres(self) -> None:
        builder = beam().sensors("strain", "beams", fibre="bottom left", at=0.9, noise="2 µm/m")
        builder.sensors("displacement", ["B", "C"], "dial {place}", direction="z", noise="50 um")
        builder.sensor("tilt", "rotation", node="A", direction="y", noise="0.01 mrad")
        sensors = builder.build().sensors
        assert list(sensors) == ["S A-B", "S B-C", "dial B", "dial C", "tilt"]
        assert (sensors["S A-B"].y, sensors["S A-B"].z) == (0.075, -0.15)
        assert sensors["S A-B"].noise == 2.0
        assert sensors["dial B"].noise == pytest.approx(0.05)
        assert sensors["tilt"].unit == "mrad"
        assert builder.nodes_in("beams") == ["A", "B", "C"]

    def test_any_effect_of_the_vocabulary_may_be_added(self) -> None:
        model = beam().effect("weak", "member_stiffness", member="A-B", factor=0.75).build()
        assert model.effects["weak"].kind == "member_stiffness"

    def test_it_opens_at_the_top(self) -> None:
        assert rga.ModelBuilder is ModelBuilder
        assert "ModelBuilder" in rga.__all__


WRONG: dict[str, tuple[Callable[[ModelBuilder], Any], str]] = {
    "unit": (lambda b: b.add_node("X", "3 kN"), "'3 kN' is of another dimension (node 'X')"),
    "twice": (lambda b: b.add_node("A", 1), "'A' exists already"),
    "no name": (lambda b: b.add_node("", 1), "'' is no name"),
    "kind": (lambda b: b.add_member("A", "C", "beam", kind="cable"), "kind: Input should be"),
    "release": (
        lambda b: b.add_member("A", "C", "beam", releases={"i": ["r1"], "j": ["rx", "q"]}),
        "releases.i.0: Input should be 'ux', 'uy', 'uz', 'rx', 'ry' or 'rz'; releases.j.1: ",
    ),
    "end": (
        lambda b: b.add_member("A", "C", "beam", releases={"start": ["ry"]}),
        "releases: 'start' is no end of a member: i is that at its first node, j at its second",
    ),
    "local_y": (lambda b: b.add_member("A", "C", "beam", local_y=(0, 0, 0)), "points nowhere"),
    "section": (lambda b: b.add_section("x", "IPE 301"), "did you mean IPE 300"),
    "no section": (lambda b: b.add_section("x"), "give A, or a section"),
    "area": (lambda b: b.add_section("x", A=-1), "A: Input should be greater than 0"),
    "grade": (lambda b: b.add_material("x", "S999"), "the grade 'S999' is unknown"),
    "no E": (lambda b: b.add_material("x"), "give E, or a grade of steel"),
    "support": (lambda b: b.support("B", "clamped"), "'clamped' is nothing that a support holds"),
    "roller": (lambda b: b.support("B", "roller along y"), "leaves the plane xz"),
    "nothing": (lambda b: b.support("B"), "it holds nothing"),
    "spring": (lambda b: b.spring("B", "uq", 1), "dof: Input should be"),
    "stiffness": (lambda b: b.spring("B", "ry", "3 kN/m"), "is of another dimension"),
    "range": (lambda b: b.context("c", "kPa", (2, 1)), "range [2.0, 1.0] must grow"),
    "law": (lambda b: b.context("c", "kPa", (0, 1), law="linear"), "needs a rate"),
    "reference": (lambda b: b.temperature("air", "10 degC"), "there is no context 'air' yet"),
    "empty": (lambda b: b.load_case("none"), "there is no load in it"),
    "force": (lambda b: b.load_case("f", forces={"A": (1, 2)}), "no list of 3 quantities"),
    "group": (lambda b: b.load_case("f", uniform={"roof": (0, 0, 1)}), "no member or group 'roof'"),
    "effect": (
        lambda b: b.effect("push", {"kind": "nodal_load"}),  # type: ignore[arg-type]
        "beside it: effect('push', 'nodal_load', forces={'B': [1000, 0, 0]})",
    ),
    "sensor kind": (lambda b: b.sensor("s", "stress", member="A-B"), "is no kind of sensor"),
    "sensor unit": (lambda b: b.sensor("s", "strain", member="A-B", unit="kg"), "the unit 'kg'"),
    "sensor key": (
        lambda b: b.sensor("s", "strain", member="A-B", on=1),
        "on: this key is unknown",
    ),
    "direction": (
        lambda b: b.sensor("s", "displacement", node="A", direction="left"),
        "'left' is no direction",
    ),
    "fibre": (
        lambda b: b.sensor("s", "strain", member="A-B", fibre="top"),
        "use one of its fibres (top left, top right, bottom left, bottom right)",
    ),
    "pattern": (lambda b: b.sensors("strain", "beams", "S"), "are all alike"),
    "suffix": (lambda b: b.write("model.yaml"), "give a name in .json"),
}


class TestMistakes:
    @pytest.mark.parametrize("wrong", WRONG)
    def test_a_wrong_value_is_refused_where_it_is_given(self, wrong: str) -> None:
        call, what = WRONG[wrong]
        with pytest.raises(InputError) as error:
            call(beam())
        assert what in str(error.value)

    def test_a_plane_is_one_of_three(self) -> None:
        with pytest.raises(InputError, match="'xw' is no plane"):
            ModelBuilder("wrong", plane="xw")  # type: ignore[arg-type]

    def test_what_does_not_fit_together_is_told_all_at_once(self) -> None:
        builder = beam().add_node("lone", 9).add_material("other", steel())
        builder.add_member("A", "X", "tube", material="brass").add_member("A", "A", "beam")
        builder.support("Y", "pinned").sensor("S", "strain", member="A-X2", noise=1)
        builder.sensor("D", "displacement", node="Z", direction="z").context("D", "-", (0, 1))
        builder.mass("M", 3).spring("A", "uz", 1, to="Q").tie("A", "W", "ux")
        with pytest.raises(InputError) as error:
            builder.build()
        for part in (
            "15 mistakes (model 'beam'): correct the names",
            "members.A-B: it names no material, of which there are 2",
            "members.A-X.nodes: there is no 'X' in nodes",
            "members.A-X.section: there is no 'tube' in sections",
            "members.A-X.material: there is no 'brass' in materials",
            "members.A-A.nodes: both ends are node 'A'",
            "supports.Y.node: there is no 'Y' in nodes",
            "springs[0]: there is no 'Q' in nodes",
            "ties[0]: there is no 'W' in nodes",
            "masses.M.node: there is no 'M' in nodes",
            "sensors.S.member: there is no 'A-X2' in members",
            "sensors.D: there is no 'Z' in nodes",
            "sensors.D: a context variable has the same name",
            "nodes.lone: no member ends there",
        ):
            assert part in str(error.value)

    def test_effects_that_do_not_fit_are_told_all_at_once(self) -> None:
        builder = beam().load_case("snow", down={"X": 1}, context="depth")
        builder.temperature("air", groups=["roof"]).effect("odd", "member_stifness", member="A-B")
        builder.effect("weak", "member_stiffness", member="A-B", factr=0.7)
        builder.effect("scaled", "load_scale", effect="wind", factor=2.0)
        with pytest.raises(InputError) as error:
            builder.build()
        for part in (
            "6 mistakes",
            "effects.snow: there is no 'X' in nodes",
            "effects.warmth: there is no context 'air' in the model",
            "effects.odd.kind: 'member_stifness' is no kind of effect",
            "effects.weak.factr: this key is unknown",
            "effects.scaled.effect: there is no effect 'wind'",
        ):
            assert part in str(error.value)

    def test_members_without_a_group_cannot_warm_unnamed(self) -> None:
        builder = beam().add_node("D", 9).add_member("C", "D", "beam", kind="frame")
        builder.context("air", "degC", (-20, 40)).temperature("air", 10)
        with pytest.raises(InputError, match="member 'C-D' is in no group that could warm"):
            builder.build()

    def test_many_mistakes_are_counted(self) -> None:
        builder = beam()
        for number in range(30):
            builder.add_node(f"N{number}", number)
        with pytest.raises(InputError, match=r"(?s)30 mistakes .* and 10 more"):
            builder.build()

    def test_a_file_is_written_whole_or_not_at_all(self, tmp_path: Path) -> None:
        target = tmp_path / "model.json"
        with pytest.raises(InputError):
            beam().add_node("lone").write(target)
        assert not target.exists()
        beam().write(target)
        assert json.loads(target.read_text())["name"] == "beam"
        with pytest.raises(InputError, match="cannot be written"):
            beam().write(target / "model.json")
