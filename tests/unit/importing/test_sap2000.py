"""Text tables of SAP2000 give the frames that they describe."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import ImportRefused, import_model

Written = Callable[[str, str], Path]
SHARED = Path(__file__).parents[4] / "shared" / "imports" / "models"
LATTICE = SHARED / "sap2000_lattice_frame.s2k"
TABLES = """File made by hand

TABLE:  "PROGRAM CONTROL"
   ProgramName=SAP2000   Version=25.1.0   CurrUnits="KN, m, C"

TABLE:  "JOINT COORDINATES"
   Joint=1   CoordSys=GLOBAL   CoordType=Cartesian   XorR=0   Y=0   Z=0
   Joint=2   CoordSys=GLOBAL   CoordType=Cartesian   XorR=0   Y=0   Z=4
   Joint=3   CoordSys=GLOBAL   CoordType=Cartesian   XorR=3   Y=2   Z=5

TABLE:  "CONNECTIVITY - FRAME"
   Frame=1   JointI=1   JointJ=2   IsCurved=No
   Frame=2   JointI=2   JointJ=3   IsCurved=No

TABLE:  "FRAME SECTION ASSIGNMENTS"
   Frame=1   AutoSelect=N.A.   AnalSect="Post (200 CHS 8)"   MatProp=Default
   Frame=2   AutoSelect=N.A.   AnalSect="Post (200 CHS 8)"   MatProp=Default

TABLE:  "FRAME SECTION PROPERTIES 01 - GENERAL"
   SectionName="Post (200 CHS 8)"   Material=S355   Shape=Channel   Area=0.002   TorsConst=2E-05 _
        I33=1.2E-05   I22=4.7E-06   AS2=0.0012   AS3=0.0009

TABLE:  "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL"
   Frame=2   Angle=30   MirrorAbt2=No

TABLE:  "FRAME RELEASE ASSIGNMENTS 1 - GENERAL"
   Frame=2   PI=No   V2I=No   V3I=No   TI=No   M2I=Yes   M3I=No   M2J=No   M3J=No   PartialFix=No

TABLE:  "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"
   Material=S355   UnitWeight=77   UnitMass=7.85   E1=210000000   G12=80769230.7692308   U12=0.3   A1=1.2E-05

TABLE:  "JOINT RESTRAINT ASSIGNMENTS"
   Joint=1   U1=Yes   U2=Yes   U3=Yes   R1=Yes   R2=Yes   R3=Yes
   Joint=3   U1=No   U2=No   U3=Yes   R1=No   R2=No   R3=No

TABLE:  "LOAD PATTERN DEFINITIONS"
   LoadPat=DEAD   DesignType=Dead   SelfWtMult=1
   LoadPat=WIND   DesignType=Wind   SelfWtMult=0

TABLE:  "JOINT LOADS - FORCE"
   Joint=2   LoadPat=WIND   CoordSys=GLOBAL   F1=3   F2=-1   F3=0   M1=0   M2=0   M3=2

TABLE:  "FRAME LOADS - DISTRIBUTED"
   Frame=2   LoadPat=WIND   CoordSys=GLOBAL   Type=Force   Dir=Gravity   DistType=RelDist   RelDistA=0.25   RelDistB=1 _
        FOverLA=1   FOverLB=2
   Frame=1   LoadPat=WIND   CoordSys=Local   Type=Force   Dir=2   DistType=RelDist   RelDistA=0   RelDistB=1   FOverLA=1.5   FOverLB=1.5

TABLE:  "FRAME LOADS - POINT"
   Frame=2   LoadPat=WIND   CoordSys=GLOBAL   Type=Force   Dir=X   DistType=RelDist   RelDist=0.5   Force=2

TABLE:  "GRID LINES"
   CoordSys=GLOBAL   AxisDir=X   GridID=A

