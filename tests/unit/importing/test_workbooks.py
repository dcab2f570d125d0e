"""Cells of a workbook count as what they show, or are one clear error."""

import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import import_model
from rga.importing.numerals import float_of

openpyxl = pytest.importorskip("openpyxl")
SHEETS: dict[str, list[list[Any]]] = {
    "nodes": [["name", "x [m]", "z [m]"], ["A", 0, 0], ["B", 3, 2], ["C", 6, 0]],
    "materials": [["name", "E [GPa]"], ["steel", 210]],
    "sections": [["name", "A [cm2]"], ["rod", 12]],
    "members": [
        ["name", "start", "end", "section", "material", "kind"],
        *([a + b, a, b, "rod", "steel", "truss"] for a, b in ("AB", "BC", "AC")),
    ],
    "supports": [["node", "ux", "uz"], ["A", "fixed", "fixed"], ["C", None, "fixed"]],
    "loads": [["case", "node", "fx [kN]", "fz [kN]"], ["s", "B", 10, -20], ["s", "C", None, -5]],
}
SUMS = {"s": (10000, 0, -25000)}
Book = Callable[..., Path]


@pytest.fixture
def book(tmp_path: Path) -> Book:
    """Writes a workbook that is changed, and then the text of one of its sheets."""

    def write(
        change: Callable[[Any], object] = lambda made: None,
        text: Callable[[str], str] = str,
        sheet: str = "loads",
    ) -> Path:
        made = openpyxl.Workbook()
        made.remove(made.active)
        for name, rows in SHEETS.items():
            for row in made.create_sheet(name) and rows:
                made[name].append(row)
        change(made)
        made.save(first := tmp_path / "first.xlsx")
        part = f"xl/worksheets/sheet{list(SHEETS).index(sheet) + 1}.xml"
        with zipfile.ZipFile(first) as old, zipfile.ZipFile(tmp_path / "book.xlsx", "w") as new:
            for name in old.namelist():
                data = old.read(name)
                new.writestr(name, text(data.decode()).encode() if name == part else data)
        return tmp_path / "book.xlsx"

    return write


def formula(cell: str, inside: str) -> Callable[[str], str]:
    """Puts a formula with what is stored of it into a cell of a sheet."""
    return lambda text: re.sub(rf'<c r="{cell}"[^>]*>.*?</c>', f'<c r="{cell}"{inside}</c>', text)


class TestFormulas:
    @pytest.mark.parametrize(
        ("sheet", "cell", "column"),
        [("loads", "C2", "'fx'"), ("supports", "B2", "'ux'"), ("nodes", "A3", "'name'"),
         ("nodes", "B1", "2")],
    )  # fmt: skip
    def test_one_without_a_value_is_an_error(
        self, book: Book, sheet: str, cell: str, column: str
    ) -> None:
        path = book(lambda made: made[sheet].__setitem__(cell, "=10*1"))
        with pytest.raises(InputError, match="formula without a value") as error:
            import_model(path)
        assert error.value.where == f"{sheet}, row {cell[1]}, column {column}"
        assert "save it" in error.value.remedy

    def test_a_zero_that_nobody_computed_is_no_value(self, book: Book) -> None:
        with pytest.raises(InputError, match="formula without a value"):
            import_model(book(text=formula("C2", "><f>5*2</f><v>0</v>")))

    def test_one_with_a_value_is_its_value(self, book: Book) -> None:
        path = book(text=formula("C2", "><f>5*2</f><v>10</v>"))
        assert import_model(path).load_sums == SUMS

    def test_an_empty_text_is_a_value(self, book: Book) -> None:
        path = book(text=formula("C2", ' t="str"><f>IF(1,"")</f><v></v>'))
        assert import_model(path).load_sums == {"s": (0, 0, -25000)}

    def test_one_in_a_column_that_is_not_read_is_no_fault(self, book: Book) -> None:
        def change(made: Any) -> None:
            made["loads"]["E1"], made["loads"]["E2"] = "share", "=C2/2"

        assert import_model(book(change)).load_sums == SUMS


class TestMergedCells:
    @pytest.mark.parametrize(
        ("sheet", "cells"),
        [("loads", "A2:A3"), ("supports", "B2:B3"), ("nodes", "A1:B1"), ("loads", "C3:D3")],
    )
    def test_those_of_a_table_are_an_error(self, book: Book, sheet: str, cells: str) -> None:
        with pytest.raises(InputError, match=f"cells {cells} are merged") as error:
            import_model(book(lambda made: made[sheet].merge_cells(cells)))
        assert error.value.where == sheet

    @pytest.mark.parametrize("cells", ["F1:H1", "A9:D9", "F2:G3", "A4:A900"])
    def test_those_beside_a_table_are_no_fault(self, book: Book, cells: str) -> None:
        path = book(lambda made: made["loads"].merge_cells(cells))
        assert import_model(path).load_sums == SUMS

    def test_those_of_a_sheet_that_is_not_read_are_no_fault(self, book: Book) -> None:
        def change(made: Any) -> None:
            notes = made.create_sheet("notes")
            for row in (["title", "who"], ["a", "b"], ["c", "d"]):
                notes.append(row)
            notes.merge_cells("A1:B1")
            notes.merge_cells("A2:A3")

        assert import_model(book(change)).load_sums == SUMS


class TestRows:
    @pytest.mark.parametrize(
        ("row", "said"),
        [("100000000", "no row 100000000"), ("2", "row 2 stands behind row 2")],
    )
    def test_a_row_in_no_place_is_an_error(self, book: Book, row: str, said: str) -> None:
        with pytest.raises(InputError, match=said):
            import_model(book(text=lambda text: text.replace('<row r="3"', f'<row r="{row}"')))

    def test_a_row_far_down_is_read(self, book: Book) -> None:
        path = book(text=lambda text: text.replace('<row r="3"', '<row r="1048576"'))
        assert import_model(path).load_sums == SUMS

    def test_too_many_are_an_error_before_they_are_read(
        self, book: Book, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        path = book()
        monkeypatch.setattr("rga.importing.spreadsheet.MOST_ROWS", 3)
        with pytest.raises(InputError, match="a sheet of more than"):
            import_model(path)

    def test_a_row_of_too_many_cells_is_an_error(self, book: Book) -> None:
        with pytest.raises(InputError, match="a sheet of more than"):
            import_model(book(text=lambda text: text.replace("</row>", "<c/>" * 17000 + "</row>")))


@pytest.mark.parametrize("text", ["3_0", "٣", "0x3", "nan", "1e999"])
def test_a_number_that_only_python_reads_is_none(book: Book, text: str) -> None:
    with pytest.raises(InputError, match="no number"):
        import_model(book(lambda made: made["nodes"].__setitem__("B3", text)))


@pytest.mark.parametrize("value", ["3_0", "٣", "", "a", None, 10**400])
def test_what_is_no_number(value: object) -> None:
    with pytest.raises(ValueError, match="no number"):
        float_of(value)


@pytest.mark.parametrize("text", ["3", " 3.0 ", "\xa03e0", "+3"])
def test_a_number_in_a_text_is_read(book: Book, text: str) -> None:
    path = book(lambda made: made["nodes"].__setitem__("B3", text))
    assert import_model(path).model.nodes["B"][0] == 3


def test_chart_sheets_are_passed_over(book: Book) -> None:
    path = book(lambda made: made.create_chartsheet("curve"))
    assert import_model(path).load_sums == SUMS
