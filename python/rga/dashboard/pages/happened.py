"""What happened to a twin, as marks over time and as lines of a list."""

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from urllib.parse import quote

from rga.dashboard.pages.times import of_event
from rga.dashboard.svg.chart import ChartMark, Window
from rga.twin.history import Event
from rga.twin.repository import RunView

#: kinds of events that are marked over time, with the shape and the word of each
SIGNS = {
    "alarm": "▲",
    "proposal": "◆",
    "version": "■",
    "rollback": "↺",
    "recalibration": "●",
    "recall": "●",
    "calibration": "●",
    "diagnosis": "?",
    "command": "✎",
    "novel context": "+",
}
#: those that are marked over time, the weightiest first, and how many marks there are at most
MARKED = ("alarm", "proposal", "version", "rollback", "recalibration", "recall", "calibration")
MOST_MARKS = 40


@dataclass(frozen=True)
class Happened:
    """Something that happened.

    Attributes:
        time: when.
        kind: what, in a word; sign: its shape.
        words: in a sentence.
        sensors: that it is about.
        href: the twin as it stood then.
    """

    time: datetime
    kind: str
    sign: str
    words: str
    sensors: tuple[str, ...]
    href: str


class Past:
    """Events of a twin, with addresses of the twin as it stood once it had seen them.

    Args:
        twin: name of it.
        view: its run; None: nothing has happened to it.
        events: in the order in which they happened.
        keeps: of the address of whoever looks, what its addresses keep, such as "span=day&".
    """

    def __init__(
        self, twin: str, view: RunView | None, events: Sequence[Event], keeps: str = ""
    ) -> None:
        self._twin, self._keeps = twin, keeps
        self._seen = {} if view is None else _seen_from(view, {one.row for one in events})

    def listed(self, events: Iterable[Event]) -> list[Happened]:
        """Some of the events, the latest first."""
        found = [
            Happened(
                of_event(one.time),
                one.kind,
                SIGNS.get(one.kind, "•"),
                one.words,
                one.sensors,
                self._as_of(one),
            )
            for one in events
        ]
        return found[::-1]

    def marks(self, events: Iterable[Event], window: Window) -> list[ChartMark]:
        """Those of some events that are marked over time; at one place the weightiest."""
        places: dict[int, list[Event]] = {}
        for one in events:
            if one.kind in MARKED:
                places.setdefault(round(_share(one, window)), []).append(one)
        found = []
        for here in list(places.values())[-MOST_MARKS:]:
            first = min(here, key=lambda one: MARKED.index(one.kind))
            words = "; ".join(f"{one.kind}: {one.words}" for one in here)
            at = round(_share(first, window), 2)
            found.append(ChartMark(at, first.kind, words, self._as_of(first)))
        return found

    def _as_of(self, event: Event) -> str:
        return f"/twins/{quote(self._twin)}?{self._keeps}at={self._seen.get(event.row, 0.0):.3f}"


def _share(event: Event, window: Window) -> float:
    return window.share((of_event(event.time) - window.start).total_seconds())


def _seen_from(view: RunView, rows: set[int]) -> dict[int, float]:
    """From when on each row is seen [s since the first row]: a packet is seen as a whole."""
    if not rows:
        return {}
    packets = view.packets_about(list(rows))
    firsts = [first for first, _ in packets]
    last = {}
    for row in rows:
        place = bisect_right(firsts, row) - 1
        last[row] = packets[place][1] - 1 if place >= 0 else row
    known = view.measured_at(list(last.values()))
    time = dict(zip(known.rows.tolist(), known.time.tolist(), strict=True))
    return {row: time[end] for row, end in last.items() if end in time}
