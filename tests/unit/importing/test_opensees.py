"""OpenSees scripts give the model that they describe."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import ImportRefused, import_model
from rga.model import Model

Written = Callable[[str, str], Path]
KIP, INCH = 4448.2216152605, 0.0254
FRAME = """
wipe
model BasicBuilder -ndm 2 -ndf 3; # a portal with a hinge and a stay
set ft 12.0
set H [expr 12*$ft]
set W [expr {20*$ft}]
node 1 0 0; node 2 0 $H -mass 0.5 0.5 0.
node 3 $W $H
node 4 $W 0
fix 1 1 1 1
fix 4 1 1 0
fix 3 0 0 0
geomTransf Linear 1
set E 29000.
foreach {tag i j A I} {1 1 2 20. 800.  2 2 3 16. 600.  3 4 3 20. 800.} {
    element elasticBeamColumn $tag $i $j $A $E $I 1 -mass 0.001
}
uniaxialMaterial Elastic 7 $E
element truss 4 1 3 1.5 7
timeSeries Linear 1 -factor 2.0
pattern Plain 1 1 {
    load 2 10. 0. 0.
}
pattern Plain 2 Linear {
    eleLoad -ele 2 -type -beamUniform -0.1 0.02
    eleLoad -ele 2 -type -beamPoint -4. 0.25
}
recorder Node -file out.txt -node 2 -dof 1 disp
set ok [analyze 1]
if {$ok != 0} { puts "failed" }
"""


def portal() -> dict[str, Any]:
    """The same portal for the solver of the tests, in kip and inch."""
    beam = {"type": "beam", "E": 29000, "A": 20, "Iz": 800}
    return {
        "dim": 2,
        "nodes": {"1": [0, 0], "2": [0, 144], "3": [240, 144], "4": [240, 0]},
        "elements": [
            {"id": 1, "nodes": [1, 2], **beam},
            {"id": 2, "nodes": [2, 3], **beam, "A": 16, "Iz": 600},
            {"id": 3, "nodes": [4, 3], **beam},
            {"id": 4, "nodes": [1, 3], "type": "truss", "E": 29000, "A": 1.5},
        ],
        "supports": [{"node": 1, "dofs": ["ux", "uy", "rz"]}, {"node": 4, "dofs": ["ux", "uy"]}],
    }


def loads() -> dict[str, Any]:
    return {
        "nodal_loads": [{"node": 2, "fx": 20}],
        "element_loads": [
            {"element": 2, "kind": "uniform", "wx": 0.02, "wy": -0.1},
            {"element": 2, "kind": "point", "x": 60, "Py": -4},
        ],
    }


def same(model: Model, got: dict[str, list[float]], expected: dict[str, list[float]]) -> None:
    """Plane motions x, y and turns about z of the script are x, z and minus y of the model."""
    largest = max(abs(value) for motion in expected.values() for value in motion[:2])
    turned = max(abs(motion[5]) for motion in expected.values())
    for node, motion in expected.items():
        assert got[node][0] / INCH == pytest.approx(motion[0], abs=1e-9 * largest)
        assert got[node][2] / INCH == pytest.approx(motion[1], abs=1e-9 * largest)
        assert -got[node][4] == pytest.approx(motion[5], abs=1e-9 * turned)


class TestOpenSeesTcl:
    def test_a_frame_moves_as_an_independent_solver_says(
        self, written: Written, moves: Any, solved: Any
    ) -> None:
        found = import_model(written("frame.tcl", FRAME), units="kip, in")
        same(found.model, moves(found.model), solved(portal(), **loads()))

    def test_what_it_has_is_counted_and_summed(self, written: Written) -> None:
        found = import_model(written("frame.tcl", FRAME), units="kip, in")
        assert found.counts["supports"] == 2
        assert found.counts["masses"] == 1
        assert found.model.masses["2"].mass == pytest.approx(0.5 * KIP / INCH)
        assert found.load_sums["pattern 1"] == pytest.approx((20 * KIP, 0, 0))
        assert found.load_sums["pattern 2"] == pytest.approx((4.8 * KIP, 0, -28 * KIP))

    def test_everything_that_is_left_out_is_said_by_line(self, written: Written) -> None:
        notes = import_model(written("frame.tcl", FRAME), units="kip, in").notes
        said = "\n".join(map(str, notes))
        assert "the mass of elements: statics has no use for it (line 16)" in said
        assert "node 3: no support (line 12)" in said
        assert "needs: recorder, analyze" in said
        assert "(lines 28-29)" in said

    def test_units_are_asked_for(self, written: Written) -> None:
        with pytest.raises(ImportRefused, match="never states its units") as refused:
            import_model(written("frame.tcl", FRAME))
        assert refused.value.counts["members"] == 4

    def test_second_order_is_refused_by_line_and_can_be_accepted(self, written: Written) -> None:
        path = written("frame.tcl", FRAME.replace("geomTransf Linear", "geomTransf PDelta"))
        with pytest.raises(ImportRefused, match="line 13: geomTransf PDelta 1"):
            import_model(path, units="kip, in")
        notes = import_model(path, units="kip, in", accept=["linear"]).notes
        assert any("PDelta" in note.what and note.severity == "assumed" for note in notes)

    def test_a_material_that_is_not_linear_names_its_line_and_the_element(
        self, written: Written
    ) -> None:
        path = written("frame.tcl", FRAME.replace("Elastic 7 $E", "ElasticPP 7 $E 0.003"))
        with pytest.raises(ImportRefused, match=r"line 18: material 7 is ElasticPP.*element 4"):
            import_model(path, units="kip, in")

    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("element quad 9 1 2 3 4 1. PlaneStress 7", "element 9 is quad"),
            ("rigidDiaphragm 2 2 3", "rigidDiaphragm"),
            ("buildTower 3 4", "does not know the command 'buildTower 3 4'"),
            ("remove element 4", "changes while it is analysed"),
        ],
    )
    def test_what_would_make_another_model_is_refused(
        self, written: Written, line: str, said: str
    ) -> None:
        path = written("frame.tcl", FRAME + line)
        with pytest.raises(ImportRefused, match=f"line 31: .*{said}"):
            import_model(path, units="kip, in")
        notes = import_model(path, units="kip, in", accept=["partial"]).notes
        assert any(said in note.what and note.severity == "dropped" for note in notes)

    def test_a_model_behind_the_first_is_said_and_not_read(self, written: Written) -> None:
        second = (
            "\nwipe\nmodel Basic -ndm 2 -ndf 2\nuniaxialMaterial ElasticPP 1 3. .003\nnode 9 x 0"
        )
        notes = import_model(written("two.tcl", FRAME + second), units="kip, in").notes
        said = "\n".join(map(str, notes))
        assert "another model follows, which is not read (line 33)" in said
        assert "ElasticPP 1 is not linear (line 34)" in said
        assert "the rest of the script: node: its coordinate x is 'x', no number (line 35)" in said

    @pytest.mark.parametrize(
        ("before", "after", "said"),
        [
            ("node 1 0 0", "node 1 0 [nodeDisp 3 1]", "it is the result of nodeDisp"),
            ("node 1 0 0", "node 1 0 $height", r"it is \$height, which is not set"),
            ("fix 4 1 1 0", "fix 4 1 1", "2 marks for 3"),
            ("fix 4 1 1 0", "fix 44 1 1 0", "there is no node 44"),
            ("$I 1 -mass", "$I -mass", "2 numbers|3 numbers"),
        ],
    )
    def test_a_slip_is_one_error(
        self, written: Written, before: str, after: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(written("frame.tcl", FRAME.replace(before, after)), units="kip, in")


class TestOpenSeesElements:
    def test_ties_springs_releases_and_settlements(
        self, written: Written, moves: Any, solved: Any
    ) -> None:
        path = written(
            "parts.py",
            """
