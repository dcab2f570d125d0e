"""The time axis of a file: ISO 8601 or seconds, checked to increase."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from typing import Literal

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.mapping import TimeColumns
from rga.records.read import Table


@dataclass(frozen=True)
class Clock:
    """Time of the rows.

    Attributes:
        seconds: float[n], since the first row.
        start: the first time stamp, ISO 8601 text or seconds.
        time_format: "iso" or "seconds".
    """

    seconds: FloatArray
    start: str | float
    time_format: Literal["iso", "seconds"]


def read_clock(table: Table, time: TimeColumns) -> Clock:
    """The time axis of a table.

    Args:
        table: the file's columns.
        time: which columns hold the time, and how.

    Raises:
        InputError: a column or a time is missing, a time cannot be read, two notations are mixed,
            or time repeats or runs backwards.
    """
    for column in time.columns:
        if column not in table.frame.columns:
            raise InputError(
                f"there is no time column {column!r}",
                f"{table.path}, columns {_listed(table.frame.columns)}",
                "name it 'time', or give [time] columns (and the delimiter) in import.toml",
            )
    clock = _stated(table, time)
    if time.sampling_rate_hz is not None:
        counted = np.arange(table.frame.height) / time.sampling_rate_hz
        return Clock(counted, clock.start, clock.time_format)
    _check_order(clock.seconds, table, time.columns)
    return clock


def _stated(table: Table, time: TimeColumns) -> Clock:
    """The time as the columns state it, in whatever order."""
    if not time.columns:
        return Clock(np.zeros(table.frame.height), 0.0, "seconds")
    series = [table.frame[column] for column in time.columns]
    for column, values in zip(time.columns, series, strict=True):
        if values.is_null().any():
            raise InputError(
                "the time is missing",
                table.where(int(values.is_null().arg_true()[0]), column),
                "give every row its time, or take the row out",
            )
    if len(series) == 1 and series[0].dtype.is_temporal():
        moments = series[0].cast(pl.Datetime("us"))
        stamps = np.array(moments.to_physical().to_numpy(), dtype=float) / 1e6
        return Clock(stamps - stamps[0], moments[0].isoformat(), "iso")
    texts = [values.cast(pl.String).to_list() for values in series]
    joined = [" ".join(parts) for parts in zip(*texts, strict=True)]
    where = " + ".join(time.columns)
    if time.format is not None:
        wanted = f"written as {time.format}"
        read = _moments(joined, partial(_by_format, pattern=time.format), wanted, table, where)
        return _iso(read, read[0].isoformat())
    if _is_number(joined[0]):
        stamps = _seconds(joined, table, where)
        return Clock(stamps - stamps[0], float(stamps[0]), "seconds")
    wanted = "ISO 8601 like the first row, or seconds throughout"
    return _iso(_moments(joined, datetime.fromisoformat, wanted, table, where), joined[0])


def _iso(moments: list[datetime], start: str) -> Clock:
    elapsed = np.array([(moment - moments[0]).total_seconds() for moment in moments])
    return Clock(elapsed, start, "iso")


def _moments(
    texts: list[str], parse: Callable[[str], datetime], wanted: str, table: Table, column: str
) -> list[datetime]:
    moments: list[datetime] = []
    for row, text in enumerate(texts):
        try:
            moments.append(parse(text))
        except ValueError:
            raise InputError(
                f"the time {text!r} cannot be read", table.where(row, column), f"give it {wanted}"
            ) from None
        if (moments[row].tzinfo is None) != (moments[0].tzinfo is None):
            raise InputError(
                "some times have a time zone and some have none",
                table.where(row, column),
                "write all times alike",
            )
    return moments


def _seconds(texts: list[str], table: Table, column: str) -> FloatArray:
    for row, text in enumerate(texts):
        if not _is_number(text):
            raise InputError(
                f"the time {text!r} is not in seconds as in the first row",
                table.where(row, column),
                "write all times in seconds, or all in ISO 8601",
            )
    return np.array([float(text) for text in texts])


def _by_format(text: str, pattern: str) -> datetime:
    return datetime.strptime(text, pattern)


def _is_number(text: str) -> bool:
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False


def _check_order(stamps: FloatArray, table: Table, columns: list[str]) -> None:
    step = np.diff(stamps)
    wrong = ~(step > 0)
    if not wrong.any():
        return
    row = int(np.argmax(wrong)) + 1
    if step[row - 1] == 0:
        what = "the time is the same as in the row before"
        remedy = "take the double row out, or give [time] sampling_rate_hz where stamps are coarse"
    else:
        what, remedy = "the time runs backwards", "sort the rows by time"
    raise InputError(what, table.where(row, " + ".join(columns)), remedy)


def _listed(names: list[str]) -> str:
    shown = ", ".join(names[:6])
    return shown if len(names) <= 6 else f"{shown}, ... ({len(names)} in all)"
