"""What paths of the API have in common: the twin that they name, and what they answer otherwise."""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated, Any

from fastapi import Depends, HTTPException, Path, Request
from pydantic import AwareDatetime, BeforeValidator
from starlette.requests import HTTPConnection

from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.operation.reading.twin_now import TwinNow
from rga.operation.settings_types import NAME_PATTERN

#: where every path begins
PREFIX = "/api/v1"


@dataclass(frozen=True)
class ErrorAnswer:
    """Why something is not answered, in words."""

    detail: str


def answering(*others: int) -> dict[int | str, dict[str, Any]]:
    """What a path may answer besides what it is there for."""
    every = (400, 401, 403, 422, 503, *others)
    return {status: {"model": ErrorAnswer} for status in every}


def told_as_json(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The same of a path whose good answers are no JSON."""
    schema = {"schema": {"$ref": f"#/components/schemas/{ErrorAnswer.__name__}"}}
    told = {"description": "Why not.", "content": {"application/json": schema}}
    return dict.fromkeys(statuses, told)


#: of a path that names a twin
OF_A_TWIN = answering(404)


def surroundings_of(call: HTTPConnection) -> Surroundings:
    """The twins of the service that is called."""
    found: Surroundings = call.app.state.surroundings
    return found


TwinName = Annotated[str, Path(pattern=NAME_PATTERN, description="Name of the twin.")]


def seen_twin(twin: TwinName, request: Request) -> SeenTwin:
    """The twin that a path names."""
    known = surroundings_of(request)
    if twin not in known.names:
        raise HTTPException(404, f"there is no twin {twin!r}")
    return known.twin(twin)


#: of a path that names a twin: that twin
TheTwin = Annotated[SeenTwin, Depends(seen_twin)]


def moment_in_utc(given: Any) -> datetime:
    """A time in UTC, as it is written in ISO 8601 with its zone; a number is none.

    Raises:
        ValueError: it is none, has no zone, or lies in no year of UTC.
    """
    try:
        read = datetime.fromisoformat(given)
    except (TypeError, ValueError):
        read = None
    if read is None or read.tzinfo is None:
        raise ValueError("give a time with its zone, such as 2026-11-23T12:00:00Z")
    try:
        return read.astimezone(UTC)
    except OverflowError:
        raise ValueError("in UTC it lies before the year 1, or behind the year 9999") from None


#: a time with its zone
Moment = Annotated[AwareDatetime, BeforeValidator(moment_in_utc)]


def begun(seen: SeenTwin) -> TwinNow:
    """Where a twin stands.

    Raises:
        HTTPException: it has not begun.
    """
    now = seen.reading.now()
    if now is None:
        raise HTTPException(404, f"twin {seen.name!r} has not begun: it waits for rows")
    return now