import openseespy.opensees as ops
ops.model("basic", "-ndm", 2, "-ndf", 3)
for tag, x in enumerate([0.0, 4.0, 4.0, 8.0, 12.0], start=1):
    ops.node(tag, x, 0.0)
ops.fix(1, 1, 1, 1)
ops.fix(5, 1, 1, 0)
ops.geomTransf("Linear", 1)
ops.section("Elastic", 3, 2e8, 0.02, 1e-4)
ops.beamIntegration("Lobatto", 1, 3, 5)
ops.element("elasticBeamColumn", 1, 1, 2, 3, 1)
ops.element("forceBeamColumn", 2, 3, 4, 1, 1)
ops.element("elasticBeamColumn", 3, 4, 5, 0.02, 2e8, 1e-4, 1, "-release", 1)
ops.uniaxialMaterial("Elastic", 1, 3000.0)
ops.element("zeroLength", 4, 2, 3, "-mat", 1, "-dir", 6)
ops.equalDOF(2, 3, 1, 2)
ops.uniaxialMaterial("Elastic", 2, 500.0)
ops.node(6, 8.0, 0.0)
ops.fix(6, 1, 1, 1)
ops.element("zeroLength", 5, 4, 6, "-mat", 2, "-dir", 2)
ops.timeSeries("Constant", 1)
ops.pattern("Plain", 1, 1)
ops.load(2, 0.0, -10.0, 0.0)
ops.sp(5, 2, -0.01)
""",
        )
        found = import_model(path, units="kN, m")
        beam = {"type": "beam", "E": 2e8, "A": 0.02, "Iz": 1e-4}
        case = {
            "dim": 2,
            "nodes": {
                "1": [0, 0], "2": [4, 0], "3": [4, 0], "4": [8, 0], "4b": [8, 0], "5": [12, 0],
            },
            "elements": [
                {"id": 1, "nodes": [1, 2], **beam},
                {"id": 2, "nodes": [3, 4], **beam},
                {"id": 3, "nodes": ["4b", 5], **beam},
            ],
            "springs": [
                {"nodes": [2, 3], "dof": "rz", "k": 3000},
                {"node": 4, "dof": "uy", "k": 500},
            ],
            "ties": [
                {"nodes": [2, 3], "dofs": ["ux", "uy"]}, {"nodes": [4, "4b"], "dofs": ["ux", "uy"]},
            ],
            "supports": [
                {"node": 1, "dofs": ["ux", "uy", "rz"]}, {"node": 5, "dofs": ["ux", "uy"]},
            ],
        }  # fmt: skip
        expected = solved(
            case,
            nodal_loads=[{"node": 2, "fy": -10}],
            prescribed=[{"node": 5, "dof": "uy", "value": -0.01}],
        )
        got = moves(found.model)
        for node in "2345":
            assert got[node][2] == pytest.approx(expected[node][1], rel=1e-9)
            assert -got[node][4] == pytest.approx(expected[node][5], rel=1e-9)

    def test_members_in_space_keep_their_local_axes(
        self, written: Written, moves: Any, solved: Any
    ) -> None:
        path = written(
            "space.py",
            """
