"""Times as pages say and take them: in UTC; the browser adds those of its own zone."""

import re
from datetime import UTC, datetime

DAY = 86_400.0
_WRITTEN = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d:\d\d(?:\.\d+)?(?:\+00:00|Z)")
_UNITS = ((2 * DAY, DAY, "days"), (7200.0, 3600.0, "h"), (120.0, 60.0, "min"), (0.0, 1.0, "s"))


def span_words(seconds: float) -> str:
    """A length of time as people say it.

    >>> span_words(42.0), span_words(400.0), span_words(3 * 86_400.0)
    ('42\\xa0s', '6\\xa0min', '3\\xa0days')
    """
    for least, size, unit in _UNITS:
        if seconds >= least:
            return f"{int(seconds / size)}\u00a0{unit}"
    return "0\u00a0s"


def age_words(moment: datetime, now: datetime) -> str:
    """How long ago something was.

    >>> age_words(datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 1, 1, 5, tzinfo=UTC))
    '5\\xa0h ago'
    """
    seconds = (now - moment).total_seconds()
    return f"{span_words(seconds)} ago" if seconds >= 0 else f"in {span_words(-seconds)}"


def utc_words(moment: datetime) -> str:
    """A time to the minute, or to the second where it has some.

    >>> utc_words(datetime(2026, 1, 1, 5, 30, tzinfo=UTC))
    '2026-01-01 05:30'
    """
    there = moment.astimezone(UTC)
    return f"{there:%Y-%m-%d %H:%M:%S}" if there.second else f"{there:%Y-%m-%d %H:%M}"


def plain_times(text: str) -> str:
    """A text with its times in UTC as people write them.

    >>> plain_times("from 2026-11-27T01:50:00+00:00 on, or 2026-11-27 01:50:30Z")
    'from 2026-11-27 01:50 UTC on, or 2026-11-27 01:50:30 UTC'
    """
    return _WRITTEN.sub(lambda found: f"{utc_words(datetime.fromisoformat(found[0]))} UTC", text)


def given_moment(text: str) -> datetime | None:
    """A time that a form or an address gives, in UTC unless it says otherwise; None: it is none.

    >>> given_moment("2026-01-01T05:30").isoformat(), given_moment("soon")
    ('2026-01-01T05:30:00+00:00', None)
    >>> given_moment("9999-12-31T23:59:59-12:00") is None
    True
    """
    try:
        found = datetime.fromisoformat(text)
        return found.replace(tzinfo=UTC) if found.tzinfo is None else found.astimezone(UTC)
    except (ValueError, OverflowError):
        return None


def of_event(time: str | float) -> datetime:
    """The time of something that happened to a twin that is served: its rows are in UTC."""
    return datetime.fromisoformat(str(time)).astimezone(UTC)
