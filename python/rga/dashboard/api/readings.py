"""What the sensors of a twin read, and what it infers."""

from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from fastapi import APIRouter, Depends, HTTPException

from rga.dashboard.access.may import may
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, TheTwin, begun
from rga.dashboard.surroundings import SeenTwin
from rga.operation.reading.twin_now import moment
from rga.simulation.whatif import HALF_WIDTH
from rga.twin.twin import Twin

#: rows in which the newest reading of a sensor is looked for
LOOKED_BACK = 1000
router = APIRouter(
    prefix=PREFIX,
    tags=["readings"],
    route_class=KnownQueryRoute,
    responses=OF_A_TWIN,
    dependencies=[Depends(may("viewer"))],
)


@dataclass(frozen=True)
class GapAnswer:
    """How far readings are from what is simulated, in the last row.

    Attributes:
        time: of the row; None: no row has come.
        mean: over the sensors, squared difference over the variance of the noise [-].
        sensors: the same of each; None: nothing tells it.
    """

    time: datetime | None
    mean: float | None
    sensors: dict[str, float | None]


@dataclass(frozen=True)
class ContextAnswer:
    """What a twin infers of a context.

    Attributes:
        unit: of the numbers.
        mean: of what it may be.
        ci90: 90 % interval.
    """

    unit: str
    mean: float
    ci90: tuple[float, float]


@dataclass(frozen=True)
class LatestReading:
    """The newest reading of a sensor, by the time at which it was measured.

    Attributes:
        unit: of the value.
        value: mean over its row.
        time: of the row.
        age: of it [s].
    """

    unit: str
    value: float
    time: datetime
    age: float


@router.get("/twins/{twin}/gap")
def gap(seen: TheTwin) -> GapAnswer:
    """How far every sensor is from what is simulated."""
    now = begun(seen)
    return GapAnswer(now.time, now.gap, {name: one.gap for name, one in now.sensors.items()})


@router.get("/twins/{twin}/contexts")
def contexts(seen: TheTwin) -> dict[str, ContextAnswer]:
    """What is inferred of every context, for the last row."""
    now, units = begun(seen), begun_twin(seen).given.context
    return {
        name: ContextAnswer(
            units[name].unit, mean, (mean - HALF_WIDTH * spread, mean + HALF_WIDTH * spread)
        )
        for name, (mean, spread) in now.contexts.items()
    }


@router.get("/twins/{twin}/latest")
def latest(seen: TheTwin) -> dict[str, LatestReading | None]:
    """The newest reading of every sensor; null where none of the last 1000 rows has one."""
    twin = begun_twin(seen)
    view = seen.reading.view()
    rows = 0 if view is None else view.rows
    # Rows that are sealed wait in the inbox until the twin takes them in.
    waiting = seen.served.inbox.packet(twin.station, rows, LOOKED_BACK)
    times, readings = waiting.time, waiting.readings
    if view is not None:
        taken = view.measured(max(0, rows - LOOKED_BACK), rows)
        width = len(twin.station.channels)
        times = np.concatenate([taken.time, times])
        readings = np.concatenate([taken.readings.reshape(-1, width), readings])
    found: dict[str, LatestReading | None] = {}
    for k, name in enumerate(twin.station.channels):
        there = np.flatnonzero(np.isfinite(readings[:, k]))
        if not len(there):
            found[name] = None
            continue
        time = moment(twin.station.start, float(times[there[-1]]))
        age = (datetime.now(UTC) - time).total_seconds()
        unit = twin.given.sensors[name].unit
        found[name] = LatestReading(unit, float(readings[there[-1], k]), time, age)
    return found


def begun_twin(seen: SeenTwin) -> Twin:
    """A twin as it stands.

    Raises:
        HTTPException: it has not begun.
    """
    twin = seen.reading.twin
    if twin is None:
        raise HTTPException(404, f"twin {seen.name!r} has not begun: it waits for rows")
    return twin
