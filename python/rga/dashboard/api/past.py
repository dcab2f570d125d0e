"""What a twin lived through: versions, proposals, the log, and what became of packets."""

import json
from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException, Path, Query
from starlette.responses import Response

from rga.dashboard.access.may import may
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.readings import begun_twin
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, TheTwin
from rga.dashboard.in_force import SpanInForce, spans_in_force
from rga.dashboard.surroundings import SeenTwin
from rga.findings.phrases import effect_words
from rga.operation.disk.forecast import DiskForecast
from rga.operation.inbox.account import Account
from rga.operation.reading.twin_now import moment
from rga.twin.commands.proposals import decision
from rga.twin.repository import RunView

#: entries of a log in an answer
MOST_ENTRIES = 1000
#: a number that a database holds
LARGEST = 2**53
router = APIRouter(
    prefix=PREFIX,
    tags=["past"],
    route_class=KnownQueryRoute,
    responses=OF_A_TWIN,
    dependencies=[Depends(may("viewer"))],
)
Last = Annotated[int, Query(ge=1, le=MOST_ENTRIES, description="How many of the latest entries.")]


@dataclass(frozen=True)
class VersionAnswer:
    """A version of the model.

    Attributes:
        number: 1 for the model as it was given.
        time: of the row at which it was made.
        causes: what it has beyond the model as given, in words.
        gain, gain_ci90: on held-out rows, with its 90 % interval [-].
        in_force: whether it is.
        spans: in which it was in force, the first first.
    """

    number: int
    time: datetime | None
    causes: list[str]
    gain: float | None
    gain_ci90: tuple[float, float] | None
    in_force: bool
    spans: list[SpanInForce]


@dataclass(frozen=True)
class ProposalAnswer:
    """A change of the model that a diagnosis proposed.

    Attributes:
        number: from 1.
        time: of the row at which it was made.
        words: what the model would have then.
        effects: the same, as they stand in a model file.
        gain, gain_ci90: on held-out rows, with its 90 % interval [-].
        decided: what was decided about it; None: nothing was.
    """

    number: int
    time: datetime | None
    words: str
    effects: dict[str, dict[str, Any]]
    gain: float | None
    gain_ci90: tuple[float, float] | None
    decided: str | None


@dataclass(frozen=True)
class MessageAnswer:
    """A query or a response of the twin: its kind, when it was sent, and what it said."""

    kind: str
    row: int
    time: datetime | None
    body: dict[str, Any]
    written_at: datetime


@dataclass(frozen=True)
class EventAnswer:
    """Something that happened to the twin: when, what, in words, and to which sensors."""

    kind: str
    row: int
    time: datetime
    words: str
    sensors: list[str]


@dataclass(frozen=True)
class LogAnswer:
    """An exchange of query and response, or an event: its row, kinds, and words."""

    row: int
    messages: str
    words: str


@dataclass(frozen=True)
class StreamAnswer:
    """Numbers of packets that a logger counts: the next, and first and last of those missing."""

    next: int
    missing: list[tuple[int, int]]


@dataclass(frozen=True)
class AccountAnswer:
    """What became of the packets of a source; `difference` is always 0."""

    received: int
    used: int
    duplicate: int
    late: int
    partly_late: int
    refused: int
    waiting: int
    difference: int
    streams: dict[str, StreamAnswer]


@router.get("/twins/{twin}/versions")
def versions(seen: TheTwin) -> list[VersionAnswer]:
    """Versions of the model."""
    view = _view(seen)
    in_force = view.version_in_force()
    spans = spans_in_force(view, begun_twin(seen).station.start)
    return [
        VersionAnswer(
            version.number,
            _time_of(seen, view, version.row),
            [effect_words(one) for one in json.loads(version.causes).values()],
            version.gain,
            version.gain_ci90,
            in_force is not None and version.number == in_force.number,
            spans.get(version.number, []),
        )
        for version in view.versions()
    ]


@router.get(
    "/twins/{twin}/versions/{number}/model",
    response_class=Response,
    responses={200: {"content": {"application/json": {}}, "description": "A model file."}},
)
def model_file(seen: TheTwin, number: Annotated[int, Path(ge=1, le=LARGEST)]) -> Response:
    """The model file of a version."""
    for one in _view(seen).versions():
        if one.number == number:
            name = f"{seen.name}-version-{number}.json"
            told = {"Content-Disposition": f'attachment; filename="{name}"'}
            return Response(one.model, media_type="application/json", headers=told)
    raise HTTPException(404, f"there is no version {number}")


@router.get("/twins/{twin}/proposals")
def proposals(seen: TheTwin) -> list[ProposalAnswer]:
    """Changes of the model that diagnoses proposed, and what was decided about them."""
    view = _view(seen)
    return [
        ProposalAnswer(
            one.number,
            _time_of(seen, view, one.row),
            one.words,
            one.effects,
            one.gain,
            one.gain_ci90,
            decision(view, one),
        )
        for one in view.proposals()
    ]


@router.get("/twins/{twin}/messages")
def messages(
    seen: TheTwin,
    kind: Annotated[str | None, Query(pattern="^[QR][1-5]$")] = None,
    last: Last = 100,
) -> list[MessageAnswer]:
    """The log of queries and responses, the oldest first."""
    view = _view(seen)
    found = view.messages(kind, last)
    # Messages themselves have no time: that of their rows stands with the rows.
    rows = view.measured_at([one.row for one in found])
    start = begun_twin(seen).station.start
    times = {
        row: moment(start, time)
        for row, time in zip(rows.rows.tolist(), rows.time.tolist(), strict=True)
    }
    return [
        MessageAnswer(one.kind, one.row, times.get(one.row), one.body, one.written_at)
        for one in found
    ]


@router.get("/twins/{twin}/events")
def events(seen: TheTwin, last: Last = 100) -> list[EventAnswer]:
    """What happened to the twin, the oldest first."""
    return [
        EventAnswer(
            one.kind, one.row, datetime.fromisoformat(str(one.time)), one.words, list(one.sensors)
        )
        for one in _view(seen).events()[-last:]
    ]


@router.get("/twins/{twin}/log")
def log(seen: TheTwin, last: Last = 100) -> list[LogAnswer]:
    """Queries, responses and events in words, the oldest first."""
    return [LogAnswer(*one) for one in begun_twin(seen).log()[-last:]]


@router.get("/twins/{twin}/account")
def account(seen: TheTwin) -> dict[str, AccountAnswer]:
    """What became of every packet, by source."""
    sources: dict[str, Account] = {}
    for (source, _), one in seen.served.packets.account().items():
        sources[source] = sources.get(source, Account()) + one
    return {
        name: AccountAnswer(
            **asdict(one),
            difference=one.difference,
            streams={
                stream: StreamAnswer(known.next, known.gaps)
                for stream, known in seen.served.numbers(name).items()
            },
        )
        for name, one in sources.items()
    }


@router.get("/twins/{twin}/disk")
def disk(seen: TheTwin) -> DiskForecast:
    """What a year takes of the disk of the service, and for how long there is room."""
    return seen.forecast()


def _view(seen: SeenTwin) -> RunView:
    begun_twin(seen)
    view = seen.reading.view()
    assert view is not None
    return view


def _time_of(seen: SeenTwin, view: RunView, row: int) -> datetime | None:
    found = view.measured_at([row]).time
    return moment(begun_twin(seen).station.start, float(found[0])) if len(found) else None
