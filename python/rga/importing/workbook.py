"""Workbooks (.xlsx) and folders of CSV files as sheets."""

import csv
import io
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import catch_warnings, simplefilter

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.importing.reading import read_bytes, read_text
from rga.importing.sheets import UNCOMPUTED, Sheet, sheet_of, uncomputed
from rga.lazy import needing_extras

if TYPE_CHECKING:
    from rga.importing.spreadsheet import Worksheet

#: bytes of the largest workbook when it is unpacked
LARGEST = 256 * 2**20


@contextmanager
def _quiet() -> Iterator[None]:
    """Without warnings: a date that is none is told of as a cell that cannot be read."""
    with catch_warnings():
        simplefilter("ignore")
        yield


@_quiet()
def read_workbook(path: Path) -> dict[str, Sheet]:
    """The sheets of a workbook that are not empty, by name.

    Raises:
        InputError: it is none, damaged, or larger than any table of a structure.
    """
    found: dict[str, Sheet] = {}
    for worksheet in _worksheets(path):
        if worksheet.name in TURNED:
            continue
        if (sheet := sheet_of(worksheet.name, _rows(worksheet, path))) is not None:
            sheet.merge(worksheet.merged)
            found[worksheet.name] = sheet
    return found


@_quiet()
def read_properties(path: Path, name: str) -> dict[str, str]:
    """A sheet with names in its first column and values in its second, in small letters.

    Raises:
        InputError: the workbook is damaged, or one of them is a formula without a value.
    """
    found: dict[str, str] = {}
    for worksheet in _worksheets(path):
        for number, row in _rows(worksheet, path) if worksheet.name == name else ():
            if UNCOMPUTED in row[:2]:
                raise uncomputed(f"{name}, row {number}, column {row.index(UNCOMPUTED) + 1}")
            if len(row) > 1 and row[0] is not None and row[1] is not None:
                found[str(row[0]).strip().lower()] = str(row[1]).strip()
    return found


#: sheets whose names stand in a column
TURNED = ("Project", "Model")


def _worksheets(path: Path) -> "Iterator[Worksheet]":
    """The sheets of a workbook, one after the other."""
    data = read_bytes(path)
    with needing_extras():
        from rga.importing.spreadsheet import open_workbook
    with _errors_of(path):
        with zipfile.ZipFile(io.BytesIO(data)) as packed:
            size = sum(one.file_size for one in packed.infolist())
        if size > LARGEST:
            raise InputError(
                f"the workbook unpacks to {size / 2**20:.0f} MiB", str(path), "give a smaller one"
            )
        worksheets = list(open_workbook(data))
    yield from worksheets


def _rows(worksheet: "Worksheet", path: Path) -> Iterator[tuple[int, Sequence[Any]]]:
    with _errors_of(path):
        yield from worksheet.rows()


@contextmanager
def _errors_of(path: Path) -> Iterator[None]:
    """Whatever fails as a workbook is read, as what is wrong with the file."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:
        what = f"this is no whole workbook: {fault_of(error)[:100]}"
        raise InputError(what, str(path), "save it again as .xlsx") from None


def read_csv_folder(paths: list[Path]) -> dict[str, Sheet]:
    """CSV files as sheets, by their names without suffix; commas, semicolons or tabs part columns.

    Raises:
        InputError: one cannot be read, or has no rows.
    """
    sheets: dict[str, Sheet] = {}
    for path in paths:
        text = read_text(path)
        first = text.partition("\n")[0]
        delimiter = max(",", ";", "\t", key=first.count)
        try:
            rows = csv.reader(io.StringIO(text), delimiter=delimiter, strict=True)
            sheet = sheet_of(path.name, enumerate(rows, start=1), from_text=True)
        except csv.Error as error:
            raise InputError(
                f"the table cannot be read: {error}", str(path), "mend its quotes"
            ) from None
        if sheet is not None:
            sheets[path.stem.lower()] = sheet
    return sheets
