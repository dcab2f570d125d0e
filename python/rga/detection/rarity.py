"""How rare alarms without a change are to be."""

from typing import Literal

import numpy as np

from rga.errors import InputError

#: rows between false alarms, at least and at most
LEAST, MOST = 100.0, 1e12
SECONDS = {"hour": 3600.0, "day": 86_400.0, "week": 604_800.0, "month": 2_629_800.0,
           "year": 31_557_600.0}  # fmt: skip


def rows_between(
    alarms: float, *, per: Literal["hour", "day", "week", "month", "year"], rate: float
) -> float:
    """Rows between false alarms, from how many are tolerated in a time.

    Args:
        alarms: in that time.
        per: the time.
        rate: rows per second [Hz].

    Raises:
        InputError: a number that is not above 0, no such time, or fewer than 100 rows between
            alarms or more than 1e12.

    Examples:
        >>> rows_between(1, per="month", rate=1.0)
        2629800.0
    """
    if not (isinstance(per, str) and per in SECONDS):
        raise InputError(f"there is no time {per!r}", "per", f"give one of {', '.join(SECONDS)}")
    for name, value in (("alarms", alarms), ("rate", rate)):
        if not (_is_number(value) and np.isfinite(value) and value > 0):
            raise InputError(f"{name} is {value!r}", name, "give a number above 0")
    rows = SECONDS[per] * rate / alarms
    if not LEAST <= rows <= MOST:
        what = f"{alarms!r} alarms per {per} at {rate!r} Hz are {rows:g} rows between alarms"
        raise InputError(what, "alarms and rate", f"{LEAST:g} to {MOST:g} are possible")
    return rows


def as_arl0(value: float) -> float:
    """Rows between false alarms, as they were given.

    Raises:
        InputError: that is no number, or too few or too many.
    """
    if not (_is_number(value) and LEAST <= value <= MOST):
        remedy = f"give {LEAST:g} to {MOST:g} rows between false alarms"
        raise InputError(f"arl0 is {value!r}", "arl0", remedy)
    return float(value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)