from openseespy.opensees import *
model("basic", "-ndm", 3, "-ndf", 6)
node(1, 0.0, 0.0, 0.0)
node(2, 3.0, 1.0, 2.0)
fix(1, 1, 1, 1, 1, 1, 1)
geomTransf("Linear", 1, 0.2, 0.1, 1.0)
E, G = 2e8, 8e7
element("ElasticTimoshenkoBeam", 1, 1, 2, E, G, 0.02, 3e-5, 1e-4, 2e-4, 0.01, 0.008, 1)
timeSeries("Linear", 1)
pattern("Plain", 1, 1)
load(2, 1.0, 2.0, -3.0, 0.5, 0.0, 0.1)
eleLoad("-ele", 1, "-type", "-beamUniform", -2.0, 1.5, 0.3)
""",
        )
        found = import_model(path, units="kN, m")
        vector, along = (0.2, 0.1, 1.0), (3.0, 1.0, 2.0)
        across = [
            vector[1] * along[2] - vector[2] * along[1],
            vector[2] * along[0] - vector[0] * along[2],
            vector[0] * along[1] - vector[1] * along[0],
        ]
        element = {
            "id": 1, "type": "beam", "nodes": [1, 2], "E": 2e8, "G": 8e7, "A": 0.02, "J": 3e-5,
            "Iy": 1e-4, "Iz": 2e-4, "Asy": 0.01, "Asz": 0.008, "local_y": across,
        }  # fmt: skip
        expected = solved(
            {
                "dim": 3,
                "nodes": {"1": [0, 0, 0], "2": [3, 1, 2]},
                "elements": [element],
                "supports": [{"node": 1, "dofs": ["ux", "uy", "uz", "rx", "ry", "rz"]}],
            },
            nodal_loads=[{"node": 2, "fx": 1, "fy": 2, "fz": -3, "mx": 0.5, "mz": 0.1}],
            element_loads=[{"element": 1, "kind": "uniform", "wx": 0.3, "wy": -2, "wz": 1.5}],
        )
        assert moves(found.model)["2"] == pytest.approx(expected["2"], rel=1e-9)


class TestOpenSeesPython:
    def test_a_function_that_nothing_calls_is_read_and_said(
        self, written: Written, moves: Any, solved: Any
    ) -> None:
        path = written(
            "frame.py",
            """
