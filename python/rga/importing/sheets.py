"""Sheets of tables: columns whose heads state units in brackets, rows with names."""

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from rga.errors import InputError
from rga.importing.numerals import float_of
from rga.importing.units import to_si

HEAD = re.compile(r"^(?P<name>[^\[]*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*$", re.DOTALL)
#: rows of the longest sheet, and cells of the longest row
MOST_ROWS, MOST_CELLS = 200_000, 1_000
#: a cell with a formula that no program has worked out
UNCOMPUTED: Final = object()


class Merged(NamedTuple):
    """Cells that are merged: all but the first of them are empty, whatever they show."""

    written: str
    rows: range
    places: range

    def covers(self, place: int) -> range:
        """Rows in which the cell at a place is not the one that has the value."""
        if place not in self.places:
            return range(0)
        return self.rows[1:] if place == self.places[0] else self.rows


@dataclass(frozen=True)
class Sheet:
    """A sheet.

    Attributes:
        name: of it.
        columns: place of each column by its name without unit, in small letters.
        units: of the columns that state one.
        cells: rows below the heads, with their numbers in the file.
        head: number of the row of heads.
        decimal_comma: whether a comma in a number is its decimal sign, as in a text file, where
            none can part columns that semicolons or tabs part, and none in quotes.
        asked: columns that a reader has asked for.
        decimal_signs: a cell that was read with each.
        faults: why a column cannot be read, by its name; by none: why the sheet cannot be.
    """

    name: str
    columns: dict[str, int]
    units: dict[str, str]
    cells: list[tuple[int, Sequence[Any]]]
    head: int = 1
    decimal_comma: bool = False
    asked: set[str] = field(default_factory=set)
    decimal_signs: dict[str, str] = field(default_factory=dict)
    faults: dict[str, InputError] = field(default_factory=dict)

    def __iter__(self) -> "Iterator[SheetRow]":
        self.need("")
        for number, cells in self.cells:
            yield SheetRow(self, number, cells)

    def unread(self) -> list[str]:
        """Columns with cells that are filled and that no reader has asked for."""
        rows = list(self)
        return [
            name
            for name in self.columns
            if name not in self.asked and any(row.filled(name) for row in rows)
        ]

    def has(self, name: str) -> bool:
        """Whether there is a column."""
        self.need("")
        return name.lower() in self.columns

    def need(self, name: str) -> None:
        """See that a column can be read; no name: the sheet.

        Raises:
            InputError: cells of it are merged, or its head is a formula without a value.
        """
        if fault := self.faults.get(name):
            raise fault

    def merge(self, merged: Iterable[Merged]) -> None:
        """Take note of merged cells: a column whose rows they empty cannot be read.

        Under a head that they empty, nobody knows what a column is.
        """
        numbers = [number for number, _ in self.cells]
        filled: set[int] | None = None
        for one in merged:
            for name, place in self.columns.items():
                rows = one.covers(place)
                if rows and bisect_left(numbers, rows[0]) < bisect_left(numbers, rows[-1] + 1):
                    self.faults.setdefault(name, self._merged(one))
            if self.head in one.rows and len(one.places) > 1:
                if filled is None:
                    filled = {
                        k for _, row in self.cells for k, cell in enumerate(row) if _any(cell)
                    }
                if any(self.head in one.covers(place) for place in filled):
                    self.faults.setdefault("", self._merged(one))

    def _merged(self, one: Merged) -> InputError:
        what = f"cells {one.written[:40]} are merged, and only the first of them has a value"
        return InputError(what, self.name, "part them, and give every row its own value")


