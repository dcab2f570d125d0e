"""Plain tables, as CSV files or as one workbook, give the model that they list."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import import_model

TABLES = {
    "nodes": "name,x [m],z [m]\nA,0,0\nB,4,0\nC,4,3\n",
    "materials": "name,E [GPa],nu,density [kg/m3]\nsteel,210,0.3,7850\n",
    "sections": "name,A [cm2],Iy [cm4]\nbeam,40,3000\nrod,5,\n",
    "members": (
        "name,start,end,section,material,kind,group,released at end\n"
        "AB,A,B,beam,steel,frame,floor,ry\nAC,A,C,rod,steel,truss,stay,\nBC,B,C,beam,steel,,,\n"
    ),
    "supports": "node,ux,uz,ry\nA,fixed,fixed,\nB,,x,yes\n",
    "loads": (
        "case,node,member,fx [kN],fz [kN],wz [kN/m],pz [kN],at [m]\n"
        "wind,C,,5,,,,\ndead,,AB,,,-2,,\ndead,,AB,,,,-3,1.5\n"
    ),
}


@pytest.fixture
def folder(tmp_path: Path) -> Callable[..., Path]:
    """Writes tables into a folder, some of them otherwise."""

    def write(**others: str) -> Path:
        for name, text in {**TABLES, **others}.items():
            (tmp_path / f"{name}.csv").write_text(text, encoding="utf-8")
        return tmp_path

    return write


class TestTables:
    def test_they_move_as_an_independent_solver_says(
        self, folder: Callable[..., Path], moves: Any, solved: Any
    ) -> None:
        model = import_model(folder()).model
        beam = {"type": "beam", "E": 2.1e11, "A": 0.004, "Iz": 3e-5}
        expected = solved(
            {
                "dim": 2,
                "nodes": {"A": [0, 0], "b": [4, 0], "B": [4, 0], "C": [4, 3]},
                "elements": [
                    {"id": "AB", "nodes": ["A", "b"], **beam},
                    {"id": "AC", "nodes": ["A", "C"], "type": "truss", "E": 2.1e11, "A": 0.0005},
                    {"id": "BC", "nodes": ["B", "C"], **beam},
                ],
                "ties": [{"nodes": ["b", "B"], "dofs": ["ux", "uy"]}],
                "supports": [
                    {"node": "A", "dofs": ["ux", "uy"]},
                    {"node": "B", "dofs": ["uy", "rz"]},
                ],
            },
            nodal_loads=[{"node": "C", "fx": 5e3}],
            element_loads=[
                {"element": "AB", "kind": "uniform", "wy": -2e3},
                {"element": "AB", "kind": "point", "x": 1.5, "Py": -3e3},
            ],
        )
        got = moves(model)
        for node in "ABC":
            assert got[node][0] == pytest.approx(expected[node][0], rel=1e-9, abs=1e-15)
            assert got[node][2] == pytest.approx(expected[node][1], rel=1e-9, abs=1e-15)
            assert -got[node][4] == pytest.approx(expected[node][5], rel=1e-9, abs=1e-15)

    def test_a_workbook_gives_the_same(self, folder: Callable[..., Path]) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        for name, text in TABLES.items():
            sheet = book.create_sheet(name)
            for line in text.splitlines():
                sheet.append([cell or None for cell in line.split(",")])
        place = folder()
        book.save(place / "model.xlsx")
        first, second = import_model(place).model, import_model(place / "model.xlsx").model
        assert first.members == second.members
        assert first.sections == second.sections
        assert first.effects == second.effects

    def test_empty_cells_behind_a_row_and_zeros_are_no_fault(
        self, folder: Callable[..., Path]
    ) -> None:
        place = folder(
            nodes="name,x [m],z [m]\nA,0,0,,\nB,4,0,\nC,4,3\n",
            loads="node,member,fz [kN],pz [kN],at [m]\nC,,-5,0,\n,AB,,-2,4\n",
        )
        assert import_model(place).load_sums == {"loads": (0, 0, -7000)}

    def test_what_is_not_read_is_said(self, folder: Callable[..., Path]) -> None:
        place = folder(
            nodes="name,x [m],z [m],colour\nA,0,0,red\nB,4,0,\nC,4,3,\n", people="a\n1\n"
        )
        said = "\n".join(map(str, import_model(place).notes))
        assert "the column 'colour' (nodes.csv)" in said
        assert "a table that is not read (people.csv)" in said

    @pytest.mark.parametrize(
        ("table", "text", "said"),
        [
            ("nodes", "name,x,z [m]\nA,0,0\n", "'x' states no unit"),
            ("nodes", "name,x [kg],z [m]\nA,0,0\n", "'kg' is no unit that becomes m"),
            (
                "nodes",
                "name,x [9**9**9],z [m]\nA,0,0\n",
                r"'9\*\*9\*\*9' is no unit that becomes m",
            ),
            ("nodes", "name,x [m/0],z [m]\nA,0,0\n", "'m/0' is no unit that becomes m"),
            (
                "nodes",
                "name,x [m],z [m]\nA,0,none\n",
                r"'z' is 'none', no number \(nodes.csv, row 2 \(A\)\)",
            ),
            ("nodes", "name,x [m],z [m]\nA,0,0\nA,1,0\n", "node 'A' is there already"),
            ("members", "name,start,end,section,material\nAB,A,B,beam,oak\n", "no material 'oak'"),
            ("members", "name,start,end,section,material\nAB,A,Z,beam,steel\n", "names node 'Z'"),
            ("supports", "node,ux\nA,perhaps\n", "ux is 'perhaps'"),
            ("loads", "node,member,fx [kN]\n,,1\n", "on a node or on a member"),
            ("sections", "", "the file is empty"),
            ("nodes", "name,x [m],z [m]\nA,0,0\nB,3,5,2\n", "'2' stands under no head.*row 3"),
            ("nodes", "name,x [m],z [m]\nA,0,\n", r"'z' is empty \(nodes.csv, row 2 \(A\)\)"),
            ("nodes", "name,x [m],z [m]\nA,0\n", r"'z' is empty \(nodes.csv, row 2 \(A\)\)"),
            ("nodes", "name,x [m]\nA,0\n", "the columns y, z are missing"),
            ("sections", "name,A (cm2)\nbeam,40\n", "'a' is empty"),
            ("materials", "name,E [mPa]\nsteel,210000\n", "most likely millions.*write MPa"),
            ("loads", "node,fz [mN]\nC,5\n", "most likely millions.*write MN"),
            ("loads", "node,fz [kN],wz [kN/m]\nC,,-5\n", "'wz' is given, .* no load on a node"),
            ("loads", "member,fz [kN],wz [kN/m]\nAB,4,-5\n", "'fz' is given, .* on a member"),
            ("loads", "member,wz [kN/m],at [m]\nAB,4,1\n", "'at' is given without"),
            ("loads", "node,fzz [kN]\nC,4\n", "the load has no value"),
            ("loads", "member,pz [kN],at [m]\nAB,-20,9\n", "at 9 m on member AB, .* 4 m long"),
            ("loads", "member,pz [kN],at [m]\nAB,-20,-1\n", "at -1 m on member AB"),
            ("sections", "name,A [cm2]\nbeam,4\nrod,5\n", "'beam' has no Iy, Iz, J"),
        ],
    )
    def test_a_slip_is_named_by_its_cell(
        self, folder: Callable[..., Path], table: str, text: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(folder(**{table: text}))


class TestDecimalCommas:
    @pytest.mark.parametrize("sign", [";", "\t"])
    def test_they_are_read_where_semicolons_or_tabs_part_columns(
        self, folder: Callable[..., Path], sign: str
    ) -> None:
        nodes = "name,x [m],z [m]\nA,0'0,0\nB,4'25,0\nC,4,3\n".replace(",", sign).replace("'", ",")
        found = import_model(folder(nodes=nodes))
        assert found.model.nodes["B"] == (4.25, 0.0, 0.0)
        said = [note.what for note in found.notes]
        assert "commas in numbers are decimal: 0,0 is 0" in said

    def test_they_are_read_in_quotes(self, folder: Callable[..., Path]) -> None:
        nodes = 'name,x [m],z [m]\nA,0,0\nB,"4,125",0\nC,4,3\n'
        found = import_model(folder(nodes=nodes))
        assert found.model.nodes["B"] == (4.125, 0.0, 0.0)
        said = [note.what for note in found.notes]
        assert "commas in numbers are decimal: 4,125 is 4.125" in said

    @pytest.mark.parametrize("cell", ["1.234,5", "1,234.5", "1,5"])
    def test_points_and_commas_together_are_refused(
        self, folder: Callable[..., Path], cell: str
    ) -> None:
        nodes = f"name;x [m];z [m]\nA;0;0.5\nB;{cell};0\nC;4;3\n"
        with pytest.raises(InputError, match="points and commas in numbers"):
            import_model(folder(nodes=nodes))

    def test_no_comma_is_one_of_thousands(self, folder: Callable[..., Path]) -> None:
        nodes = "name;x [m];z [m]\nA;0;0\nB;1,234,567;0\nC;4;3\n"
        with pytest.raises(InputError, match="'x' is '1,234,567', no number"):
            import_model(folder(nodes=nodes))
