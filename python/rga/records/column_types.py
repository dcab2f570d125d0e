"""Columns as Parquet files and data frames have them, as numbers, texts and times that are read."""

import polars as pl

from rga.errors import InputError

#: what is counted in a day of each unit of a time stamp; 64 bits of nanoseconds stay near 2000
_A_DAY = {"ms": 86_400_000, "us": 86_400_000_000}
#: days of 1970-01-01 from the first of the years 1 and 10 000, between which dates are written
FIRST, END = -719_162, 2_932_897


def readable(frame: pl.DataFrame, place: str) -> pl.DataFrame:
    """The columns, those of categories as texts.

    Args:
        frame: as it was given.
        place: of it, for an error.

    Raises:
        InputError: a column holds dates beyond the years 1 to 9999.

    >>> readable(pl.DataFrame({"a": pl.Series(["x"], dtype=pl.Categorical)}), "a.parquet").schema
    Schema([('a', String)])
    """
    for name, kind in frame.schema.items():
        day = 1 if isinstance(kind, pl.Date) else _A_DAY.get(getattr(kind, "time_unit", None) or "")
        if day is not None and not isinstance(kind, pl.Duration):
            counted = frame[name].to_physical()
            # Compared as whole numbers: dates beyond the calendar cannot even be shown.
            beyond = (counted < FIRST * day) | (counted >= END * day)
            if (row := beyond.arg_max()) is not None and beyond[row]:
                what = f"the time in row {row + 1} lies beyond the years 1 to 9999"
                raise InputError(what, f"{place}, column {name!r}", "correct it, or leave it out")
    return frame.with_columns(pl.col(pl.Categorical, pl.Enum).cast(pl.String))
