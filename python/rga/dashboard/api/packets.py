"""What loggers send: kept on the disk before it is answered."""

from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Annotated

from fastapi import APIRouter, Depends, HTTPException, Request
from starlette.concurrency import run_in_threadpool

from rga.dashboard.access.may import may
from rga.dashboard.access.roles import Who
from rga.dashboard.api.bounds import IntakeRoom, RateLimit
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, TheTwin, answering
from rga.errors import InputError
from rga.operation.packets.formats import TYPES, format_of_type
from rga.operation.packets.packet import MOST_BYTES
from rga.twin.repository.faults import DiskFull

#: how long a sender waits where nothing can be written [s]
AGAIN = 5
#: what a payload may be called; where that names no format, what it is is seen from itself. The
#: last is what senders say that were told nothing.
CONTENT_TYPES = (
    "application/json",
    "application/octet-stream",
    "text/plain",
    *TYPES,
    "application/x-www-form-urlencoded",
)
router = APIRouter(prefix=PREFIX, tags=["packets"], route_class=KnownQueryRoute)
_BODY = {
    "requestBody": {
        "required": True,
        "description": f"A packet, as `rga schema packet` says, of {MOST_BYTES} bytes at most.",
        "content": {name: {} for name in CONTENT_TYPES},
    }
}


@dataclass(frozen=True)
class PacketAnswer:
    """What became of a packet.

    Attributes:
        stored, late, duplicate: 1 for what it was, 0 for the others.
        refused: why it cannot be used; it is kept aside.
    """

    stored: int
    duplicate: int
    late: int
    refused: list[str]


def caller(request: Request, seen: TheTwin, who: Annotated[Who, Depends(may("ingest"))]) -> str:
    """Name of whoever sends, if it may send now, and such a thing.

    Raises:
        HTTPException: it may not.
    """
    kind = request.headers.get("content-type", CONTENT_TYPES[0]).partition(";")[0].strip()
    if kind.casefold() not in CONTENT_TYPES:
        known = ", ".join(CONTENT_TYPES)
        raise HTTPException(415, f"{kind!r} cannot be read: send one of {known}")
    if "content-encoding" in request.headers:
        raise HTTPException(415, "send it as it is, without a content encoding")
    limit: RateLimit = request.app.state.rate_limit
    room: IntakeRoom = request.app.state.room
    if wait := limit.wait_of(who.name):
        raise HTTPException(429, "too many at once", {"Retry-After": str(ceil(wait))})
    if lacking := room.lacking(seen):
        raise HTTPException(429, lacking, {"Retry-After": str(AGAIN)})
    return who.name


@router.post(
    "/twins/{twin}/packets",
    responses=OF_A_TWIN | answering(408, 413, 415, 429, 507),
    openapi_extra=_BODY,
    dependencies=[Depends(caller)],
)
async def packets(seen: TheTwin, request: Request) -> PacketAnswer:
    """Take a packet in; the answer comes when it is on the disk."""
    source = seen.served.http_source
    if source is None:
        raise HTTPException(404, f"twin {seen.name!r} has no source of kind http")
    payload, kind = await request.body(), format_of_type(request.headers.get("content-type"))
    receive = partial(seen.served.receive, source, [("http", payload)], kind=kind)
    try:
        fates = await run_in_threadpool(receive)
    except DiskFull as error:
        raise HTTPException(507, str(error), {"Retry-After": str(AGAIN)}) from None
    except InputError as error:
        raise HTTPException(503, str(error), {"Retry-After": str(AGAIN)}) from None
    (fate, reason), *_ = fates
    return PacketAnswer(
        stored=int(fate == "waiting"),
        duplicate=int(fate == "duplicate"),
        late=int(fate == "late"),
        refused=[reason or ""] if fate == "refused" else [],
    )
