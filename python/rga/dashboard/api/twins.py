"""The twins of a service, and where each stands."""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated

from fastapi import APIRouter, Depends

from rga.dashboard.access.may import may, may_see_some
from rga.dashboard.access.roles import Who
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.served import (
    OF_A_TWIN,
    PREFIX,
    Moment,
    TheTwin,
    answering,
    begun,
    surroundings_of,
)
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.dashboard.twin_health import health_of
from rga.operation.reading.twin_now import TwinNow

router = APIRouter(prefix=PREFIX, tags=["twins"], route_class=KnownQueryRoute)


@dataclass(frozen=True)
class ServedState:
    """Where a twin stands.

    Attributes:
        name: of it.
        state: how it is in a word, the same as its pages say: alarm, to decide, not watched,
            silent, behind, learning, no rows yet, or in step.
        words: the same in a sentence.
        now: where it stands; None before its first rows.
        age: of its last row [s].
        lag: rows that have come and were not played yet.
        faults: what keeps it from going on, in words, by what it concerns.
    """

    name: str
    state: str
    words: str
    now: TwinNow | None
    age: float | None
    lag: int
    faults: dict[str, str]


def state_of_twin(seen: SeenTwin) -> ServedState:
    """Where a twin stands."""
    now = seen.reading.now()
    time = None if now is None else now.time
    age = None if time is None else (datetime.now(UTC) - time).total_seconds()
    health = health_of(seen, now)
    return ServedState(
        seen.name, health.word, health.words, now, age, seen.lag(now), dict(seen.faults)
    )


@router.get("/twins", responses=answering())
def twins(
    who: Annotated[Who, Depends(may_see_some)],
    known: Annotated[Surroundings, Depends(surroundings_of)],
) -> list[ServedState]:
    """Where every twin stands that whoever calls may see."""
    seen = [name for name in known.names if who.may("viewer", name)]
    return [state_of_twin(known.twin(name)) for name in seen]


@router.get("/twins/{twin}", responses=OF_A_TWIN, dependencies=[Depends(may("viewer"))])
def twin(seen: TheTwin) -> ServedState:
    """Where a twin stands."""
    return state_of_twin(seen)


@router.get("/twins/{twin}/as-of", responses=OF_A_TWIN, dependencies=[Depends(may("viewer"))])
def as_of(seen: TheTwin, time: Moment) -> TwinNow | None:
    """Where a twin stood at a time; null where it had not begun."""
    begun(seen)
    elapsed = seen.reading.elapsed(time)
    return None if elapsed < 0 else seen.reading.as_of(elapsed)
