"""The stretch of time that somebody looks at."""

from collections.abc import Mapping
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


def asked_span(query: Mapping[str, str]) -> str:
    """The name of the stretch that an address asks for.

    >>> asked_span({"span": "day"}), asked_span({"span": "century"}), asked_span({})
    ('day', 'week', 'week')
    """
    span = query.get("span", USUAL)
    return span if span in SPANS else USUAL


def chosen_window(query: Mapping[str, str], start: datetime, until: datetime) -> ChosenWindow:
    """The stretch that an address asks for: `span`, or `from` and `to`.

    Args:
        query: of the address.
        start: time of the first row of all.
        until: time of the last one that is to be seen.
    """
    last = max((until - start).total_seconds(), SHORTEST)
    first, end = (given_moment(query.get(name, "")) for name in ("from", "to"))
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
