"""Moments as loggers write them: time stamps, or numbers that count from 1970."""

from datetime import UTC, datetime, timedelta, tzinfo
from zoneinfo import ZoneInfo

from rga.errors import InputError
from rga.operation.packets.packet import EPOCH

#: least size of a number of the years after 1973 in each unit, and what it is multiplied with and
#: divided by to be microseconds
PRECISIONS = ((10**17, 1, 1000), (10**14, 1, 1), (10**11, 1000, 1), (0, 1_000_000, 1))
#: years in which structures are measured live
FIRST_YEAR, LAST_YEAR = 1970, 2200
_FIRST, _LAST = (
    (datetime(year, 1, 1, tzinfo=UTC) - EPOCH) // timedelta(microseconds=1)
    for year in (FIRST_YEAR, LAST_YEAR)
)


def moment_of_stamp(stamp: str, zone: tzinfo | None, where: str) -> int:
    """Microseconds since 1970 (UTC) of a time stamp in ISO 8601.

    Args:
        stamp: as it is written.
        zone: of stamps that have none.
        where: it came from, for an error.

    Raises:
        InputError: it is no time stamp, has no zone, or its zone has it twice or never.

    >>> moment_of_stamp("1970-01-01T00:00:01+00:00", None, "a test")
    1000000
    """
    try:
        moment = datetime.fromisoformat(stamp.strip())
    except ValueError:
        raise InputError(
            f"the time {stamp[:40]!r} cannot be read", where, "write it in ISO 8601"
        ) from None
    if moment.tzinfo is None:
        moment = _in_zone(moment, zone, where)
    return checked((moment - EPOCH) // timedelta(microseconds=1), where)


def moment_of_number(number: int | float, where: str) -> int:
    """Microseconds since 1970 (UTC) of a number of s, ms, us or ns, which its size tells.

    Raises:
        InputError: it is of no year in which structures are measured.

    >>> [moment_of_number(one * 10**k, "a test") for one, k in ((1795392000, 0), (1795392000, 9))]
    [1795392000000000, 1795392000000000]
    """
    if number != number or abs(number) > 2**63:
        raise InputError(f"{number} is no time", where, "count from 1970")
    size = abs(number)
    times, parts = next((t, p) for least, t, p in PRECISIONS if size >= least)
    exact = number * times // parts if isinstance(number, int) else round(number * times / parts)
    return checked(exact, where)


def checked(moment: int, where: str) -> int:
    """The same moment, if structures can be measured then.

    Raises:
        InputError: they cannot.
    """
    if _FIRST <= moment < _LAST:
        return moment
    raise InputError(
        f"its time lies outside the years {FIRST_YEAR} to {LAST_YEAR}", where, "set its clock"
    )


def _in_zone(moment: datetime, zone: tzinfo | None, where: str) -> datetime:
    if zone is None:
        raise InputError("its times have no zone", where, "state [time] zone in import.toml")
    first, second = (moment.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
    if first.utcoffset() != second.utcoffset():
        # The offset falls where an hour comes twice, and rises where one is left out.
        twice = first.utcoffset() > second.utcoffset()  # type: ignore[operator]
        named = zone.key if isinstance(zone, ZoneInfo) else str(zone)
        raise InputError(
            f"the time {moment} {'exists twice' if twice else 'does not exist'} in {named}",
            where,
            "send times with their offset, or in UTC",
        )
    return first
