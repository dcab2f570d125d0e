"""The HTTP door of a service."""

from dataclasses import asdict
from typing import Any

from fastapi import Depends, FastAPI, HTTPException, Request
from starlette.concurrency import run_in_threadpool
from starlette.staticfiles import StaticFiles

from rga.dashboard.access.access import Access
from rga.dashboard.access.guard import Guard
from rga.dashboard.access.login import router as login
from rga.dashboard.access.login import to_login
from rga.dashboard.access.may import NotLoggedIn, may
from rga.dashboard.pages.routes import pages_of
from rga.errors import InputError
from rga.operation.inbox.account import Account
from rga.operation.packets.packet import MOST_BYTES
from rga.operation.served_twin import ServedTwin
from rga.operation.service import Service

#: how long a sender waits where nothing can be written [s]
AGAIN = 5


def app_of(service: Service) -> FastAPI:
    """The API and the pages of a service.

    Args:
        service: that runs.

    Raises:
        InputError: anybody could come in.
    """
    app = FastAPI(title="rga", docs_url=None, redoc_url=None, openapi_url="/api/v1/openapi.json")
    app.state.access = Access(service.configuration.service)
    app.add_middleware(Guard, access=app.state.access)
    app.add_exception_handler(NotLoggedIn, to_login)
    app.include_router(login)
    app.include_router(pages_of(service))
    app.mount("/static", StaticFiles(packages=[("rga.dashboard", "static")]), name="static")

    def twin_of(name: str) -> ServedTwin:
        if name not in service.twins:
            raise HTTPException(404, f"there is no twin {name!r}")
        return service.twins[name]

    @app.get("/healthz")
    def health() -> dict[str, str]:
        return {"state": "up"}

    @app.post("/api/v1/twins/{twin}/packets", dependencies=[Depends(may("ingest"))])
    async def packets(twin: str, request: Request) -> dict[str, Any]:
        """Take a packet in; the answer comes when it is on the disk."""
        served = twin_of(twin)
        source = served.http_source
        if source is None:
            raise HTTPException(404, f"twin {twin!r} has no source of kind http")
        payload = await _body(request)
        try:
            fates = await run_in_threadpool(served.receive, source, [("http", payload)])
        except InputError as error:
            raise HTTPException(503, str(error), {"Retry-After": str(AGAIN)}) from None
        (fate, reason), *_ = fates
        told: dict[str, Any] = {"stored": 0, "duplicate": 0, "late": 0, "refused": []}
        if fate == "refused":
            told["refused"].append(reason)
        else:
            told["stored" if fate == "waiting" else fate] = 1
        return told

    @app.get("/api/v1/twins/{twin}/account", dependencies=[Depends(may("viewer"))])
    def account(twin: str) -> dict[str, Any]:
        """What became of every packet, by source."""
        served = twin_of(twin)
        sources: dict[str, Account] = {}
        for (source, _), one in served.packets.account().items():
            sources[source] = sources.get(source, Account()) + one
        return {
            name: asdict(one)
            | {"difference": one.difference}
            | {
                "streams": {
                    stream: {"next": known.next, "missing": known.gaps}
                    for stream, known in served.numbers(name).items()
                }
            }
            for name, one in sources.items()
        }

    return app


async def _body(request: Request) -> bytes:
    """What was sent, of no more bytes than a packet has."""
    payload = bytearray()
    async for part in request.stream():
        payload += part
        if len(payload) > MOST_BYTES:
            raise HTTPException(413, f"a packet has {MOST_BYTES} bytes at most")
    return bytes(payload)
