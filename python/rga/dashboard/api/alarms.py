"""Alarms: what is wrong, and what operators do about it."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Body, Depends, HTTPException, Path, Query, Request
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from rga.dashboard.access.may import may, may_see_some
from rga.dashboard.access.roles import Right, Who
from rga.dashboard.alarm_desk import alarms_of
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.past import LARGEST
from rga.dashboard.api.served import (
    OF_A_TWIN,
    PREFIX,
    Moment,
    TheTwin,
    answering,
    surroundings_of,
)
from rga.dashboard.surroundings import Surroundings
from rga.errors import InputError
from rga.operation.alarms.alarm_book import MOST_LETTERS, AlarmBook
from rga.operation.alarms.operator_alarm import AlarmTransition, OperatorAlarm
from rga.operation.settings_types import Duration, is_readable
from rga.twin.repository.faults import RepositoryFault

#: alarms of an answer that are closed
MOST_CLOSED = 1000
router = APIRouter(prefix=PREFIX, tags=["alarms"], route_class=KnownQueryRoute)
Closed = Annotated[
    int, Query(ge=0, le=MOST_CLOSED, description="How many of the latest closed ones besides.")
]
AlarmNumber = Annotated[int, Path(ge=1, le=LARGEST, description="Number of the alarm.")]


def _readable(words: str) -> str:
    if not is_readable(words):
        raise ValueError("it has a control character")
    return words


Why = Annotated[str, Field(max_length=MOST_LETTERS), AfterValidator(_readable)]


@dataclass(frozen=True)
class AlarmLife:
    """An alarm as it stands, and all that has become of it."""

    alarm: OperatorAlarm
    life: tuple[AlarmTransition, ...]


class Reason(BaseModel):
    """Why somebody does something about an alarm."""

    model_config = ConfigDict(extra="forbid")

    why: Why = ""


UNSAID = Reason()


class Shelving(Reason):
    """For how long nobody wants to hear of an alarm, and why: `until` a time, or `for` a while."""

    why: Annotated[Why, Field(min_length=1)]
    until: Moment | None = None
    span: Duration | None = Field(None, alias="for")

    @model_validator(mode="after")
    def _ends(self) -> "Shelving":
        if (self.until is None) == (self.span is None):
            raise ValueError("say until when, or for how long")
        if not self.why.strip():
            raise ValueError("say why")
        return self

    def end(self, now: datetime) -> datetime:
        """When the shelf ends."""
        if self.until is not None:
            return self.until
        assert self.span is not None  # one of the two is given
        return now + timedelta(seconds=self.span)


@dataclass(frozen=True)
class _Called:
    """An alarm that a call is about, the book that it stands in, and who calls."""

    id: int
    book: AlarmBook
    who: str


def _of_alarm(right: Right) -> Callable[..., _Called]:
    """A dependency that gives the alarm of a path, if whoever calls may.

    Args:
        right: that they must have of its twin; of all twins if it is of the service itself.
    """

    def called(
        number: AlarmNumber, request: Request, who: Annotated[Who, Depends(may_see_some)]
    ) -> _Called:
        book = surroundings_of(request).alarms
        try:
            twin = book.of(number).twin
        except RepositoryFault:
            raise
        except InputError as error:
            raise HTTPException(404, str(error)) from None
        if not who.may(right, twin):
            raise HTTPException(403, f"{who.name} ({who.role}) may not do this")
        return _Called(number, book, who.name)

    return called


Seen = Annotated[_Called, Depends(_of_alarm("viewer"))]
Handled = Annotated[_Called, Depends(_of_alarm("operator"))]


@router.get("/alarms", responses=answering())
def alarms(
    who: Annotated[Who, Depends(may_see_some)],
    known: Annotated[Surroundings, Depends(surroundings_of)],
    closed: Closed = 0,
) -> list[OperatorAlarm]:
    """Open alarms of the service and of every twin that whoever calls may see, the newest first."""
    book = known.alarms
    newest = [one for one in book.all(10 * closed) if one.state == "closed"]
    found, others = (
        [one for one in some if who.may("viewer", one.twin)] for some in (book.open(), newest)
    )
    return sorted([*found, *others[:closed]], key=lambda one: one.id, reverse=True)


@router.get("/twins/{twin}/alarms", responses=OF_A_TWIN, dependencies=[Depends(may("viewer"))])
def alarms_of_twin(seen: TheTwin, closed: Closed = 0) -> list[OperatorAlarm]:
    """Open alarms of a twin: first those that nobody has acknowledged, the newest of each."""
    return alarms_of(seen.alarms, seen.name, closed)


@router.get("/alarms/{number}", responses=OF_A_TWIN)
def alarm(called: Seen) -> AlarmLife:
    """An alarm, and all that has become of it, who did it and why."""
    return AlarmLife(called.book.of(called.id), called.book.life(called.id))


@router.post("/alarms/{number}/ack", responses=OF_A_TWIN | answering(413))
def acknowledge(called: Handled, reason: Annotated[Reason, Body()] = UNSAID) -> OperatorAlarm:
    """Somebody has seen an alarm."""
    return called.book.acknowledge(called.id, called.who, reason.why)


@router.post("/alarms/{number}/shelve", responses=OF_A_TWIN | answering(413))
def shelve(called: Handled, shelving: Shelving) -> OperatorAlarm:
    """Hear nothing of an alarm for a while, 30 days at the most."""
    until = shelving.end(Surroundings.now())
    return called.book.shelve(called.id, until, called.who, shelving.why)


@router.post("/alarms/{number}/unshelve", responses=OF_A_TWIN | answering(413))
def unshelve(called: Handled, reason: Annotated[Reason, Body()] = UNSAID) -> OperatorAlarm:
    """Hear of an alarm again: it comes back unacknowledged."""
    return called.book.unshelve(called.id, called.who, reason.why)