@dataclass(frozen=True)
class SheetRow:
    """A row of a sheet."""

    sheet: Sheet
    number: int
    cells: Sequence[Any]

    @property
    def where(self) -> str:
        """Its place in words: sheet, row, and its name where it has one."""
        name = self.text("name")
        return f"{self.sheet.name}, row {self.number}" + (f" ({name})" if name else "")

    def raw(self, name: str) -> Any:
        """A cell; None where it is empty, or there is no such column.

        Raises:
            InputError: it is a formula without a value, or cells of its column are merged.
        """
        self.sheet.asked.add(name.lower())
        self.sheet.need(name.lower())
        cell = self.filled(name)
        if cell is UNCOMPUTED:
            raise uncomputed(f"{self.sheet.name}, row {self.number}, column {name!r}")
        return cell

    def filled(self, name: str) -> Any:
        """A cell, without asking for its column."""
        place = self.sheet.columns.get(name.lower())
        if place is None or place >= len(self.cells):
            return None
        cell = self.cells[place]
        return cell if _any(cell) else None

    def text(self, name: str, default: str = "") -> str:
        """A cell as text; a whole number without decimals."""
        cell = self.raw(name)
        if cell is None:
            return default
        if isinstance(cell, float) and cell.is_integer():
            cell = int(cell)
        return str(cell).strip()

    def needed(self, name: str) -> str:
        """A cell as text that must be there.

        Raises:
            InputError: it is empty.
        """
        found = self.text(name)
        if not found:
            raise InputError(f"{name!r} is empty", self.where, "fill it")
        return found

    def names(self, name: str) -> list[str]:
        """Names in a cell, parted by semicolons."""
        return [part.strip() for part in self.text(name).split(";") if part.strip()]

    def number_of(
        self, name: str, si: str = "", unit: str | None = None, default: float | None = None
    ) -> float:
        """A cell as a number in SI units.

        Args:
            name: of the column.
            si: the unit of the result; nothing: a number without one.
            unit: of a column that states none; None: it must state one.
            default: where the cell is empty; None: it must be filled.

        Raises:
            InputError: it is empty, no number, or without a unit.
        """
        cell = self.raw(name)
        if cell is None:
            if default is None:
                raise InputError(f"{name!r} is empty", self.where, "fill it")
            return default
        return self.number_in(cell, name) * self.scale(name, si, unit)

    def number_in(self, cell: Any, name: str) -> float:
        """What a cell of a column says as a number, in the notation of the sheet.

        Raises:
            InputError: it is none, or the sheet has decimal points and decimal commas.
        """
        if not (self.sheet.decimal_comma and isinstance(cell, str)):
            return read_number(cell, name, self.where)
        signs = self.sheet.decimal_signs
        signs |= {sign: signs.get(sign, cell.strip()) for sign in ".," if sign in cell}
        if len(signs) > 1:
            raise InputError(
                f"{name!r} is {cell.strip()[:40]!r}: the table has points and commas in numbers "
                f"({signs['.'][:40]!r}, {signs[','][:40]!r}), and what a comma means is in doubt",
                self.where, "write all with the same decimal sign, and none between thousands",
            )  # fmt: skip
        return read_number(cell.replace(",", "."), name, self.where, cell)

    def scale(self, name: str, si: str, unit: str | None = None) -> float:
        """SI units per unit of a column."""
        if not si:
            return 1.0
        stated = self.sheet.units.get(name.lower()) or unit
        if stated is None:
            raise InputError(
                f"the column {name!r} states no unit",
                self.sheet.name,
                f"write it in the head: {name} [{si}]",
            )
        return to_si(stated, si, f"{self.sheet.name}, column {name!r}")


def read_number(cell: Any, name: str, where: str, written: Any = None) -> float:
    """A cell as a finite number.

    Args:
        cell: with a decimal point.
        name: of its column.
        where: it stands.
        written: the cell as it stands in the file, where it differs.

    Raises:
        InputError: it is none.
    """
    try:
        number = float_of(cell) if not isinstance(cell, bool) else float("nan")
    except ValueError:
        number = float("nan")
    if not abs(number) < 1e300:
        shown = str(cell if written is None else written)[:40]
        raise InputError(f"{name!r} is {shown!r}, no number", where, "write a number")
    return number


def too_large(where: str) -> InputError:
    """The error of a sheet that is larger than any table of a structure."""
    return InputError(
        f"a sheet of more than {MOST_ROWS} rows or {MOST_CELLS} columns", where,
        "give the part that describes the structure",
    )  # fmt: skip


def uncomputed(where: str) -> InputError:
    return InputError(
        "the cell has a formula without a value that was worked out", where,
        "open the workbook in a spreadsheet program and save it, or write the number",
    )  # fmt: skip


def _any(cell: Any) -> bool:
    """Whether there is anything in a cell."""
    return bool(cell.strip()) if isinstance(cell, str) else cell is not None


def _under_heads(name: str, number: int, row: Sequence[Any], places: set[int]) -> None:
    for place, cell in enumerate(row):
        if place not in places and _any(cell or None):
            raise InputError(
                f"the cell {str(cell)[:40]!r} stands under no head: the row has more cells than "
                "the table has columns", f"{name}, row {number}",
                "put a number with a decimal comma in quotes, or part columns by semicolons",
            )  # fmt: skip


def sheet_of(
    name: str, rows: Iterable[tuple[int, Sequence[Any]]], *, from_text: bool = False
) -> Sheet | None:
    """A sheet of its rows, the first of which that is not empty has the heads; None: it is empty.

    Args:
        name: of it.
        rows: with their numbers in the file.
        from_text: whether they are of a text file: every cell must stand under a head, since a
            decimal comma may have parted two, and a comma in a number is its decimal sign.

    Raises:
        InputError: a column stands twice, a cell has no head, or there are too many rows.
    """
    columns: dict[str, int] = {}
    units: dict[str, str] = {}
    cells: list[tuple[int, Sequence[Any]]] = []
    faults: dict[str, InputError] = {}
    top = 0
    for number, row in rows:
        if not any(map(_any, row)):
            continue
        if len(row) > MOST_CELLS or len(cells) >= MOST_ROWS:
            raise too_large(f"{name}, row {number}")
        if columns:
            if from_text:
                _under_heads(name, number, row, set(columns.values()))
            cells.append((number, row))
            continue
        top = number
        for place, cell in enumerate(row):
            if cell is UNCOMPUTED:
                faults[""] = uncomputed(f"{name}, row {number}, column {place + 1}")
                continue
            head = HEAD.match(str(cell or ""))
            title = " ".join(head["name"].lower().split()) if head else ""
            if not head or not title:
                continue
            if title in columns:
                raise InputError(
                    f"the column {title!r} stands twice", f"{name}, row {number}", "name one anew"
                )
            columns[title] = place
            if head["unit"]:
                units[title] = head["unit"].strip()
        if not columns:
            raise faults.get("") or InputError(
                "the heads of columns are no text", name, "name the columns"
            )
    if not columns:
        return None
    return Sheet(name, columns, units, cells, top, from_text, faults=faults)
