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
    has run back since the row before, and so do the rows that follow it.

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
    ran_back, before = False, -2
    unsure: list[int] = []
    for row in np.flatnonzero(early != late).tolist():
        if row != before + 1:
            ran_back = False
        elif not ran_back and shown[row] <= shown[row - 1]:
            ran_back = True
            unsure.clear()
            notes.append(
                f"the hour that comes twice on {local[row].date()} is told apart by the clock, "
                f"which runs back to {local[row].time()}"
            )
        if ran_back:
            early[row] = late[row]
        else:
            unsure.append(row)
        before = row
    if unsure:
        notes.append(
            f"the times from {local[unsure[0]]} on are of an hour that comes twice, and are there "
            "once: they are taken as summer time"
        )
    return early, None
