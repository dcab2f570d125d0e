"""What happens to a twin, looked at once for all who follow it."""

import asyncio
import re
import time
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from fastapi.sse import ServerSentEvent
from starlette.concurrency import run_in_threadpool

from rga.dashboard.api.past import EventAnswer
from rga.dashboard.surroundings import SeenTwin
from rga.operation.reading.twin_now import TwinNow

#: how often is looked whether something is new, however many follow [s]
LOOK = 0.2
#: steps, and changes of alarms, that are told of to who comes back; who was away for longer is to
#: load the page anew
MOST_MISSED = 1000
_PLACE = re.compile(r"([0-9]{1,15})\.([0-9]{1,15})")


@dataclass(frozen=True)
class StreamPlace:
    """Up to where somebody was told: a step of the twin, and a change of an alarm.

    >>> str(StreamPlace(12, 3)), StreamPlace.of("12.3"), StreamPlace.of("soon")
    ('12.3', StreamPlace(step=12, change=3), StreamPlace(step=-1, change=-1))
    """

    step: int
    change: int

    def __str__(self) -> str:
        return f"{self.step}.{self.change}"

    @classmethod
    def of(cls, said: str) -> "StreamPlace":
        """The place that a browser says it was told of; one before all where it is none."""
        found = _PLACE.fullmatch(said)
        return cls(-1, -1) if found is None else cls(int(found[1]), int(found[2]))


#: messages for one who was told up to a place, and the place up to which they tell
Told = tuple[list[ServerSentEvent], StreamPlace]


@dataclass(frozen=True)
class RowMessage:
    """The newest row, and how many before it were not told of by themselves.

    Attributes:
        merged: rows that have come since the last message, this one too.
        now: where the twin stands.
    """

    merged: int
    now: TwinNow


@dataclass(frozen=True)
class TwinLook:
    """A twin as it was seen at one time.

    Attributes:
        seen: the twin.
        now: where it stood; None: it had not begun.
        change: number of the newest change of an alarm, of this twin or another.
    """

    seen: SeenTwin
    now: TwinNow | None
    change: int

    @classmethod
    def at(cls, seen: SeenTwin) -> "TwinLook":
        """A look at a twin.

        Raises:
            InputError: its repository, or the file of the service, cannot be read.
        """
        return cls(seen, seen.reading.now(), seen.alarms.last())

    @property
    def place(self) -> StreamPlace:
        """Up to where this tells."""
        return StreamPlace(0 if self.now is None else self.now.steps, self.change)

    def since(self, told: StreamPlace | None) -> Told:
        """What has happened since a place; None: only what comes from now on is wanted.

        Raises:
            InputError: the repository, or the file of the service, cannot be read.
        """
        here = self.place
        if told is None:
            said = self._row(1)
        elif not (_near(told.step, here.step) and _near(told.change, here.change)):
            said = [("reload", {}), *self._row(1)]
        else:
            said = [*self._changes(told.change), *self._steps(told.step)]
        # The last alone has the place: whoever is cut off before it is told of all again.
        messages = [ServerSentEvent(event=event, data=data) for event, data in said[:-1]]
        messages += [
            ServerSentEvent(event=event, data=one, id=str(here)) for event, one in said[-1:]
        ]
        return messages, here

    def _changes(self, told: int) -> list[tuple[str, Any]]:
        """Those of alarms of this twin."""
        book = self.seen.alarms
        changes = book.transitions(told, self.change - told)
        return [("alarm", one) for one in changes if book.of(one.alarm).twin == self.seen.name]

    def _steps(self, told: int) -> list[tuple[str, Any]]:
        view = self.seen.reading.view()
        if self.now is None or view is None or told == self.now.steps:
            return []
        before, said = view.at_step(told), list[tuple[str, Any]]()
        for one in view.at_step(self.now.steps).events(after=told):
            time = datetime.fromisoformat(str(one.time))
            event = EventAnswer(one.kind, one.row, time, one.words, list(one.sensors))
            said.append(("event", event))
        open_ = self.now.undecided
        if open_ is not None and open_.number > len(before.proposals()):
            said.append(("proposal", {"number": open_.number, "words": open_.words}))
        return [*said, *self._row(self.now.rows - before.rows)]

    def _row(self, merged: int) -> list[tuple[str, Any]]:
        return [] if self.now is None else [("row", RowMessage(merged, self.now))]


class FollowedTwin:
    """A twin that any number of streams follow: one look serves them all.

    Args:
        seen: the twin.
    """

    def __init__(self, seen: SeenTwin) -> None:
        self._seen, self._lock = seen, asyncio.Lock()
        self._look: TwinLook | None = None
        self._looked = 0.0
        # Those who follow were told up to the same place, but for who has just come.
        self._last: tuple[StreamPlace | None, Told] | None = None

    async def since(self, told: StreamPlace | None) -> Told:
        """What has happened since a place, as it was seen LOOK ago at the most.

        Raises:
            InputError: the repository, or the file of the service, cannot be read.
        """
        async with self._lock:
            look = await self._seen_lately()
            if told == look.place:
                return [], look.place
            if self._last is None or self._last[0] != told:
                self._last = told, await run_in_threadpool(look.since, told)
            return self._last[1]

    async def _seen_lately(self) -> TwinLook:
        now = time.monotonic()
        if self._look is None or now - self._looked >= LOOK:
            look = await run_in_threadpool(TwinLook.at, self._seen)
            if self._look is None or look.place != self._look.place:
                self._look, self._last = look, None
            self._looked = now
        return self._look


def _near(told: int, here: int) -> bool:
    return max(0, here - MOST_MISSED) <= told <= here
