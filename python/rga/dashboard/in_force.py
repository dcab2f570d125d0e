"""When which version of the model was in force, and who put it there."""

from collections import defaultdict
from dataclasses import dataclass
from datetime import datetime

from rga.operation.reading.twin_now import moment
from rga.twin.repository import RunView, StoredCommand

#: commands that put a version in force
PUTS = ("accept", "rollback")


@dataclass(frozen=True)
class InForce:
    """A stretch of time in which a version was in force.

    Attributes:
        version: its number.
        begin: time of the row at which it came into force, which is none of its own, but where it
            is the first [s since the first row].
        end: time of the last of its rows; None: it is in force still.
        asked: by which somebody put it in force; None: nobody did, it came about.
    """

    version: int
    begin: float
    end: float | None
    asked: StoredCommand | None

    def until(self, last: float) -> float:
        """Its end, which is the last row of the run where it is in force still."""
        return last if self.end is None else min(self.end, last)


@dataclass(frozen=True)
class SpanInForce:
    """From when to when a version was in force.

    Attributes:
        begin: time of the newest row when it came into force.
        end: time of the last of its rows; None: it is in force still.
        by: "accept" or "rollback", which put it in force; None: nobody asked for it.
        who: asked for that.
        why: as they gave it.
        at: when they asked, by the clock of the service.
    """

    begin: datetime
    end: datetime | None
    by: str | None = None
    who: str | None = None
    why: str | None = None
    at: datetime | None = None


def in_force(view: RunView) -> list[InForce]:
    """The stretches of versions that were in force, in their order."""
    begun = _begun(view)
    ends = [*(begin for _, begin, _ in begun[1:]), None]
    return [
        InForce(version, begin, end, asked)
        for (version, begin, asked), end in zip(begun, ends, strict=True)
    ]


def spans_in_force(view: RunView, start: str | float) -> dict[int, list[SpanInForce]]:
    """From when to when each version was in force, in order; of one that never was, nothing.

    Args:
        view: a run.
        start: time of its first row.
    """
    found: defaultdict[int, list[SpanInForce]] = defaultdict(list)
    for one in in_force(view):
        begin, end = moment(start, one.begin), None if one.end is None else moment(start, one.end)
        span = SpanInForce(begin, end)
        if one.asked is not None:
            at = datetime.fromisoformat(one.asked.given_at)
            span = SpanInForce(begin, end, one.asked.kind, one.asked.who, one.asked.why, at)
        found[one.version].append(span)
    return found


def _begun(view: RunView) -> list[tuple[int, float, StoredCommand | None]]:
    """Versions, from when on each was in force, and who asked for it, in their order."""
    asked = [one for one in view.commands() if one.kind in PUTS and "refused" not in one.body]
    found: list[tuple[int, float, StoredCommand | None]] = []
    for row, version in view.in_force():
        if found and found[-1][0] == version:
            continue
        time = view.measured(row, row + 1).time
        begin = float(time[0]) if row and len(time) else 0.0
        found.append((version, begin, _taken(asked, row, version)))
    return found


def _taken(asked: list[StoredCommand], row: int, version: int) -> StoredCommand | None:
    """The first command at a row that can have put a version in force; it is taken out."""
    for place, one in enumerate(asked):
        if one.row == row and one.body.get("version", version) == version:
            return asked.pop(place)
    return None
