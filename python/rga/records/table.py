"""Columns of a logger's file, whatever its format: the common raw table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.numbers import Notation, numbers_of
from rga.records.record import LARGEST


@dataclass(frozen=True)
class StatedTime:
    """The time as a format states it.

    Attributes:
        columns: that hold it; none where rows are counted.
        format: strptime pattern of the columns joined by a blank, or one of those of numbers.
        start: ISO 8601 time stamp at which the elapsed time is 0; None: it is not said.
        step: between rows that are counted [s].
        unit: of columns that hold elapsed time [s].
        zone: of stamps that have none.
    """

    columns: tuple[str, ...] = ()
    format: str | None = None
    start: str | None = None
    step: float | None = None
    unit: float = 1.0
    zone: str | None = None


@dataclass(frozen=True)
class Table:
    """Columns of a file.

    Attributes:
        path: the file.
        frame: its columns; those of a text file as stripped text, null where a cell is empty.
        row_name, first: how a reader of the file counts rows ("line", 2 for a CSV with a header).
        skipped: lines without a row that lie between rows, counted as those are, in their order.
        rows: of the file, number of each row here; None: all, as the file has them.
        sha256: hash of the file.
        format: name of the format, as a reader is told.
        units: by column, as the file writes them, where it states any.
        names: by column, what the file calls a channel whose column has its unit in the name.
        time: as the format states it; None: it does not.
        bookkeeping: columns of the format's own, such as the number of a record: no channels.
        missing: what stands for a missing value by the format, beside what always does.
        notation: how numbers are written.
        notes: what was understood of the file, in words.
        warnings: what a reader should know of the file, in words.
    """

    path: Path
    frame: pl.DataFrame
    row_name: str
    first: int
    skipped: tuple[int, ...] = ()
    rows: Sequence[int] | None = None
    sha256: str = ""
    format: str = "plain text"
    units: Mapping[str, str] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)
    time: StatedTime | None = None
    bookkeeping: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    notation: Notation = field(default_factory=Notation)
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def where(self, row: int, column: str | None = None) -> str:
        """The place of a cell, for an error."""
        line = self.first + (row if self.rows is None else self.rows[row])
        for blank in self.skipped:
            line += blank <= line
        place = f"{self.path}, {self.row_name} {line}"
        return place if column is None else f"{place}, column {column!r}"

    def check_rows(self) -> None:
        """Whether there are rows.

        Raises:
            InputError: there is none.
        """
        if self.frame.height == 0:
            what = "there are no rows below the header"
            raise InputError(what, str(self.path), "give at least one row")

    def numbers(self, column: str, missing: tuple[str, ...] = ()) -> FloatArray:
        """A column as float[n], NaN where a cell is empty or says that a value is missing.

        Args:
            column: its name.
            missing: what stands for a missing value, beside what always does.

        Raises:
            InputError: a cell holds no number, or one that nothing measures.
        """
        series = self.frame[column]
        if not (series.dtype.is_numeric() or series.dtype in (pl.String, pl.Null)):
            raise InputError(
                f"column {column!r} holds {series.dtype}, no numbers",
                str(self.path),
                "write numbers, or list the column under [unused] in import.toml",
            )
        read, bad = numbers_of(series, self.notation, (*self.missing, *missing))
        if bad.any():
            row = int(np.argmax(bad))
            raise InputError(
                f"{series[row]!r} is no number", self.where(row, column), self._remedy(series[row])
            )
        impossible = np.abs(read) > LARGEST
        if impossible.any():
            row = int(np.argmax(impossible))
            infinite = np.isinf(read[row])
            raise InputError(
                "the value is infinite" if infinite else f"nothing measures {read[row]:g}",
                self.where(row, column),
                "leave the cell empty where the value is missing",
            )
        return read

    def _remedy(self, cell: str) -> str:
        if self.notation.thousands and self.notation.thousands in cell:
            return (
                f"{self.notation.thousands!r} parts groups of three digits in this file, and "
                f"{self.notation.decimal!r} is the decimal sign: write all numbers alike, or state "
                "decimal and thousands in import.toml"
            )
        if self.notation.decimal == "," and "." in cell:
            return 'its decimal sign is a comma: state decimal, or thousands = "." in import.toml'
        if self.notation.decimal == "." and "," in cell:
            return (
                "write a number with a decimal point, or state decimal or thousands in import.toml"
            )
        return (
            "write a number with a decimal point, leave the cell empty where it is missing, or "
            f"state missing = [{cell[:20]!r}] in import.toml"
        )
