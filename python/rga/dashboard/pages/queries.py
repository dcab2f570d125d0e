"""Queries and responses in words, with what was written into the log beside them."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from rga.dashboard.pages.heading import heading
from rga.dashboard.pages.windows import asked_choice, asked_moment
from rga.dashboard.surroundings import SeenTwin
from rga.operation.reading.twin_now import moment
from rga.twin.history import Event
from rga.twin.messages.log_text import exchanges, kinds_of, row_of, words_of
from rga.twin.restore import story_of

#: what can be chosen, with its words
KINDS = {
    "": "all",
    "Q1": "Q1 R1, can the twin represent this?",
    "Q2": "Q2 R2, are simulations held?",
    "Q3": "Q3 R3, simulate these",
    "Q4": "Q4 R4, the data set to learn from",
    "Q5": "Q5 R5, contexts and what is simulated there",
    "event": "events",
}
#: lines of a page, rows of the record that are looked through for it
LINES, ROWS = 100, 5_000
#: letters of JSON that a line shows
LONGEST = 4_000


@dataclass(frozen=True)
class LogLine:
    """An exchange of query and response, or an event.

    Attributes:
        row, time: at which it passed.
        kinds: of query and response, or of the event.
        words: what passed.
        content: as it stands in the log, JSON text; empty for an event.
    """

    row: int
    time: datetime
    kinds: str
    words: str
    content: str


def queries_page(seen: SeenTwin, query: Mapping[str, str]) -> dict[str, Any]:
    """What the page of queries shows: the latest lines up to a time.

    Args:
        seen: the twin.
        query: of the address: `kind`, and `until` as a time.

    Raises:
        InputError: the repository of the twin cannot be read.
        NotUnderstood: there is no such kind or time.
    """
    now, view, twin = seen.reading.now(), seen.reading.view(), seen.reading.twin
    kind, until = asked_choice(query, "kind", KINDS, ""), asked_moment(query, "until")
    found: dict[str, Any] = {
        "heading": heading(seen, now),
        "tab": "/queries",
        "kinds": KINDS,
        "kind": kind,
        "until": until,
        "lines": [],
        "earlier": None,
    }
    if view is None or twin is None:
        return found
    last = view.rows if until is None else view.row_at(seen.reading.elapsed(until)) + 1
    first = max(0, last - ROWS)
    lines = []
    for one in exchanges(story_of(view, first, max(last, 1))):
        is_event = isinstance(one, Event)
        if kind and (kind == "event") != is_event:
            continue
        if kind and not is_event and not kinds_of(one).startswith(kind):
            continue
        row = row_of(one)
        time = view.measured(row, row + 1).time
        lines.append(
            LogLine(
                row,
                moment(twin.station.start, float(time[0]) if len(time) else 0.0),
                kinds_of(one),
                words_of(one),
                "" if isinstance(one, Event) else _content(one),
            )
        )
    shown = lines[::-1][:LINES]
    more = shown and (len(lines) > LINES or first > 0)
    return found | {"lines": shown, "earlier": shown[-1].time if more else None}


def _content(exchange: Any) -> str:
    """What the log has of an exchange; of packets in a row that of the first."""
    said = [one.model_dump(mode="json") for one in exchange[0]]
    text = json.dumps(said, indent=1, ensure_ascii=False)
    return text if len(text) <= LONGEST else text[:LONGEST] + " …"
