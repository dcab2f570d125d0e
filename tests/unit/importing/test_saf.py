"""SAF workbooks give their 1D part, and say what is not in it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.building import rolled_section
from rga.errors import InputError
from rga.importing import ImportRefused, import_model
from unit.importing.saf_frame import Sheets, frame

openpyxl = pytest.importorskip("openpyxl")
SHARED = Path(__file__).parents[4] / "shared" / "imports" / "models"
HOUSE = SHARED / "saf_example_house_metric_zyx_200.xlsx"


@pytest.fixture
def book(tmp_path: Path) -> Callable[[Sheets], Path]:
    """Writes a workbook."""

    def write(sheets: Sheets) -> Path:
        made = openpyxl.Workbook()
        made.remove(made.active)
        for name, rows in sheets.items():
            sheet = made.create_sheet(name)
            for row in rows:
                sheet.append(row)
        path = tmp_path / "book.xlsx"
        made.save(path)
        return path

    return write


class TestSafWorkbook:
    def test_it_moves_as_an_independent_solver_says(
        self, book: Callable[[Sheets], Path], moves: Any, solved: Any
    ) -> None:
        sheets = frame()
        del sheets["StructuralLoadCase"][2]
        found = import_model(book(sheets))
        half, turn = 3**0.5 / 2, 0.5
        steel = {"type": "beam", "E": 210e9, "G": 80e9}
        rod = {**steel, "A": 0.004, "Iy": 2e-5, "Iz": 1e-5, "J": 3e-5, "local_y": [0, 1, 0]}
        section = found.model.sections["R"]
        # A node of its own behind the hinge, tied to the column by all but what it lets go.
        case = {
            "dim": 3,
            "nodes": {
                "A": [0, 0, 0], "B": [0, 0, 3], "b": [0, 0, 3], "D": [1, 0, 3], "C": [4, 0, 3],
            },
            "elements": [
                {"id": "col", "nodes": ["A", "B"], **steel, "A": 0.06, "J": section.J,
                 "Iy": 0.2 * 0.3**3 / 12, "Iz": 0.3 * 0.2**3 / 12, "local_y": [-turn, half, 0]},
                {"id": "b1", "nodes": ["b", "D"], **rod},
                {"id": "b2", "nodes": ["D", "C"], **rod},
            ],
            "ties": [{"nodes": ["B", "b"], "dofs": ["ux", "uy", "uz", "rx"]}],
            "springs": [
                {"nodes": ["B", "b"], "dof": "rz", "k": 5e6}, {"node": "C", "dof": "uz", "k": 2e6},
            ],
            "supports": [
                {"node": "A", "dofs": ["ux", "uy", "uz", "rx", "ry", "rz"]},
                {"node": "C", "dofs": ["uy", "rx"]},
            ],
        }  # fmt: skip
        expected = solved(
            case,
            nodal_loads=[{"node": "B", "fx": 5e3}, {"node": "C", "my": 2e3}],
            element_loads=[
                {"element": "b2", "kind": "point", "x": 2, "Pz": -3e3},
                {"element": "b1", "kind": "trapezoid", "axis": "z", "x1": 0.5, "x2": 1,
                 "w1": -2e3, "w2": -2e3 - 2e3 / 6},
                {"element": "b2", "kind": "trapezoid", "axis": "z", "x1": 0, "x2": 2.5,
                 "w1": -2e3 - 2e3 / 6, "w2": -4e3},
                {"element": "col", "kind": "uniform", "w_global": [0, 1e3, 0]},
            ],
        )  # fmt: skip
        got = moves(found.model)
        for node in "ABCD":
            assert got[node] == pytest.approx(expected[node], rel=1e-8, abs=1e-12)

    def test_self_weight_is_that_of_the_members(self, book: Callable[[Sheets], Path]) -> None:
        found = import_model(book(frame()))
        weight = 7850 * 9.81 * (0.06 * 3 + 0.004 * 4)
        assert found.load_sums["G"] == pytest.approx((0, 0, -weight), abs=1e-9 * weight)

    def test_members_are_cut_at_their_internal_nodes(self, book: Callable[[Sheets], Path]) -> None:
        found = import_model(book(frame()))
        assert set(found.model.members) == {"col", "beam 1", "beam 2"}
        assert any("beam is 2 members" in note.what for note in found.notes)

    def test_imperial_workbooks_and_columns_without_units(
        self, book: Callable[[Sheets], Path]
    ) -> None:
        sheets = frame()
        sheets["Model"][1][1] = "Imperial"
        del sheets["StructuralCurveAction"][1]
        sheets["StructuralPointConnection"][0] = [
            "Name", "Coordinate X", "Coordinate Y", "Coordinate Z",
        ]  # fmt: skip
        model = import_model(book(sheets)).model
        assert model.nodes["C"] == pytest.approx((4 * 0.3048, 0, 3 * 0.3048))

    @pytest.mark.parametrize(
        ("sheet", "column", "value", "said"),
        [
            ("StructuralCurveMember", "Behaviour in analysis", "Press only", "none|not one of"),
            ("StructuralCurveMember", "LCS", "weird", "'weird' is not one of y by vector"),
            ("StructuralPointSupport", "ux", None, "ux is not given"),
            ("StructuralPointAction", "Coordinate system", "Member LCS", "not one of global"),
            ("StructuralCurveAction", "Coordinate system", "Member LCS", "not one of global"),
            ("StructuralCurveAction", "Extent", "Half", "'half' is not one of full, span"),
            ("StructuralCurveAction", "Extent", "Full", "its points are not those of the whole"),
            ("StructuralCurveAction", "Distribution", "Cubic", "not one of uniform, trapez"),
            ("StructuralCurveAction", "Location", "Plan", "not one of length, projection"),
            ("StructuralCurveAction", "Origin", "Middle", "not one of from start, from end"),
            ("StructuralCurveAction", "Coordinate definition", "Share", "not one of absolute"),
            ("StructuralCurveAction", "End point [m]", 4.5, "at 0.5 m to 4.5 m on member beam"),
            ("StructuralCurveAction", "Start point [m]", 3.8, "runs backwards"),
            ("RelConnectsStructuralMember", "Position", "Middle", "not one of both, begin, end"),
        ],
    )
    def test_a_word_or_place_that_is_not_known_is_refused_by_its_cell(
        self, book: Callable[[Sheets], Path], sheet: str, column: str, value: Any, said: str
    ) -> None:
        sheets = frame()
        sheets[sheet][1][sheets[sheet][0].index(column)] = value
        with pytest.raises(ImportRefused, match=f"{sheet}, row 2.*{said}"):
            import_model(book(sheets))

    def test_a_rotation_has_the_unit_of_its_head(self, book: Callable[[Sheets], Path]) -> None:
        degrees = import_model(book(frame())).model.members["col"].local_y
        sheets = frame()
        place = sheets["StructuralCurveMember"][0].index("LCS Rotation [deg]")
        sheets["StructuralCurveMember"][0][place] = "LCS Rotation [rad]"
        sheets["StructuralCurveMember"][1][place] = 0.5235987755982988
        radians = import_model(book(sheets)).model.members["col"].local_y
        assert degrees is not None
        assert radians == pytest.approx(degrees, abs=1e-15)

    def test_columns_and_sheets_that_are_not_read_are_said(
        self, book: Callable[[Sheets], Path]
    ) -> None:
        sheets = frame()
        sheets["StructuralCurveMember"][0].append("Coating")
        sheets["StructuralCurveMember"][1].append("zinc")
        sheets["StructuralPointSupport"][0].append("Empty")
        sheets["structuralpointsupport"] = sheets.pop("StructuralPointSupport")
        found = import_model(book(sheets))
        assert found.counts["supports"] == 2
        said = [str(note) for note in found.notes if "columns that are not read" in note.what]
        assert said == ["dropped: columns that are not read: coating (sheet StructuralCurveMember)"]
        sheets["StructuralNovelty"] = [["Name"], ["x"]]
        with pytest.raises(ImportRefused, match="rows of a sheet that is not known: x"):
            import_model(book(sheets))

    @pytest.mark.parametrize(
        ("sheet", "column", "value", "said"),
        [
            ("StructuralMaterial", 3, 1_000_000, "E of 1000 GPa for steel"),
            ("StructuralMaterial", 5, 4, "Poisson's ratio of 4"),
            ("StructuralMaterial", 6, 5, "thermal expansion of 5 1/K"),
            ("StructuralMaterial", 1, "Timber", "E of 210 GPa for timber"),
        ],
    )
    def test_values_that_cannot_be_meant_are_named(
        self, book: Callable[[Sheets], Path], sheet: str, column: int, value: Any, said: str
    ) -> None:
        sheets = frame()
        sheets[sheet][1][column] = value
        with pytest.raises(ImportRefused, match=f"row 2 \\(S\\): {said}"):
            import_model(book(sheets))
        found = import_model(book(sheets), materials=["S: E=200GPa, nu=0.25"])
        assert found.model.materials["S"].E == 200e9

    def test_a_section_without_properties_can_be_given(
        self, book: Callable[[Sheets], Path]
    ) -> None:
        sheets = frame()
        sheets["StructuralCrossSection"][2] = ["P", "S", "Manufactured", None, None]
        with pytest.raises(ImportRefused, match='--section "P: A='):
            import_model(book(sheets))
        given = "P: A=40cm2, Iy=2000cm4, Iz=1000cm4, J=3000cm4"
        assert import_model(book(sheets), sections=[given]).model.sections["P"].A == 0.004

    @pytest.mark.parametrize("profile", ["IPE200", "HE 200 A"])
    def test_a_rolled_profile_has_the_properties_of_its_standard(
        self, book: Callable[[Sheets], Path], profile: str
    ) -> None:
        sheets = frame()
        sheets["StructuralCrossSection"][0].append("Profile")
        sheets["StructuralCrossSection"][2] = [
            "P", "S", "Manufactured", None, None, None, None, None, None, profile,
        ]  # fmt: skip
        found = import_model(book(sheets))
        expected = rolled_section(profile)
        section = found.model.sections["P"]
        assert (section.A, section.Iy, section.J) == (expected.A, expected.Iy, expected.J)
        assert any(f"{profile} are those of the standard" in note.what for note in found.notes)

    def test_an_arc_or_a_plate_is_refused_unless_parts_may_be_left_out(
        self, book: Callable[[Sheets], Path]
    ) -> None:
        sheets = frame()
        sheets["StructuralCurveMember"].append(["arc", "R", "A;B;C", "Circular Arc"])
        sheets["StructuralSurfaceMember"] = [["Name"], ["S1"], ["S2"]]
        with pytest.raises(ImportRefused, match=r"\(arc\).*2 2D members: S1, S2|2D members.*arc"):
            import_model(book(sheets))
        found = import_model(book(sheets), accept=["partial"])
        assert set(found.model.members) == {"col", "beam 1", "beam 2"}

    def test_a_cell_that_is_no_number_is_named(self, book: Callable[[Sheets], Path]) -> None:
        sheets = frame()
        sheets["StructuralPointConnection"][3][1] = "4,0 m"
        with pytest.raises(InputError, match=r"StructuralPointConnection, row 4 \(C\)"):
            import_model(book(sheets))


@pytest.mark.skipif(not HOUSE.exists(), reason="shared/imports is not beside the repository")
class TestSafHouse:
    def test_its_nonsense_is_caught(self) -> None:
        with pytest.raises(ImportRefused, match="Poisson's ratio of 4") as refused:
            import_model(HOUSE)
        assert refused.value.counts["nodes"] == 123

    def test_with_materials_given_its_1d_part_is_read_and_the_rest_said(self) -> None:
        ipe = "A=23.9cm2, Iy=1317cm4, Iz=101cm4, J=4.8cm4"
        found = import_model(
            HOUSE,
            accept=["partial"],
            materials=["E=210GPa, nu=0.3"],
            sections=[ipe],
        )
        assert found.counts["members"] == 38
        assert found.counts["supports"] == 1
        assert found.model.nodes["N10"] == (2.5, 12.0, 7.2)
        said = "\n".join(map(str, found.notes))
        for words in ("11 2D members", "Circular Arc", "AD1", "ribs", "free point loads"):
            assert words in said