END TABLE DATA
"""  # noqa: E501


class TestSap2000Tables:
    def test_they_move_as_an_independent_solver_says(
        self, written: Written, moves: Any, solved: Any
    ) -> None:
        found = import_model(written("frame.s2k", TABLES))
        size = 14**0.5
        # Axis 2 is up across the frame, then turned by 30 degrees about it.
        up = [-3 / 14, -2 / 14, 1 - 1 / 14]
        length = sum(value**2 for value in up) ** 0.5
        second = [value / length for value in up]
        along = [3 / size, 2 / size, 1 / size]
        third = [
            along[1] * second[2] - along[2] * second[1],
            along[2] * second[0] - along[0] * second[2],
            along[0] * second[1] - along[1] * second[0],
        ]
        turned = [3**0.5 / 2 * a + 0.5 * b for a, b in zip(second, third, strict=True)]
        section = {
            "type": "beam", "E": 2.1e11, "G": 80769230769.2308, "A": 0.002, "J": 2e-5,
            "Iz": 1.2e-5, "Iy": 4.7e-6, "Asy": 0.0012, "Asz": 0.0009,
        }  # fmt: skip
        axes = found.model.members["2"].local_y
        assert axes == pytest.approx(turned, abs=1e-12)
        pushed = self.local([2e3, 0, 0], along, turned)
        weighed = self.local([0, 0, -1e3], along, turned)
        # The release about axis 2 by a node of its own, tied in all but that turn; as it is about
        # an axis of no coordinate, the member is held to the model's own answer by its end moment.
        frame = {"id": 1, "nodes": [1, 2], **section, "local_y": [1, 0, 0]}
        stay = {"id": 2, "nodes": [2, 3], **section, "local_y": turned}
        whole = TABLES.replace("M2I=Yes", "M2I=No")
        rigid = import_model(written("rigid.s2k", whole))
        expected = solved(
            {
                "dim": 3,
                "nodes": {"1": [0, 0, 0], "2": [0, 0, 4], "3": [3, 2, 5]},
                "elements": [frame, stay],
                "supports": [
                    {"node": 1, "dofs": ["ux", "uy", "uz", "rx", "ry", "rz"]},
                    {"node": 3, "dofs": ["uz"]},
                ],
            },
            nodal_loads=[{"node": 2, "fx": 3e3, "fy": -1e3, "mz": 2e3}],
            element_loads=[
                {"element": 1, "kind": "uniform", "wx": -77e3 * 0.002, "wy": 1.5e3},
                {"element": 2, "kind": "uniform", "w_global": [0, 0, -77e3 * 0.002]},
                {"element": 2, "kind": "point", "x": size / 2, "Px": pushed[0], "Py": pushed[1],
                 "Pz": pushed[2]},
                *(
                    {"element": 2, "kind": "trapezoid", "axis": axis, "x1": size / 4, "x2": size,
                     "w1": share, "w2": 2 * share}
                    for axis, share in zip("xyz", weighed, strict=True)
                ),
            ],
        )  # fmt: skip
        got = moves(rigid.model)
        for node in "123":
            assert got[node] == pytest.approx(expected[node], rel=1e-8, abs=1e-12)
        assert found.model.members["2"].releases.i == ["ry"]

    @staticmethod
    def local(vector: list[float], x: list[float], y: list[float]) -> list[float]:
        z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
        return [sum(a * b for a, b in zip(vector, axis, strict=True)) for axis in (x, y, z)]

    @pytest.mark.parametrize(
        ("inactive", "held"),
        [(["UY"], {"uy"}), (["RX", "RY", "RZ"], {"rx", "ry", "rz"}), (["UY", "RX", "RZ"], {"uy"})],
    )
    def test_what_is_not_active_is_held_everywhere(
        self, written: Written, moves: Any, inactive: list[str], held: set[str]
    ) -> None:
        fields = "   ".join(
            f"{name}={'No' if name in inactive else 'Yes'}"
            for name in ("UX", "UY", "UZ", "RX", "RY", "RZ")
        )
        table = f'TABLE:  "ACTIVE DEGREES OF FREEDOM"\n   {fields}\n\nEND TABLE DATA'
        found = import_model(written("frame.s2k", TABLES.replace("END TABLE DATA", table)))
        assert all(held <= set(found.model.supports[node].fixed) for node in "123")
        assert any("not active: every node is held" in note.what for note in found.notes)
        for place, dof in enumerate(("ux", "uy", "uz", "rx", "ry", "rz")):
            largest = max(abs(motion[place]) for motion in moves(found.model).values())
            assert (largest == 0) == (dof in {name.lower() for name in inactive})

    def test_a_structure_of_a_plane_becomes_a_plane_model(self, written: Written) -> None:
        table = (
            'TABLE:  "ACTIVE DEGREES OF FREEDOM"\n   UX=Yes   UY=No   UZ=Yes   RX=No   RY=Yes   '
            "RZ=No\n\nEND TABLE DATA"
        )
        flat = TABLES.replace("Y=2   Z=5", "Y=0   Z=5")
        assert import_model(written("frame.s2k", flat)).model.plane is None
        found = import_model(written("flat.s2k", flat.replace("END TABLE DATA", table)))
        assert found.model.plane == "xz"

    def test_a_shape_that_its_name_denies_is_noticed(self, written: Written) -> None:
        notes = import_model(written("frame.s2k", TABLES)).notes
        assert any("is a Channel, whatever its name" in note.what for note in notes)
        assert any("GRID LINES" in note.what and note.severity == "dropped" for note in notes)

    def test_joints_on_a_meshed_frame_cut_it(self, written: Written) -> None:
        more = TABLES.replace(
            "   Joint=3   CoordSys", "   Joint=4   XorR=0   Y=0   Z=3\n   Joint=3   CoordSys"
        ).replace(
            'TABLE:  "JOINT REST',
            'TABLE:  "FRAME AUTO MESH ASSIGNMENTS"\n   Frame=1   AutoMesh=Yes   AtJoints=Yes\n\n'
            'TABLE:  "JOINT REST',
        )
        found = import_model(written("frame.s2k", more))
        assert found.model.members["1 1"].nodes == ("1", "4")
        assert found.load_sums["DEAD"] == pytest.approx((0, 0, -154 * (4 + 14**0.5)), abs=1e-9)

    @pytest.mark.parametrize(
        ("table", "said"),
        [
            ('"CONNECTIVITY - AREA"\n   Area=1   NumJoints=3', "areas are no members"),
            ('"CONSTRAINT DEFINITIONS - BODY"\n   Name=D1', "constraints between joints"),
            ('"FRAME LOADS - TEMPERATURE"\n   Frame=1   Temp=20', "loads that are not read"),
            ('"FRAME PROPERTY MODIFIERS"\n   Frame=1   AMod=0.5', "modified properties"),
        ],
    )
    def test_tables_that_matter_are_refused_by_line(
        self, written: Written, table: str, said: str
    ) -> None:
        path = written("frame.s2k", TABLES.replace("END TABLE", f"TABLE:  {table}\n\nEND TABLE"))
        with pytest.raises(ImportRefused, match=f"line 55: .*{said}"):
            import_model(path)
        assert import_model(path, accept=["partial"]).counts["members"] == 2

    @pytest.mark.parametrize(
        ("before", "after", "said"),
        [
            ('CurrUnits="KN, m, C"', "", "does not state its units"),
            ("KN, m", "stone, m", "'stone' is no unit"),
            ("XorR=3", "XorR=three", r"XorR is 'three', no number \(.*line 9\)"),
            ("JointJ=3", "JointJ=9", "joint '9' is not there"),
            ("Area=0.002", "Area=0", "has no area"),
            ("END TABLE DATA\n", "   Joint=9 _", "ends within a row"),
            ("END TABLE DATA\n", "", "no line END TABLE DATA"),
            (
                'TABLE:  "FRAME LOC',
                '   SectionName="Post (200 CHS 8)"   Area=1\n\nTABLE:  "FRAME LOC',
                "SectionName .* stands twice .* first in line 20",
            ),
            ("I33=1.2E-05", "", "line 20: section .* has no I33, by which its frames bend"),
            ("I22=4.7E-06", "I22=0", "line 20: section .* has no I22"),
            ("RelDistA=0.25", "RelDistA=1.5", "line 44: .*which is 3.7"),
            ("RelDistA=0.25   RelDistB=1", "RelDistA=0.8   RelDistB=0.2", "line 44: .*backwards"),
            ("RelDist=0.5", "RelDist=1.5", "line 49: a load at 5.6"),
            ("U1=No   U2=No   U3=Yes", "U1=No   U2=N   U3=Yes", "U2 is 'n', neither"),
        ],
    )
    def test_a_slip_is_one_error(
        self, written: Written, before: str, after: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(written("frame.s2k", TABLES.replace(before, after)))


@pytest.mark.skipif(not LATTICE.exists(), reason="shared/imports is not beside the repository")
class TestSap2000Lattice:
    def test_it_is_read_with_its_weight_and_its_freedom_out_of_plane(self, moves: Any) -> None:
        found = import_model(LATTICE)
        assert found.counts["nodes"] == 28
        # Two of its 49 frames go through a joint.
        assert found.counts["members"] == 51
        assert (found.counts["frames"], found.counts["frames cut"]) == (49, 2)
        assert found.model.sections["Bottom Chord (355.6 CHS 8)"].A == 0.0021483828
        assert any("can turn about an axis along x" in note.what for note in found.notes)
        plane = import_model(LATTICE, plane="xz")
        reached = moves(plane.model)
        assert max(abs(motion[2]) for motion in reached.values()) > 0
