"""What an address of a page asks for: the stretch of time that somebody looks at."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime

from rga.dashboard.pages.times import DAY, given_moment
from rga.dashboard.svg.chart import Window

#: stretches that can be chosen, by name [s]; None: all that there is
SPANS: dict[str, float | None] = {
    "day": DAY,
    "week": 7 * DAY,
    "month": 30 * DAY,
    "year": 365 * DAY,
    "all": None,
}
USUAL = "week"
#: of a twin that has hardly begun [s]
SHORTEST = 3600.0


@dataclass(frozen=True)
class ChosenWindow:
    """A stretch of time, and how it was chosen.

    Attributes:
        window: the stretch.
        span: its name in `SPANS`; empty: from and to were given.
    """

    window: Window
    span: str


class NotUnderstood(ValueError):
    """An address asks for what there is not."""


def asked_choice(query: Mapping[str, str], key: str, known: Collection[str], usual: str) -> str:
    """Which of several an address asks for.

    Raises:
        NotUnderstood: it is none of them.

    >>> asked_choice({"span": "day"}, "span", SPANS, USUAL), asked_choice({}, "span", SPANS, USUAL)
    ('day', 'week')
    """
    found = query.get(key, usual)
    if found not in known:
        told = ", ".join(one for one in known if one)
        raise NotUnderstood(f"{key}: there is no {found[:100]!r}: known are {told}")
    return found


def asked_moment(query: Mapping[str, str], key: str) -> datetime | None:
    """The time that an address asks for; None: it asks for none.

    Raises:
        NotUnderstood: what it asks for is none.
    """
    text = query.get(key, "")
    found = given_moment(text)
    if text and found is None:
        raise NotUnderstood(f"{key}: {text[:100]!r} is no time: write 2026-01-31T05:30, in UTC")
    return found


def asked_span(query: Mapping[str, str]) -> str:
    """The name of the stretch that an address asks for.

    Raises:
        NotUnderstood: there is none of this name.
    """
    return asked_choice(query, "span", SPANS, USUAL)


def chosen_window(query: Mapping[str, str], start: datetime, until: datetime) -> ChosenWindow:
    """The stretch that an address asks for: `span`, or `from` and `to`.

    Args:
        query: of the address.
        start: time of the first row of all.
        until: time of the last one that is to be seen.

    Raises:
        NotUnderstood: there is no such stretch.
    """
    last = max((until - start).total_seconds(), SHORTEST)
    first, end = (asked_moment(query, name) for name in ("from", "to"))
    if first is not None and end is not None and end <= first:
        raise NotUnderstood("to: it is not after from")
    if first is not None or end is not None:
        begin = 0.0 if first is None else (first - start).total_seconds()
        stop = last if end is None else (end - start).total_seconds()
        if stop > begin:
            return ChosenWindow(Window(start, begin, stop), "")
    span = asked_span(query)
    length = SPANS[span]
    begin = 0.0 if length is None else max(0.0, last - length)
    # A hair beyond the end: the last row is seen too.
    return ChosenWindow(Window(start, begin, last + (last - begin) / 200), span)
