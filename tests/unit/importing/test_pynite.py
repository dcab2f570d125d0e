"""PyNite models, as objects and as scripts, move as PyNite says."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.importing import ImportRefused, import_model

Written = Callable[[str, str], Path]
SCRIPT = """
from Pynite import FEModel3D
frame = FEModel3D()
for name, x, y in [("A", 0, 0), ("B", 0, 12*12), ("C", 15*12, 12*12), ("D", 15*12, 0*12)]:
    frame.add_node(name, x, y, 0)
frame.add_material("steel", 29000, 11200, 0.3, 0.490/12**3)
frame.add_section("post", 9.71, 36.6, 171, 0.58)
frame.add_member("AB", "A", "B", "steel", "post")
frame.add_member("DC", "D", "C", "steel", "post")
frame.add_member("BC", "B", "C", "steel", "post", rotation=20)
for node in "AD":
    frame.def_support(node, True, True, True, True, True, support_RZ=True)
frame.def_releases("BC", Rzj=True)
frame.add_member_dist_load("BC", "Fy", -0.1, -0.2, x1=10, x2=100, case="D")
frame.add_member_pt_load("AB", "FX", 2, 50, case="W")
frame.add_node_load("B", direction="FX", P=10, case="W")
frame.add_member_self_weight("FY", -1, case="D")
frame.add_load_combo("1.2D+W", factors={"D": 1.2, "W": 1.0})
frame.analyze_linear()
print(frame.nodes["B"].DX["1.2D+W"])
"""


def motions(model: Any, combination: str) -> dict[str, list[float]]:
    """Displacements and rotations of nodes as PyNite has them, in rga's axes."""
    found = {}
    for name, node in model.nodes.items():
        values = [getattr(node, key)[combination] for key in ("DX", "DY", "DZ", "RX", "RY", "RZ")]
        x, y, z, rx, ry, rz = (float(value) for value in values)
        found[name] = [x, -z, y, rx, -rz, ry]
    return found


class TestPyniteObject:
    def test_a_frame_in_space_moves_as_pynite_says(self, moves: Any) -> None:
        pynite = pytest.importorskip("Pynite")
        draw = np.random.default_rng(5)
        model = pynite.FEModel3D()
        points = draw.uniform(0, 6, (6, 3))
        for k, point in enumerate(points):
            model.add_node(f"N{k}", *map(float, point))
        model.add_node("base", 0.0, 0.0, 0.0)
        model.add_node("top", 0.0, 4.0, 0.0)
        model.add_node("mid", *map(float, (points[0] + points[1]) / 2))
        model.add_material("steel", 2.1e8, 8e7, 0.3, 77.0)
        model.add_section("tube", 0.01, 2e-4, 3e-4, 1e-4)
        ends = [
            "base top", "N0 N1", "N1 N2", "N2 N3", "N3 N4", "N4 N5", "N0 N4", "N1 N3", "top mid",
            "top N3",
        ]  # fmt: skip
        for k, pair in enumerate(ends):
            first, second = pair.split()
            model.add_member(f"m{k}", first, second, "steel", "tube", rotation=15.0 * (k % 3))
        model.def_releases("m3", Ryi=True, Rzj=True)
        model.def_support("base", True, True, True, True, True, True)
        model.def_support("N5", True, True, True)
        model.def_support_spring("N2", "DY", 2000.0)
        model.add_spring("spring", "N4", "N1", 500.0)
        model.add_node_load("N3", "FY", -20.0, "D")
        model.add_node_load("N4", "MX", 5.0, "D")
        model.add_member_dist_load("m1", "FY", -2.0, -5.0, case="D")
        model.add_member_dist_load("m2", "Fz", 1.0, 3.0, 0.3, 0.9, case="D")
        model.add_member_pt_load("m1", "Fy", 4.0, 1.0, case="D")
        model.add_member_self_weight("FY", -1.0, case="D")
        model.add_load_combo("C", {"D": 1.5})
        model.analyze_linear()
        found = import_model(model, units="kN, m", combination="C")
        got, expected = moves(found.model), motions(model, "C")
        largest = max(abs(value) for motion in expected.values() for value in motion)
        for node, motion in expected.items():
            assert got[node] == pytest.approx(motion, abs=1e-9 * largest)

    def test_another_object_is_one_error(self) -> None:
        with pytest.raises(InputError, match="nothing that can be read"):
            import_model(object())


class TestPyniteScript:
    def test_it_gives_what_the_object_gives(self, written: Written, moves: Any) -> None:
        pytest.importorskip("Pynite")
        path = written("frame.py", SCRIPT)
        space: dict[str, Any] = {}
        exec(SCRIPT, space)
        scripted = import_model(path, units="kip, in", combination="1.2D+W")
        made = import_model(space["frame"], units="kip, in", combination="1.2D+W")
        assert moves(scripted.model) == moves(made.model)
        expected = motions(space["frame"], "1.2D+W")["B"]
        got = moves(scripted.model)["B"]
        assert got[0] == pytest.approx(expected[0] * 0.0254, rel=1e-9)
        assert got[4] == pytest.approx(expected[4], rel=1e-9)

    def test_combinations_that_are_not_applied_are_said(self, written: Written) -> None:
        notes = import_model(written("frame.py", SCRIPT), units="kip, in").notes
        assert any("1.2D+W are not applied" in note.what for note in notes)

    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("frame.analyze_PDelta()", "line 22: .*second order"),
            (
                "frame.add_quad('q', 'A', 'B', 'C', 'D', 1, 'steel')",
                "line 22: quads are no members",
            ),
            ("frame.def_support_spring('C', 'DX', 5, '+')", "acts one way only"),
            ("frame.add_member_pt_load('BC', 'Mz', 2, 50)", "a moment Mz on member BC"),
        ],
    )
    def test_what_is_not_linear_or_no_member_is_refused(
        self, written: Written, line: str, said: str
    ) -> None:
        with pytest.raises(ImportRefused, match=said):
            import_model(written("frame.py", f"{SCRIPT}\n{line}\n"), units="kip, in")

    @pytest.mark.parametrize(
        ("before", "after", "said"),
        [
            ('"A", "B", "steel"', '"A", "Z", "steel"', "there is no 'Z' in nodes"),
            ("P=10", "P=frame.nodes['B'].DX['D']", "its P cannot be evaluated"),
            ('"FX", 2, 50', '"FX", 2', "its x is missing"),
        ],
    )
    def test_a_slip_is_one_error(
        self, written: Written, before: str, after: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(written("frame.py", SCRIPT.replace(before, after)), units="kip, in")
