"""What people ask a twin for: kept at once, carried out by whoever plays the twin."""

import json
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args
from uuid import uuid4

from fastapi import APIRouter, Body, Depends, Header, HTTPException, Path
from pydantic import ValidationError, WithJsonSchema
from starlette.responses import Response

from rga.dashboard.access.may import may
from rga.dashboard.access.roles import Who
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.past import LARGEST
from rga.dashboard.api.possible import about, impossible, unreadable
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, TheTwin, answering
from rga.operation.inbox.requests import KeyUsed, Requests
from rga.settings_files import in_words
from rga.twin.commands.command import AnyCommand, read_command
from rga.twin.restore import standing_of

#: what the service fills in itself
_FILLED = ("who", "given_at")
router = APIRouter(prefix=PREFIX, tags=["commands"], route_class=KnownQueryRoute)


def _schema() -> dict[str, Any]:
    """JSON Schema of a command as it is sent."""
    found = []
    for kind in get_args(AnyCommand):
        schema = kind.model_json_schema()
        for name in _FILLED:
            del schema["properties"][name]
        required = {*schema.get("required", ()), "kind"} - {*_FILLED}
        found.append(schema | {"required": sorted(required)})
    return {"oneOf": found, "title": "Command"}


SentCommand = Annotated[dict[str, Any], WithJsonSchema(_schema())]
Key = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        pattern=r"^[\x21-\x7e]{1,200}$",
        description="Drawn by whoever asks, the same when it is sent again; left out, drawn here.",
    ),
]


@dataclass(frozen=True)
class KeptCommand:
    """A command that is kept: its number, by which to ask what came of it, and its key."""

    number: int
    key: str


@dataclass(frozen=True)
class CommandState:
    """What came of a command.

    Attributes:
        number, kind: of it.
        who, why, given_at: as it was asked for.
        state: whether it waits, was done, or was refused.
        outcome: what came of it, in words; None while it waits.
        row: of the record at which it was carried out.
    """

    number: int
    kind: str
    who: str
    why: str
    given_at: str
    state: Literal["waiting", "done", "refused"]
    outcome: str | None
    row: int | None


@router.post("/twins/{twin}/commands", status_code=202, responses=OF_A_TWIN | answering(409, 413))
def ask(
    seen: TheTwin,
    who: Annotated[Who, Depends(may("operator"))],
    command: Annotated[SentCommand, Body()],
    response: Response,
    idempotency_key: Key = None,
) -> KeptCommand:
    """Ask for something: it is on the disk when the answer comes, and done once."""
    key = idempotency_key or uuid4().hex
    if filled := [name for name in _FILLED if name in command]:
        raise HTTPException(422, f"{filled[0]} is filled in by the service: leave it out")
    if wrong := unreadable(command):
        raise HTTPException(422, wrong)
    try:
        read = read_command(json.dumps(command | {"who": who.name}))
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(one) for one in first["loc"]) or "it"
        raise HTTPException(422, f"{place}: {in_words(first)}") from None
    requests = Requests(seen.served.inbox)
    asked, compared = f"{who.name} {key}", json.dumps(command, sort_keys=True)
    try:
        number = requests.known(asked, compared)
        if number is None:
            now = seen.reading.now()
            read = about(read, seen, now)
            if lacking := impossible(read, seen, now):
                raise HTTPException(422, lacking)
            number = requests.ask(asked, read.model_dump_json(), compared)
    except KeyUsed as error:
        raise HTTPException(409, str(error)) from None
    response.headers["Location"] = f"{PREFIX}/twins/{seen.name}/commands/{number}"
    return KeptCommand(number, key)


@router.get(
    "/twins/{twin}/commands/{number}",
    responses=OF_A_TWIN,
    dependencies=[Depends(may("viewer"))],
)
def outcome(seen: TheTwin, number: Annotated[int, Path(ge=1, le=LARGEST)]) -> CommandState:
    """What came of a command."""
    for known, text in seen.served.inbox.commands(number - 1)[:1]:
        if known == number:
            return _state(seen, number, read_command(text))
    raise HTTPException(404, f"there is no command {number}")


def _state(seen: TheTwin, number: int, command: AnyCommand) -> CommandState:
    asked = (command.kind, command.who, command.why, command.given_at)
    view = seen.reading.view()
    if view is not None and number <= standing_of(view).commanded:
        for one in reversed(view.commands()):
            if (one.kind, one.who, one.why, one.given_at) == asked:
                told: Literal["done", "refused"] = "refused" if one.body.get("refused") else "done"
                return CommandState(number, *asked, told, one.outcome, one.row)
    return CommandState(number, *asked, "waiting", None, None)
