"""What happens to a twin, as it happens: events that a server sends (SSE)."""

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from anyio import BrokenResourceError
from fastapi import APIRouter, Depends, Header, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent

from rga.dashboard.access.may import may
from rga.dashboard.api.following import FollowedTwin, StreamPlace
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.served import PREFIX, TheTwin, told_as_json

#: how long a stream rests before it asks for what is new [s]
REST = 0.1
router = APIRouter(prefix=PREFIX, tags=["stream"], route_class=KnownQueryRoute)


async def _ends_as_one_leaves() -> AsyncIterator[None]:
    """A dependency of a stream: whoever leaves while something is sent to them ends it."""
    try:
        yield
    except* BrokenResourceError:
        pass  # what is sent has nowhere to go any more, and nothing else has gone wrong


@router.get(
    "/twins/{twin}/stream",
    response_class=EventSourceResponse,
    responses=told_as_json(400, 401, 403, 404, 422, 503),
    dependencies=[Depends(may("viewer")), Depends(_ends_as_one_leaves)],
)
async def stream(
    seen: TheTwin,
    request: Request,
    last_event_id: Annotated[str | None, Header()] = None,
) -> AsyncIterator[ServerSentEvent]:
    """Messages `event`, `proposal`, `alarm` and `row`; after `reload` read anew what was missed.

    Ids of messages are places, such as `12.3`: a step of the twin, and a change of an alarm. With
    `Last-Event-ID` the stream goes on behind its place.
    """
    followed: FollowedTwin = request.app.state.followed[seen.name]
    told = None if last_event_id is None else StreamPlace.of(last_event_id)
    # Whoever reads slowly holds this up, and is told of the rows meanwhile by one message.
    while not request.app.state.is_ending():
        messages, told = await followed.since(told)
        for one in messages:
            yield one
        await asyncio.sleep(REST)
