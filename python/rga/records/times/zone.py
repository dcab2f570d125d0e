"""Time stamps without a zone, in the zone that is stated: the hour that repeats told apart."""

import re
from datetime import timedelta, timezone, tzinfo
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np
import polars as pl
from numpy.typing import NDArray

from rga.errors import InputError

_OFFSET = re.compile(r"(?:UTC|GMT)?([+-])(\d{1,2}):?(\d{2})?")


def zone_of(text: str, where: str) -> tzinfo:
    """The zone of a name or of hours ahead of UTC.

    >>> zone_of("+01:00", "r.csv"), zone_of("Europe/Berlin", "r.csv")
    (datetime.timezone(datetime.timedelta(seconds=3600)), zoneinfo.ZoneInfo(key='Europe/Berlin'))
    >>> zone_of("UTC+1", "r.csv") == zone_of("+0100", "r.csv") == zone_of("+01:00", "r.csv")
    True

    Raises:
        InputError: there is no such zone.
    """
    if found := _OFFSET.fullmatch(text.strip()):
        ahead = timedelta(hours=int(found[2]), minutes=int(found[3] or 0))
        if ahead < timedelta(hours=24):
            return timezone(ahead if found[1] == "+" else -ahead)
    try:
        return ZoneInfo(text.strip())
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise InputError(
            f"there is no time zone {text!r}", where, 'give one like "Europe/Berlin" or "+01:00"'
        ) from None


def in_zone(
    moments: pl.Series, zone: tzinfo, notes: list[str]
) -> tuple[NDArray[np.int64], int | None]:
    """Moments of a zone as microseconds since 1970 (UTC), int[n], in the order of their rows.

    Of the hour that comes twice when summer time ends, a row belongs to the second where the clock
    has run back since the row before, and so do the rows that follow it. Rows that are there once
    are taken as summer time, unless standard time leaves fewer gaps at either end of them: a file
    may begin in the second hour.

    Args:
        moments: datetimes without a zone.
        zone: in which they were written.
        notes: takes up what the reader should know of them, in words.

    Returns:
        The moments, and the first row whose hour the zone leaves out, if there is one.

    >>> from datetime import datetime
    >>> night = pl.Series([datetime(2023, 10, 29, *at) for at in ((2, 0), (2, 30), (2, 0))])
    >>> said = []
    >>> stamps, gap = in_zone(night, ZoneInfo("Europe/Berlin"), said)
    >>> (stamps - stamps[0]) // 60_000_000, said
    (array([ 0, 30, 60]), ['the hour that comes twice on 2023-10-29 is told apart by the clock, \
which runs back to 02:00:00'])
    """
    local = moments.cast(pl.Datetime("us"))
    if not isinstance(zone, ZoneInfo):
        ahead = zone.utcoffset(None) or timedelta()
        return local.to_physical().to_numpy() - ahead // timedelta(microseconds=1), None
    first, second = (
        local.dt.replace_time_zone(zone.key, ambiguous=which, non_existent="null")
        for which in ("earliest", "latest")
    )
    if first.has_nulls():
        return np.zeros(0, dtype=np.int64), int(first.is_null().arg_true()[0])
    early, late = (one.to_physical().to_numpy().copy() for one in (first, second))
    shown = local.to_physical().to_numpy()
    steps = np.diff(shown)
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
    twice = np.flatnonzero(early != late)
    for rows in np.split(twice, np.flatnonzero(np.diff(twice) > 1) + 1):
        if len(rows) == 0:
            continue
        night = local[int(rows[0])].date()
        back = np.flatnonzero(np.diff(shown[rows]) <= 0)
        if len(back):
            rows = rows[back[0] + 1 :]
            early[rows] = late[rows]
            notes.append(
                f"the hour that comes twice on {night} is told apart by the clock, which runs back "
                f"to {local[int(rows[0])].time()}"
            )
            continue
        summer, standard = (_gaps(one, rows, early, usual) for one in (early, late))
        if standard < summer:
            early[rows] = late[rows]
        notes.append(
            f"the times from {local[int(rows[0])]} on are of an hour that comes twice, and are "
            "there once: they are taken as "
            + ("standard time, which leaves fewer gaps" if standard < summer else "summer time")
        )
    return early, None


def first_repeated(moments: pl.Series, zone: tzinfo) -> int | None:
    """The first row of an hour that comes twice in a zone; None: there is none.

    >>> from datetime import datetime
    >>> night = pl.Series([datetime(2023, 10, 29, hour) for hour in (1, 2, 3)])
    >>> first_repeated(night, ZoneInfo("Europe/Berlin"))
    1
    """
    if not isinstance(zone, ZoneInfo):
        return None
    local = moments.cast(pl.Datetime("us"))
    first, second = (
        local.dt.replace_time_zone(zone.key, ambiguous=which, non_existent="null")
        for which in ("earliest", "latest")
    )
    twice = (first != second).fill_null(False)
    return int(twice.arg_true()[0]) if twice.any() else None


def _gaps(
    read: NDArray[np.int64], rows: NDArray[np.intp], others: NDArray[np.int64], usual: float
) -> int:
    """How many gaps are at the ends of rows in one reading: steps beyond the usual one."""
    first, last = int(rows[0]), int(rows[-1])
    before = first > 0 and read[first] - others[first - 1] > 1.5 * usual
    after = last + 1 < len(read) and others[last + 1] - read[last] > 1.5 * usual
    return int(before) + int(after)