import opensees.openseespy as ops
import numpy as np
from math import sqrt

def add(model, tag, ends, A, I):
    model.element("elasticBeamColumn", tag, ends, A, E, I, 1)

E = 29e3
def test_frame():
    ft = 12.0
    model = ops.Model(ndm=2, ndf=3)
    places = {1: (0.0, 0.0), 2: (0.0, 12 * ft), 3: (20 * ft, 12 * ft), 4: (20 * ft, 0.0)}
    for tag, place in places.items():
        model.node(tag, place)
    model.fix(1, 1, 1, 1)
    model.fix(4, (1, 1, 0))
    model.geomTransf("Linear", 1)
    for tag, ends, A, I in zip([1, 2, 3], [(1, 2), (2, 3), (4, 3)], [20.0, 16.0, 20.0],
                               [800.0, 600.0, 800.0]):
        add(model, tag, ends, A, I)
    model.uniaxialMaterial("Elastic", 7, E)
    model.element("Truss", 4, (1, 3), 1.5, 7)
    model.pattern("Plain", 1, "Linear", load={2: [2 * sqrt(100.0), 0.0, 0.0]})
    model.eleLoad("-ele", 2, "-type", "-beamUniform", -np.array([0.1])[0], 0.02)
    model.eleLoad("-ele", 2, "-type", "beamPoint", -4.0, 0.25)
    model.analyze(1)
    moved = model.nodeDisp(2)
    while moved[0] < 3:
        moved = model.nodeDisp(2)
    assert abs(moved[0]) < 1
""",
        )
        found = import_model(path, units="kip, in")
        same(found.model, moves(found.model), solved(portal(), **loads()))
        said = "\n".join(map(str, found.notes))
        assert "function test_frame, which nothing calls, was taken as called (line 10)" in said

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("while True: pass", "steps"),
            ("def f(): f()\nf()", "too often"),
            ("a = [0]\nwhile True: a = a + a", "beyond bounds"),
            ("a = 'x' * 10**12", "too long"),
            ("a = 10 ** 10 ** 10", "too large"),
            ("import numpy as np\na = np.zeros(10**9)", "too large"),
            ("x = 1 +", "no Python"),
            ("x = (" * 500, "no Python"),
            ("x = 1 / 0", "division by zero"),
            ("raise ValueError('no')", "error of its own"),
            ("import os\nos.remove('x')", "defines no element"),
        ],
    )
    def test_a_script_that_builds_nothing_is_one_error(
        self, written: Written, text: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(written("script.py", text), units="kN, m")

    def test_nothing_is_run(self, written: Written) -> None:
        path = written(
            "hostile.py",
            "import os, openseespy.opensees as ops\n"
            "open('made', 'w').write('x')\n"
            "os.system('touch made')\n"
            "().__class__.__base__.__subclasses__()\n"
            "ops.model('basic', '-ndm', 2, '-ndf', 2)\n"
            "ops.node(1, 0, os.getpid())\n",
        )
        with pytest.raises(InputError, match="cannot be evaluated"):
            import_model(path, units="kN, m")
        assert [one.name for one in path.parent.iterdir()] == ["hostile.py"]
