"""Generated structures: they stand, as symmetric as they are drawn, and carry as they should."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rga.building import (
    ModelBuilder,
    bowstring_truss,
    howe_truss,
    k_truss,
    lattice_mast,
    portal_frame,
    pratt_truss,
    space_truss_roof,
    steel,
    storey_frame,
    warren_truss,
)
from rga.errors import InputError
from rga.simulation import Simulator

Generator = Callable[..., ModelBuilder]
BARS = {"chords": "HEA 200", "diagonals": "HEA 120"}
#: panels, and members beyond those of a determinate truss
TRUSSES: dict[str, tuple[Generator, int, dict[str, Any], int]] = {
    "howe": (howe_truss, 8, {}, 0),
    "howe of 26 members": (howe_truss, 7, {}, 1),
    "howe, vertical ends": (howe_truss, 6, {"ends": "vertical"}, 0),
    "howe, gable": (howe_truss, 8, {"shape": "gable"}, 0),
    "pratt": (pratt_truss, 8, {}, 0),
    "pratt, odd": (pratt_truss, 5, {}, 1),
    "pratt, vertical ends": (pratt_truss, 7, {"ends": "vertical"}, 1),
    "pratt, gable": (pratt_truss, 6, {"shape": "gable"}, 0),
    "smallest": (pratt_truss, 2, {}, 0),
    "warren": (warren_truss, 6, {}, 0),
    "warren, odd": (warren_truss, 5, {}, 0),
    "warren with verticals": (warren_truss, 6, {"with_verticals": True}, 0),
    "K": (k_truss, 8, {}, 0),
    "smallest K": (k_truss, 4, {}, 0),
    "bowstring": (bowstring_truss, 8, {}, 0),
    "bowstring, odd": (bowstring_truss, 7, {}, 1),
}


def answers(builder: ModelBuilder, **contexts: float) -> dict[str, float]:
    """What its sensors read, by name."""
    model = builder.build()
    given = {name: np.array([value]) for name, value in contexts.items()} or {"time": np.zeros(1)}
    return dict(zip(model.sensors, Simulator(model).predict(given)[0].tolist(), strict=True))


def weighed(builder: ModelBuilder, load: str = "10 kN") -> dict[str, float]:
    """Forces in all members, and sags of all nodes, under the same load on all nodes."""
    builder.load_case("weight", down=dict.fromkeys(builder.nodes, load))
    names = list(builder.build().members)
    builder.sensors("force", names).sensors("displacement", builder.nodes, direction="down")
    return answers(builder)


class TestPlaneTrusses:
    @pytest.mark.parametrize("name", TRUSSES)
    def test_it_is_as_determinate_as_it_says_and_symmetric(self, name: str) -> None:
        build, panels, options, redundant = TRUSSES[name]
        truss = build("truss", "24 m", "3 m", panels, **BARS, **options)
        model = truss.build()
        assert len(model.members) == 2 * len(model.nodes) - 3 + redundant
        assert {node for one in model.members.values() for node in one.nodes} == set(model.nodes)
        found = weighed(truss)
        mirror = {
            tuple(round(part, 6) for part in (24 - x, z)): node
            for node, (x, _, z) in model.nodes.items()
        }
        for node, (x, _, z) in model.nodes.items():
            other = mirror[round(x, 6), round(z, 6)]
            assert found[f"D {node}"] == pytest.approx(found[f"D {other}"], abs=1e-9)
        by_ends = {frozenset(one.nodes): f"N {name}" for name, one in model.members.items()}
        mirrored = {mirror[round(x, 6), round(z, 6)]: node
                    for node, (x, _, z) in model.nodes.items()}  # fmt: skip
        for ends, force in by_ends.items():
            other = by_ends[frozenset(mirrored[node] for node in ends)]
            assert found[force] == pytest.approx(found[other], abs=1e-9)
        assert found[f"D L{panels // 2}"] > 0

    def test_the_chord_in_the_middle_carries_the_moment_over_the_height(self) -> None:
        found = weighed(pratt_truss("truss", "24 m", "3 m", 8, **BARS))
        # 16 loads of 10 kN: two at each inner place, one at each support, which it carries itself.
        moment = 70 * 12 - 20 * (9 + 6 + 3)
        assert found["N U3-U4"] == pytest.approx(-moment / 3)

    @pytest.mark.parametrize(
        ("build", "options", "pulled"),
        [
            (howe_truss, {}, "verticals"),
            (howe_truss, {"shape": "gable"}, "verticals"),
            (pratt_truss, {}, "diagonals"),
            (pratt_truss, {"shape": "gable"}, "diagonals"),
        ],
    )
    def test_howe_and_pratt_differ_by_what_pulls(
        self, build: Generator, options: dict[str, str], pulled: str
    ) -> None:
        truss = build("truss", "24 m", "3 m", 8, **BARS, **options)
        groups = truss.groups
        top = [node for node in truss.nodes if node.startswith("U")]
        truss.load_case("roof", down=dict.fromkeys(top, "10 kN"))
        found = answers(truss.sensors("force", "verticals").sensors("force", "diagonals"))
        pushed = {"verticals": "diagonals", "diagonals": "verticals"}[pulled]
        # Those beside the supports and in the middle carry nothing, or the load alone.
        assert all(found[f"N {name}"] > -1e-9 for name in groups[pulled])
        assert max(found[f"N {name}"] for name in groups[pulled]) > 10
        inner = [name for name in groups[pushed] if "1" not in name and "7" not in name]
        assert all(found[f"N {name}"] < 1e-9 or "4" in name for name in inner)
        assert min(found[f"N {name}"] for name in groups[pushed]) < -10

    def test_diagonals_of_a_bowstring_are_idle_under_the_same_load_everywhere(self) -> None:
        truss = bowstring_truss("truss", "24 m", "3 m", 8, **BARS)
        truss.load_case("deck", down={f"L{i}": "10 kN" for i in range(1, 8)})
        found = answers(truss.sensors("force", "diagonals").sensors("force", "bottom chord"))
        chord = 10 * 8 * 24 / (8 * 3)
        for name, force in found.items():
            idle = name.removeprefix("N ") in truss.groups["diagonals"]
            assert force == pytest.approx(0.0 if idle else chord, abs=1e-9)

    def test_rigid_joints_make_members_that_bend(self) -> None:
        pinned = howe_truss("truss", "24 m", "3 m", 8, **BARS)
        rigid = howe_truss("truss", "24 m", "3 m", 8, **BARS, joints="rigid")
        assert {one.kind for one in rigid.build().members.values()} == {"frame"}
        assert 0.9 < weighed(rigid)["D L4"] / weighed(pinned)["D L4"] < 1

    def test_sections_and_materials_may_be_ones_own(self) -> None:
        alloy = steel().model_copy(update={"E": 7e10})
        truss = howe_truss("t", 10, 2, 4, **BARS, verticals="L 60x60x6", material=alloy)
        model = truss.build()
        assert model.materials["material"].E == 7e10
        assert pytest.approx(6.91e-4, rel=2e-3) == model.sections["vertical"].A
        graded = howe_truss("t", 10, 2, 4, **BARS, material="S355").build()
        assert graded.materials["steel"].yield_strength == 3.55e8


class TestOtherStructures:
    @pytest.mark.parametrize("supported", ["corners", "edges"])
    def test_a_space_roof_carries_all_its_load_and_is_symmetric(self, supported: str) -> None:
        roof = space_truss_roof(
            "hall", (4, 4), "3 m", "2 m", chords="CHS 101.6x5", webs="CHS 76.1x4",
            supported=supported,
        )  # fmt: skip
        model = roof.build()
        assert (len(model.nodes), len(model.members)) == (25 + 16, 40 + 24 + 64)
        held = [support.node for support in model.supports.values()]
        assert len(held) == {"corners": 4, "edges": 16}[supported]
        roof.sensors("reaction", held, direction="up")
        found = weighed(roof)
        assert sum(found[f"R {node}"] for node in held) == pytest.approx(10.0 * len(model.nodes))
        for one, other in (("B0,0", "B3,3"), ("B1,0", "B2,3"), ("T2,1", "T1,2")):
            assert found[f"D {one}"] == pytest.approx(found[f"D {other}"], rel=1e-6)

    def test_warmth_strains_no_space_roof_on_corners(self) -> None:
        roof = space_truss_roof(
            "hall", (3, 2), "3 m", "2 m", chords="CHS 101.6x5", webs="CHS 76.1x4"
        )
        roof.context("air", "degC", (-20, 40)).temperature("air", 10)
        roof.sensors("force", "webs").sensor("DX", "displacement", node="T3,2", direction="x")
        found = answers(roof, air=30.0)
        assert found.pop("DX") == pytest.approx(1e3 * 1.2e-5 * 20 * 9)
        assert max(map(abs, found.values())) < 1e-6

    @pytest.mark.parametrize(("legs", "a_bay"), [(3, 9), (4, 13)])
    @pytest.mark.parametrize("joints", ["pinned", "rigid"])
    def test_a_mast_carries_its_load_through_its_legs(
        self, legs: int, a_bay: int, joints: str
    ) -> None:
        mast = lattice_mast(
            "mast", "30 m", 6, "3 m", top="1.2 m", legs="CHS 139.7x8", braces="CHS 60.3x4",
            number_of_legs=legs, joints=joints,
        )  # fmt: skip
        model = mast.build()
        assert len(model.members) == 6 * a_bay
        x, y = np.array([model.nodes[f"6{corner}"][:2] for corner in "ABCD"[:legs]]).T
        assert x.mean() == pytest.approx(0, abs=1e-9)
        assert y.mean() == pytest.approx(0, abs=1e-9)
        assert np.hypot(x[1] - x[0], y[1] - y[0]) == pytest.approx(1.2)
        top = [f"6{corner}" for corner in "ABCD"[:legs]]
        feet = [f"0{corner}" for corner in "ABCD"[:legs]]
        mast.load_case("antenna", down=dict.fromkeys(top, "5 kN"), forces={"6A": ("2 kN", 0, 0)})
        mast.sensors("reaction", feet, "X {place}", direction="x")
        mast.sensors("reaction", feet, "Z {place}", direction="up")
        found = answers(mast)
        assert sum(found[f"X {foot}"] for foot in feet) == pytest.approx(-2.0)
        assert sum(found[f"Z {foot}"] for foot in feet) == pytest.approx(5.0 * legs)

    def test_a_flat_portal_bends_as_handbooks_say(self) -> None:
        """M at the eaves of a frame on pins under q: q l^2 / (4 (2 k + 3)), k = Ib h / (Ic l)."""
        frame = portal_frame(
            "hall", "12 m", "5 m", columns="HEA 260", rafters="HEA 260", bases="pinned"
        )
        sections = frame.build().sections
        assert sections["column"].Iy == sections["rafter"].Iy
        stiff = {name: {**one.model_dump(), "A": 1e3} for name, one in sections.items()}
        rigid = ModelBuilder("hall", plane="xz").add_material("steel", steel())
        for name, keys in stiff.items():
            keys = {key: value for key, value in keys.items() if value}
            rigid.add_section(name, **keys)
        model = frame.build()
        for node, point in model.nodes.items():
            rigid.add_node(node, *point)
        for name, member in model.members.items():
            rigid.add_member(*member.nodes, member.section, name=name, kind="frame",
                             groups=member.groups)  # fmt: skip
        rigid.support("W0", "pinned").support("E0", "pinned")
        beams = [name for group in ("west rafter", "east rafter") for name in rigid.groups[group]]
        rigid.load_case("roof", uniform=dict.fromkeys(beams, (0, 0, "-10 kN/m")))
        found = answers(rigid.sensor("H", "reaction", node="W0", direction="x"))
        k = 5 / 12
        assert found["H"] == pytest.approx(10 * 12**2 / (4 * (2 * k + 3)) / 5, rel=1e-5)

    def test_a_portal_with_a_ridge_is_symmetric(self) -> None:
        frame = portal_frame(
            "hall", "20 m", "6 m", "2 m", columns="HEA 300", rafters="IPE 400",
            column_pieces=3, rafter_pieces=5,
        )  # fmt: skip
        model = frame.build()
        assert len(model.members) == 2 * 3 + 2 * 5
        assert model.nodes["R5"] == (10.0, 0.0, 8.0)
        found = weighed(frame)
        assert found["D R2"] == pytest.approx(found["D R8"])
        assert found["N W0-W1"] == pytest.approx(found["N E0-E1"])
        assert found["N W0-W1"] == pytest.approx(-5.0 * (len(model.nodes) - 2))

    def test_columns_of_a_storey_frame_carry_what_is_above_them(self) -> None:
        frame = storey_frame("office", 2, "6 m", 3, "3.5 m", columns="HEB 240", beams="IPE 330")
        model = frame.build()
        assert len(model.groups["beams"]) == 6
        assert model.groups["storey 1"] == ["A0-A1", "B0-B1", "C0-C1"]
        found = weighed(frame)
        assert sum(found[f"N {axis}0-{axis}1"] for axis in "ABC") == pytest.approx(-10.0 * 9)
        assert found["D A3"] == pytest.approx(found["D C3"])

    def test_every_one_warms_by_its_first_groups(self) -> None:
        for structure in (
            storey_frame("f", 2, 6, 3, 3.5, columns="HEB 240", beams="IPE 330"),
            lattice_mast("m", 30, 6, 3, legs="CHS 139.7x8", braces="CHS 60.3x4"),
            portal_frame("p", 20, 6, 2, columns="HEA 300", rafters="IPE 400"),
        ):
            structure.context("air", "degC", (-20, 40)).temperature("air")
            groups = structure.build().effects["warmth"].groups
            assert sum(len(structure.groups[one]) for one in groups) == len(
                structure.build().members
            )


@pytest.mark.parametrize("case", TRUSSES)
def test_a_ready_made_structure_says_whom_it_is_for(case: str) -> None:
    generator, panels, keys, _ = TRUSSES[case]
    bare = generator("roof", "20 m", "3 m", panels, **BARS, **keys)
    assert bare.build().about.client == ""
    model = bare.about(client="Roads office", structure="Roof 3").build()
    assert (model.about.client, model.about.structure) == ("Roads office", "Roof 3")
    wrong: Any = 3
    with pytest.raises(InputError, match="client"):
        bare.about(client=wrong)


class TestRefusedStructures:
    @pytest.mark.parametrize(
        ("build", "what"),
        [
            (lambda: howe_truss("t", "0 m", 2, 6, **BARS), "is no size (span of truss 't')"),
            (lambda: howe_truss("t", "20 kN", 2, 6, **BARS), "is of another dimension"),
            (lambda: howe_truss("t", 20, 2, 1, **BARS), "1 is no number of panels"),
            (lambda: howe_truss("t", 20, 2, 6.5, **BARS), "6.5 is no number of panels"),
            (lambda: howe_truss("t", 20, 2, 10**9, **BARS), "a whole number from 2 to 1000"),
            (lambda: howe_truss("t", 20, 2, 7, **BARS, shape="gable"), "7 panels have no node in"),
            (lambda: howe_truss("t", 20, 2, 6, **BARS, shape="arch"), "use 'parallel' or 'gable'"),
            (lambda: pratt_truss("t", 20, 2, 6, **BARS, ends="open"), "ends: 'open' is unknown"),
            (lambda: pratt_truss("t", 20, 2, 6, **BARS, shape="gable", ends="vertical"), "gable"),
            (lambda: pratt_truss("t", 20, 2, 6, **BARS, joints="glued"), "'glued' is unknown"),
            (
                lambda: warren_truss("t", 20, 2, 5, **BARS, with_verticals=True),
                "no node in the middle",
            ),
            (lambda: k_truss("t", 20, 2, 2, **BARS), "a whole number from 4"),
            (
                lambda: howe_truss("t", 20, 2, 6, chords="IPE 201", diagonals="IPE 80"),
                "did you mean IPE 200",
            ),
            (
                lambda: howe_truss("t", 20, 2, 6, **BARS, material="S1"),
                "the grade 'S1' is unknown",
            ),
            (
                lambda: space_truss_roof("r", 4, 3, 2, chords="CHS 101.6x5", webs="CHS 76.1x4"),
                "4 are no cells",
            ),
            (
                lambda: space_truss_roof(
                    "r", (4, 1), 3, 2, chords="CHS 101.6x5", webs="CHS 76.1x4"
                ),
                "1 is no number of cells",
            ),
            (
                lambda: lattice_mast(
                    "m", 30, 6, 3, legs="CHS 139.7x8", braces="CHS 60.3x4", number_of_legs=5
                ),
                "5 legs make no mast",
            ),
            (
                lambda: portal_frame("p", 20, 6, -2, columns="HEA 300", rafters="IPE 400"),
                "a rise of -2 m falls",
            ),
            (
                lambda: portal_frame(
                    "p", 20, 6, columns="HEA 300", rafters="IPE 400", bases="loose"
                ),
                "bases: 'loose' is unknown",
            ),
            (
                lambda: storey_frame("f", 0, 6, 3, 3, columns="HEB 240", beams="IPE 330"),
                "0 is no number of bays",
            ),
        ],
    )
    def test_what_is_no_structure_is_refused(self, build: Generator, what: str) -> None:
        with pytest.raises(InputError) as error:
            build()
        assert what in str(error.value)
