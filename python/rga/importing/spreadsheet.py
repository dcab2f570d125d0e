"""Sheets of a workbook (.xlsx), row by row, with what a table must know of its cells.

`openpyxl.load_workbook` tells neither a formula that was never computed from an empty cell, nor
an empty cell from one that is merged into another; it makes up all rows that a file skips, and
fails where a chart sheet has no chart. So its parts are put together here. Needs openpyxl.
"""

import io
import re
from collections.abc import Iterator
from typing import Any

from openpyxl.reader.excel import ExcelReader
from openpyxl.styles.stylesheet import apply_stylesheet
from openpyxl.utils.cell import range_boundaries
from openpyxl.worksheet._reader import (
    CELL_TAG,
    FORMULA_TAG,
    MERGE_TAG,
    ROW_TAG,
    VALUE_TAG,
    WorkSheetParser,
)  # fmt: skip
from openpyxl.xml.functions import iterparse

from rga.errors import InputError
from rga.importing.sheets import MOST_CELLS, MOST_ROWS, UNCOMPUTED, Merged, too_large

#: the last row, and the last column, that a sheet can have
LAST_ROW, LAST_COLUMN = 1_048_576, 16_384
#: where a row begins in the text of a sheet
ROW = re.compile(rb"[<:]row[\s/>]")
MERGED_TAG = MERGE_TAG.removesuffix("s")


def open_workbook(data: bytes) -> "Iterator[Worksheet]":
    """The sheets of a workbook that have cells: those of charts, macros and dialogs have none."""
    reader = ExcelReader(io.BytesIO(data), read_only=True, data_only=True, keep_links=False)
    reader.read_manifest()
    reader.read_strings()
    reader.read_workbook()
    apply_stylesheet(reader.archive, reader.wb)
    for sheet, relation in reader.parser.find_sheets():
        if relation.Type.endswith("/worksheet"):
            yield Worksheet(reader, sheet.name, relation.target)


class Worksheet:
    """A sheet.

    Attributes:
        name: of it.
        merged: ranges of merged cells, which stand behind the rows, and are known after them.
    """

    def __init__(self, reader: Any, name: str, target: str) -> None:
        self.name = name
        self.merged: list[Merged] = []
        self._reader, self._target = reader, target
        asked = reader.wb.calculation
        self._placeholders = bool(asked and asked.fullCalcOnLoad)

    def rows(self) -> Iterator[tuple[int, list[Any]]]:
        """Numbers and cells of the rows that the file has, up to the last cell that is filled.

        Raises:
            InputError: there are more than any table of a structure has, or out of order.
        """
        book, last, cells = self._reader.wb, 0, 0
        self._count()
        with self._reader.archive.open(self._target) as source:
            parser = WorkSheetParser(
                source, self._reader.shared_strings, data_only=True, epoch=book.epoch,
                date_formats=book._date_formats, timedelta_formats=book._timedelta_formats,
            )  # fmt: skip
            for _, element in iterparse(source):
                if element.tag == CELL_TAG:
                    cells += 1
                    if cells > LAST_COLUMN:
                        raise too_large(f"{self.name}, row {last + 1}")
                elif element.tag == ROW_TAG:
                    number, found = parser.parse_row(element)
                    if not last < number <= LAST_ROW:
                        raise self._misplaced(number, last)
                    last, cells = number, 0
                    yield number, self._filled(element, found, number)
                    element.clear()
                elif element.tag == MERGED_TAG:
                    self._merge(element.get("ref"))

    def _count(self) -> None:
        """See that there are not too many rows, which takes far longer where each is read."""
        rows = 0
        with self._reader.archive.open(self._target) as source:
            while part := source.read(2**20):
                rows += len(ROW.findall(part))
                if rows > MOST_ROWS:
                    raise too_large(self.name)

    def _misplaced(self, number: int, last: int) -> InputError:
        what = (
            f"a sheet has no row {number}: its last is {LAST_ROW}"
            if number > last
            else f"row {number} stands behind row {last}"
        )
        return InputError(what, self.name, "save it again in a spreadsheet program")

    def _filled(self, row: Any, found: list[dict[str, Any]], number: int) -> list[Any]:
        """The cells of a row by their places."""
        values: dict[int, Any] = {}
        for element, cell in zip(row, found, strict=True):
            value = cell["value"]
            if element.find(FORMULA_TAG) is not None and self._uncomputed(element, value):
                value = UNCOMPUTED
            if value is None:
                continue
            if cell["column"] in values:
                raise InputError(
                    f"column {cell['column']} stands twice in a row", f"{self.name}, row {number}",
                    "save it again in a spreadsheet program",
                )  # fmt: skip
            values[cell["column"]] = value
        width = max(values, default=0)
        if width > MOST_CELLS:
            raise too_large(f"{self.name}, row {number}")
        return [values.get(column) for column in range(1, width + 1)]

    def _uncomputed(self, element: Any, value: Any) -> bool:
        """Whether the formula of a cell has no value that a program has worked out.

        An empty text is a value that formulas have. Zero is what a program that computes nothing
        writes in its place, when it asks in the file that all be computed as it is opened.
        """
        if value is None:
            return element.get("t") != "str" or element.find(VALUE_TAG) is None
        return self._placeholders and value == 0 and not isinstance(value, bool)

    def _merge(self, written: str) -> None:
        if len(self.merged) >= MOST_ROWS:
            raise too_large(self.name)
        left, top, right, bottom = range_boundaries(written)
        self.merged.append(
            Merged(written, range(top or 1, (bottom or LAST_ROW) + 1),
                   range((left or 1) - 1, right or LAST_COLUMN))
        )  # fmt: skip
