"""Whether a service is well: for those who watch over it."""

from dataclasses import dataclass

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, Response

from rga.dashboard.api.bounds import IntakeRoom
from rga.dashboard.api.served import surroundings_of
from rga.errors import InputError

router = APIRouter(tags=["health"])


@dataclass(frozen=True)
class Health:
    """That the process runs."""

    state: str


@dataclass(frozen=True)
class Readiness:
    """Whether data are taken in: `up`, or `not ready`, and how many twins lack room."""

    state: str
    lacking: int


@router.get("/healthz")
def health() -> Health:
    """Whether the process runs."""
    return Health("up")


@router.get("/readyz", response_model=Readiness, responses={503: {"model": Readiness}})
def ready(request: Request) -> Response:
    """Whether the databases can be written, and nothing lags too far behind."""
    known, room = surroundings_of(request), request.app.state.room
    lacking = sum(_lacks(room, request, name) for name in known.names)
    state = "not ready" if lacking else "up"
    return JSONResponse({"state": state, "lacking": lacking}, 503 if lacking else 200)


def _lacks(room: IntakeRoom, request: Request, name: str) -> bool:
    try:
        seen = surroundings_of(request).twin(name)
        with seen.served.inbox.writing():
            pass
        # Data are taken in without it; more than that nobody is served.
        seen.reading.now()
        return room.lacking(seen) is not None
    except (InputError, OSError):
        return True
