"""Workbooks (.xlsx) and folders of CSV files as sheets."""

import csv
import io
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.importing.reading import read_bytes, read_text
from rga.importing.sheets import Sheet, sheet_of
from rga.lazy import needing_extras

#: bytes of the largest workbook when it is unpacked
LARGEST = 256 * 2**20


def read_workbook(path: Path) -> dict[str, Sheet]:
    """The sheets of a workbook that are not empty, by name.

    Raises:
        InputError: it is none, damaged, or larger than any table of a structure.
    """
    data = read_bytes(path)
    return {
        name: sheet
        for name, rows in _sheets(data, path)
        if name not in TURNED and (sheet := sheet_of(name, rows)) is not None
    }


def read_properties(path: Path, name: str) -> dict[str, str]:
    """A sheet with names in its first column and values in its second, in small letters."""
    found: dict[str, str] = {}
    for title, rows in _sheets(read_bytes(path), path):
        for row in rows if title == name else ():
            if len(row) > 1 and row[0] is not None and row[1] is not None:
                found[str(row[0]).strip().lower()] = str(row[1]).strip()
    return found


#: sheets whose names stand in a column
TURNED = ("Project", "Model")


def _sheets(data: bytes, path: Path) -> Iterator[tuple[str, Iterator[tuple[Any, ...]]]]:
    """Names of the sheets and their rows, one after the other."""
    with needing_extras():
        import openpyxl
    with _errors_of(path):
        with zipfile.ZipFile(io.BytesIO(data)) as packed:
            size = sum(one.file_size for one in packed.infolist())
        if size > LARGEST:
            raise InputError(
                f"the workbook unpacks to {size / 2**20:.0f} MiB", str(path), "give a smaller one"
            )
        book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
    for sheet in book.worksheets:
        yield sheet.title, _rows(sheet, path)


def _rows(sheet: Any, path: Path) -> Iterator[tuple[Any, ...]]:
    with _errors_of(path), catch_warnings():
        # A date that is none is told of as a cell that cannot be read.
        simplefilter("ignore")
        # What a sheet says of its size may be anything.
        sheet.reset_dimensions()
        rows = list(sheet.iter_rows(values_only=True))
    yield from rows


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
            sheet = sheet_of(path.name, iter(rows), from_text=True)
        except csv.Error as error:
            raise InputError(
                f"the table cannot be read: {error}", str(path), "mend its quotes"
            ) from None
        if sheet is not None:
            sheets[path.stem.lower()] = sheet
    return sheets
