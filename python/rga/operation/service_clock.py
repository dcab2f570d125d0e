"""The clocks of a service: one that people read, and one that nobody sets."""

import time
from datetime import UTC, datetime, timedelta

from rga.operation.packets.packet import EPOCH


class ServiceClock:
    """What time it is.

    Durations go by the monotonic clock, so that a clock that is set raises no alarm. Tests have a
    clock of their own.
    """

    def now(self) -> datetime:
        """The time in UTC."""
        return datetime.now(UTC)

    def monotonic(self) -> float:
        """Seconds since some moment, that nobody sets."""
        return time.monotonic()


def microseconds(moment: datetime) -> int:
    """A moment as it is kept: microseconds since 1970 (UTC).

    >>> microseconds(datetime(1970, 1, 1, 0, 0, 2, tzinfo=UTC))
    2000000
    """
    return (moment - EPOCH) // timedelta(microseconds=1)


def moment_of(since_1970: int) -> datetime:
    """The moment that so many microseconds since 1970 (UTC) are.

    >>> moment_of(2_000_000).isoformat()
    '1970-01-01T00:00:02+00:00'
    """
    return EPOCH + timedelta(microseconds=since_1970)


def in_minutes(moment: datetime) -> str:
    """A moment as people read it.

    >>> in_minutes(datetime(2026, 11, 27, 7, 5, 59, tzinfo=UTC))
    '2026-11-27 07:05 UTC'
    """
    return f"{moment.astimezone(UTC):%Y-%m-%d %H:%M} UTC"
