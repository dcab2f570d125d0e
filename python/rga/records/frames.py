"""Data frames of polars or pandas as tables."""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import polars as pl

from rga.errors import InputError, kind_of
from rga.records.column_types import readable
from rga.records.table import Table

#: what a record is read from: a file, several in time, a folder, a mapping, or a data frame
RecordSource = str | Path | Sequence[str | Path] | pl.DataFrame | pl.LazyFrame


def is_frame(given: object) -> bool:
    """Whether something is a data frame of polars or pandas; neither is imported for it."""
    return type(given).__module__.split(".")[0] in ("polars", "pandas")


def table_of_frame(given: Any) -> Table:
    """A data frame as a table.

    Args:
        given: of polars, or of pandas; an index of time stamps, or one named `time`, is the time.

    Raises:
        InputError: it has no rows, or is none of both.
    """
    frame = given.collect() if isinstance(given, pl.LazyFrame) else given
    if not isinstance(frame, pl.DataFrame):
        frame = _of_pandas(frame)
    if frame.height == 0:
        raise InputError("there are no rows in the data frame", "record", "give at least one row")
    digest = sha256()
    for name, kind in frame.schema.items():
        if kind.is_nested() or kind in (pl.Object, pl.Binary):
            what = f"the column {name!r} holds {str(kind).lower()[:40]}, and no numbers"
            raise InputError(what, "data frame", "leave it out, or make columns of its parts")
    frame = readable(frame, "data frame")
    for name in frame.columns:
        digest.update(name.encode())
        column = frame.select(name)
        if isinstance(frame.schema[name], pl.Duration):
            column = column.select(pl.all().to_physical())
        digest.update(column.write_csv().encode())
    return Table(
        Path("data frame"), frame, "row", 1, sha256=digest.hexdigest(), format="data frame"
    )


def _of_pandas(frame: Any) -> pl.DataFrame:
    if not (hasattr(frame, "columns") and hasattr(frame, "index")):
        raise InputError(f"this is {kind_of(frame)}, no data frame", "record", "give a data frame")
    names = [str(name) for name in frame.columns]
    if double := next((name for name in names if names.count(name) > 1), None):
        raise InputError(
            f"the column {double!r} stands twice", "data frame", "give every column its own name"
        )
    columns = dict(zip(names, (frame[name] for name in frame.columns), strict=True))
    stamped = type(frame.index).__name__ == "DatetimeIndex"
    if "time" not in columns and (stamped or frame.index.name == "time"):
        columns = {"time": frame.index.to_series(), **columns}
    return pl.DataFrame([_series(name, column) for name, column in columns.items()])


def _series(name: str, column: Any) -> pl.Series:
    zone = getattr(getattr(column, "dtype", None), "tz", None)
    if zone is not None:
        plain = column.dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()
        return pl.Series(name, plain).dt.replace_time_zone("UTC")
    values = column.to_numpy()
    if values.dtype == object:
        held = [None if one is None or one != one else str(one) for one in values]
        return pl.Series(name, held, dtype=pl.String)
    return pl.Series(name, values)
