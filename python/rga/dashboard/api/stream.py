"""What happens to a twin, as it happens: events that a server sends (SSE)."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool

from rga.dashboard.access.may import may
from rga.dashboard.api.past import EventAnswer
from rga.dashboard.api.served import TheTwin, told_as_json
from rga.dashboard.surroundings import SeenTwin
from rga.operation.reading.twin_now import TwinNow

#: how often is looked whether something is new [s]
LOOK = 0.5
#: steps that are told of to who comes back; who was away for longer is to load the page anew
MOST_STEPS = 1000
router = APIRouter(tags=["stream"])


@dataclass(frozen=True)
class RowMessage:
    """The newest row, and how many before it were not told of by themselves.

    Attributes:
        merged: rows that have come since the last message, this one too.
        now: where the twin stands.
    """

    merged: int
    now: TwinNow


@router.get(
    "/twins/{twin}/stream",
    response_class=EventSourceResponse,
    responses=told_as_json(400, 401, 403, 404, 422, 503),
    dependencies=[Depends(may("viewer"))],
)
async def stream(
    seen: TheTwin,
    request: Request,
    last_event_id: Annotated[str | None, Header()] = None,
) -> AsyncIterator[ServerSentEvent]:
    """Messages `event`, `proposal` and `row`; after `reload` what was missed is to be read anew.

    Numbers of messages are those of steps. With `Last-Event-ID` the stream goes on behind it.
    """
    told = _number(last_event_id)
    # Whoever reads slowly holds this up, and is told of the rows meanwhile by one message.
    while not request.app.state.is_ending():
        messages, told = await run_in_threadpool(_messages, seen, told)
        for one in messages:
            yield one
        await asyncio.sleep(LOOK)


def _number(last_event_id: str | None) -> int | None:
    """Step of a `Last-Event-ID`; -1 where it is none."""
    if last_event_id is None:
        return None
    plain = last_event_id.isascii() and last_event_id.isdigit() and len(last_event_id) < 16
    return int(last_event_id) if plain else -1


def _messages(seen: SeenTwin, told: int | None) -> tuple[list[ServerSentEvent], int | None]:
    """What has happened since a step, and the step up to which it is told of.

    Args:
        seen: the twin.
        told: the step; None: only what comes from now on is wanted.
    """
    now, view = seen.reading.now(), seen.reading.view()
    if now is None or view is None or now.steps == told:
        return [], told
    if told is None:
        return [_row(now, 1)], now.steps
    if not max(0, now.steps - MOST_STEPS) <= told <= now.steps:
        return [ServerSentEvent(event="reload", data={}, id=str(now.steps)), _row(now, 1)], (
            now.steps
        )
    before = view.at_step(told)
    messages: list[ServerSentEvent] = []
    for one in view.at_step(now.steps).events(after=told):
        time = datetime.fromisoformat(str(one.time))
        event = EventAnswer(one.kind, one.row, time, one.words, list(one.sensors))
        messages.append(ServerSentEvent(event="event", data=event))
    if now.undecided is not None and now.undecided.number > len(before.proposals()):
        messages.append(ServerSentEvent(event="proposal", data=_proposal(now)))
    # The last alone has the number: whoever is cut off before it is told of all again.
    return [*messages, _row(now, now.rows - before.rows)], now.steps


def _row(now: TwinNow, merged: int) -> ServerSentEvent:
    return ServerSentEvent(event="row", data=RowMessage(merged, now), id=str(now.steps))


def _proposal(now: TwinNow) -> dict[str, Any]:
    assert now.undecided is not None
    return {"number": now.undecided.number, "words": now.undecided.words}
