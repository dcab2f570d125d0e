"""What happened to a twin, as marks over time and as lines of a list."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from urllib.parse import quote

from rga.dashboard.pages.times import of_event
from rga.dashboard.svg.chart import Mark, Window
from rga.twin.history import Event

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
MARKED = ("alarm", "proposal", "version", "rollback", "recalibration", "recall", "calibration")


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


def happened(twin: str, events: Iterable[Event]) -> list[Happened]:
    """Events of a twin, the latest first."""
    found = [
        Happened(
            of_event(one.time),
            one.kind,
            SIGNS.get(one.kind, "•"),
            one.words,
            one.sensors,
            as_of(twin, of_event(one.time)),
        )
        for one in events
    ]
    return found[::-1]


def marks(twin: str, events: Iterable[Event], window: Window) -> list[Mark]:
    """Events that are marked over time."""
    found = []
    for one in events:
        if one.kind in MARKED:
            time = of_event(one.time)
            at = window.share((time - window.start).total_seconds())
            found.append(Mark(round(at, 2), one.kind, f"{one.kind}: {one.words}", as_of(twin, time)))
    return found


def as_of(twin: str, time: datetime) -> str:
    """Address of a twin as it stood at a time."""
    return f"/twins/{quote(twin)}?at={quote(time.isoformat())}"
