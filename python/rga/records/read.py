"""Tables of text or numbers from CSV and Parquet files."""

import csv
import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError

#: what no unit of any sensor reaches
LARGEST = 1e30


@dataclass(frozen=True)
class Table:
    """Columns of a file.

    Attributes:
        path: the file.
        frame: its columns; those of a text file as stripped text, null where a cell is empty.
        row_name, first: how a reader of the file counts rows ("line", 2 for a CSV with a header).
        sha256: hash of the file.
    """

    path: Path
    frame: pl.DataFrame
    row_name: str
    first: int
    sha256: str

    def where(self, row: int, column: str | None = None) -> str:
        """The place of a cell, for an error."""
        place = f"{self.path}, {self.row_name} {self.first + row}"
        return place if column is None else f"{place}, column {column!r}"

    def numbers(self, column: str) -> FloatArray:
        """A column as float[n], NaN where a cell is empty or says NaN.

        Raises:
            InputError: a cell holds no number, or one that nothing measures.
        """
        series = self.frame[column]
        values = series.cast(pl.Float64, strict=False) if _castable(series.dtype) else None
        if values is None:
            raise InputError(
                f"column {column!r} holds {series.dtype}, no numbers",
                str(self.path),
                "write numbers, or list the column under [unused] in import.toml",
            )
        bad = values.is_null() & series.is_not_null()
        if bad.any():
            row = int(bad.arg_true()[0])
            raise InputError(
                f"{series[row]!r} is no number",
                self.where(row, column),
                "write a number with a decimal point, or leave the cell empty where it is missing",
            )
        numbers = np.array(values.fill_null(float("nan")).to_numpy(), dtype=float)
        impossible = np.abs(numbers) > LARGEST
        if impossible.any():
            row = int(np.argmax(impossible))
            infinite = np.isinf(numbers[row])
            raise InputError(
                "the value is infinite" if infinite else f"nothing measures {numbers[row]:g}",
                self.where(row, column),
                "leave the cell empty where the value is missing",
            )
        return numbers


def read_table(path: str | Path, delimiter: str = ",") -> Table:
    """Read a CSV or Parquet file.

    Args:
        path: the file; Parquet is known by its suffix or its first bytes, all else is text.
        delimiter: what separates the columns of a text file.

    Raises:
        InputError: the file is missing, empty or damaged, is not UTF-8, has no rows, repeats a
            column, or has lines of unequal length.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = error.strerror or "unreadable"
        raise InputError(
            f"the file cannot be read, {reason.lower()}", str(path), "check the path"
        ) from None
    if not data:
        raise InputError("the file is empty", str(path), "give a file with a header and rows")
    parquet = path.suffix.lower() in (".parquet", ".pq") or data.startswith(b"PAR1")
    frame = _read_parquet(data, path) if parquet else _read_text(data, path, delimiter)
    if frame.height == 0:
        raise InputError("there are no rows below the header", str(path), "give at least one row")
    digest = hashlib.sha256(data).hexdigest()
    return Table(path, frame, "row" if parquet else "line", 1 if parquet else 2, digest)


def _read_parquet(data: bytes, path: Path) -> pl.DataFrame:
    try:
        return pl.read_parquet(data)
    except (pl.exceptions.PolarsError, OSError) as error:
        raise InputError(
            f"this is no complete Parquet file: {_first_line(error)}",
            str(path),
            "write it again, or copy it again in full",
        ) from None


def _read_text(data: bytes, path: Path, delimiter: str) -> pl.DataFrame:
    try:
        lines = data.decode("utf-8-sig").split("\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            "the text is not UTF-8", f"{path}, line {line}", "save the file as UTF-8"
        ) from None
    header = next(csv.reader([lines[0].rstrip("\r")], delimiter=delimiter), [])
    names = [name.strip() for name in header]
    _check_header(names, path)
    if b'"' not in data:
        _check_lengths(lines, delimiter, path)
    try:
        frame = pl.read_csv(data, separator=delimiter, infer_schema=False)
    except pl.exceptions.PolarsError as error:
        raise InputError(
            f"the table cannot be read: {_first_line(error)}", str(path), "mend the file"
        ) from None
    frame = frame.rename(dict(zip(frame.columns, names, strict=True)))
    stripped = pl.all().str.strip_chars()
    frame = frame.select(pl.when(stripped != "").then(stripped).name.keep())
    filled = frame.select(pl.any_horizontal(pl.all().is_not_null())).to_series().arg_true()
    # A file may end with blank lines; blank lines between rows are left to be found as missing.
    return frame.head(int(filled[-1]) + 1 if len(filled) else 0)


def _check_header(names: list[str], path: Path) -> None:
    if not any(names):
        raise InputError("the first line is empty", str(path), "name the columns in the first line")
    for name in names:
        if not name:
            raise InputError(
                f"column {names.index(name) + 1} has no name", f"{path}, line 1", "name it"
            )
        if names.count(name) > 1:
            raise InputError(
                f"the column {name!r} stands twice", f"{path}, line 1", "give every column a name"
            )


def _check_lengths(lines: list[str], delimiter: str, path: Path) -> None:
    expected = lines[0].count(delimiter)
    for number, line in enumerate(lines[1:], start=2):
        if line.count(delimiter) != expected and line.strip():
            raise InputError(
                f"the line has {line.count(delimiter) + 1} fields, the header has {expected + 1}",
                f"{path}, line {number}",
                "write all fields of the line, empty ones where values are missing",
            )


def _castable(dtype: pl.DataType) -> bool:
    return dtype.is_numeric() or dtype in (pl.String, pl.Null)


def _first_line(error: Exception) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
