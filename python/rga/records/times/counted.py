"""Times that are numbers: what they count, and from when."""

from datetime import UTC, datetime

import numpy as np
import polars as pl

from rga.arrays import FloatArray

#: how much one is [s], and the moment at which they are 0
COUNTED = {
    "excel": (86400.0, datetime(1899, 12, 30)),
    "unix": (1.0, datetime(1970, 1, 1, tzinfo=UTC)),
    "unix_ms": (1e-3, datetime(1970, 1, 1, tzinfo=UTC)),
    "unix_us": (1e-6, datetime(1970, 1, 1, tzinfo=UTC)),
    "unix_ns": (1e-9, datetime(1970, 1, 1, tzinfo=UTC)),
}
#: seconds since no moment that is known, whatever their size
SECONDS = "seconds"
#: digits of dates that are written as one number, and how they are
COMPACT = {14: "%Y%m%d%H%M%S", 12: "%Y%m%d%H%M", 10: "%Y%m%d%H", 8: "%Y%m%d"}
#: years in which structures are measured: a number that is a date in them may be one
_YEARS = (1990, 2050)
#: steps that loggers are set to [s], from a second to a week
_USUAL = np.array([
    1, 2, 5, 10, 15, 20, 30, *(60 * n for n in (1, 2, 5, 6, 10, 12, 15, 20, 30)),
    *(3600 * n for n in (1, 2, 3, 4, 6, 8, 12, 24, 168)),
])  # fmt: skip
#: seconds that no record counts from its own beginning: 130 years
_LONGEST = 4.1e9


def looks_like(numbers: FloatArray) -> str | None:
    """What numbers without a unit count, if they hardly are seconds from a record's beginning.

    Days of a spreadsheet are known by their size, which seconds may have as well, and by a step
    that loggers are set to, or that no logger has which counts seconds.

    Args:
        numbers: float[n], in the order of the rows.

    Returns:
        A key of `COUNTED`, a pattern of `COMPACT`, "" for what is none of these and no seconds
        either; None for seconds.

    >>> looks_like(np.array([1709632800000.0])), looks_like(np.array([20240305100000.0]))
    ('unix_ms', '%Y%m%d%H%M%S')
    >>> looks_like(45356.5 + np.arange(3) / 24), looks_like(45356.5 + np.arange(3) / 100)
    ('excel', None)
    """
    low, high = float(numbers.min()), float(numbers.max())
    for digits, pattern in COMPACT.items():
        if 10.0 ** (digits - 1) <= low and high < 10.0**digits and _are_dates(numbers, pattern):
            return pattern
    for name, (size, zero) in COUNTED.items():
        first, last = (
            (datetime(year, 1, 1, tzinfo=zero.tzinfo) - zero).total_seconds() / size
            for year in _YEARS
        )
        if first <= low and high < last and (name != "excel" or _steps_of_days(numbers)):
            return name
    return "" if high > _LONGEST else None


def _are_dates(numbers: FloatArray, pattern: str) -> bool:
    if (numbers != np.round(numbers)).any():
        return False
    texts = pl.Series(numbers.astype(np.int64)).cast(pl.String)
    if pattern == "%Y%m%d%H":  # polars reads no hour without its minutes
        texts, pattern = texts + "00", "%Y%m%d%H%M"
    if pattern == "%Y%m%d":
        read = texts.str.to_date(pattern, strict=False)
    else:
        read = texts.str.to_datetime(pattern, strict=False, time_unit="us")
    years = read.dt.year()
    return not read.has_nulls() and bool(years.is_between(*_YEARS).all())


def _steps_of_days(numbers: FloatArray) -> bool:
    """Whether steps are those of days rather than those of seconds."""
    if len(numbers) < 2:
        return False
    step = float(np.median(np.diff(numbers)))
    usual = bool((np.abs(step * 86400 / _USUAL - 1) < 0.01).any())
    return usual or abs(step * 1000 - round(step * 1000)) > 1e-3
