"""What in a logger's columns deserves a second look."""

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.records.numbers import numbers_of
from rga.records.record import LARGEST
from rga.records.table import Table
from rga.records.times import Clock

#: numbers that loggers write where they have no reading
CODES = (-9999.0, 9999.0, -999.0, 999.0, -99999.0, 99999.0, -6999.0, -1e6, 1e6, -7999.0, 7999.0)
#: how many times the spread of all else a code lies from it
FAR = 10.0
#: usual steps between two rows, beyond which rows are missing
GAP = 1.5
#: rows in which a channel that works does not read the same throughout
STILL = 20


def codes_in(values: FloatArray) -> dict[float, int]:
    """Codes that stand in a column far from all else that it reads, and in how many rows.

    >>> codes_in(np.array([1.0, 2.0, -9999.0, 1.5]))
    {-9999.0: 1}
    """
    held = values[np.isfinite(values)]
    found = {}
    for code in CODES:
        others = held[~np.isin(held, CODES)]
        rows = int((held == code).sum())
        if rows and len(others):
            spread = max(float(np.ptp(others)), 1e-9)
            if abs(code - np.median(others)) > FAR * spread:
                found[code] = rows
    return found


def still_value(values: FloatArray) -> float | None:
    """What a channel reads throughout; None: it moves, or has too few readings to say so."""
    held = values[np.isfinite(values)]
    return float(held[0]) if len(held) >= STILL and (held == held[0]).all() else None


def readable(table: Table, column: str) -> FloatArray | None:
    """Numbers of a column, infinite ones where nothing measures them; None where it holds others
    things as well."""
    series = table.frame[column]
    if not (series.dtype.is_numeric() or series.dtype in (pl.String, pl.Null)):
        return None
    read, bad = numbers_of(series, table.notation, table.missing)
    return None if bad.any() else np.where(np.abs(read) > LARGEST, np.inf, read)


def gaps_in(clock: Clock) -> str | None:
    """In words, that rows are missing; None: they follow each other evenly."""
    steps = np.diff(clock.seconds)
    if len(steps) < 2:
        return None
    usual = float(np.median(steps))
    gaps = steps[steps > GAP * usual]
    if not len(gaps):
        return None
    return f"{len(gaps)} gaps in time, the longest {gaps.max():g} s, where a step is {usual:g} s"
