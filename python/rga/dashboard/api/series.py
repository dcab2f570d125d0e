"""What was measured, simulated and inferred over a time, in no more numbers than a picture has."""

from dataclasses import dataclass
from datetime import datetime
from typing import Annotated

import numpy as np
from fastapi import APIRouter, Depends, HTTPException, Query

from rga.dashboard.access.may import may
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.readings import begun_twin
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, Moment, TheTwin
from rga.operation.reading.overview import Floats, Trace
from rga.operation.reading.twin_now import moment

#: points of an answer, and numbers of all its columns
MOST_POINTS, MOST_NUMBERS = 5_000, 500_000
router = APIRouter(prefix=PREFIX, tags=["readings"], route_class=KnownQueryRoute)
Numbers = list[float | None]


@dataclass(frozen=True)
class SeriesColumn:
    """One column, an entry for one row or for several; None: nothing is there."""

    mean: Numbers
    least: Numbers
    most: Numbers


@dataclass(frozen=True)
class SeriesPart:
    """Columns over time.

    Attributes:
        time: of the first row of each entry.
        columns: by name.
    """

    time: list[datetime]
    columns: dict[str, SeriesColumn]


@dataclass(frozen=True)
class SeriesAnswer:
    """What was measured, simulated and inferred; gaps are over the variance of the noise [-]."""

    measured: SeriesPart
    simulated: SeriesPart
    gap: SeriesPart
    inferred: SeriesPart


@router.get("/twins/{twin}/series", responses=OF_A_TWIN, dependencies=[Depends(may("viewer"))])
def series(
    seen: TheTwin,
    channels: Annotated[
        list[str] | None, Query(description="Sensors; left out, all.", max_length=1000)
    ] = None,
    begin: Annotated[Moment | None, Query(alias="from")] = None,
    end: Annotated[Moment | None, Query(alias="to")] = None,
    points: Annotated[int, Query(ge=1, le=MOST_POINTS)] = 1000,
) -> SeriesAnswer:
    """Mean, least and largest of what lies within a time; of many columns in fewer points."""
    twin, reading = begun_twin(seen), seen.reading
    known = twin.station.channels
    chosen = tuple(dict.fromkeys(known if channels is None else channels))
    if unknown := [name for name in chosen if name not in known]:
        raise HTTPException(422, f"there is no sensor {unknown[0]!r}")
    if begin is not None and end is not None and end < begin:
        raise HTTPException(422, "query.to: it is before from")
    # Of each sensor three columns, of each context one, of three numbers each.
    width = 9 * len(chosen) + 3 * len(twin.given.context)
    found = reading.series(
        0.0 if begin is None else reading.elapsed(begin),
        np.inf if end is None else reading.elapsed(end),
        max(1, min(points, MOST_NUMBERS // max(1, width))),
    )
    assert found is not None
    start, which = str(twin.station.start), [known.index(name) for name in chosen]
    every = list(range(len(found.contexts)))
    return SeriesAnswer(
        measured=_part(found.measured, start, chosen, which),
        simulated=_part(found.simulated, start, chosen, which),
        gap=_part(found.gap, start, chosen, which),
        inferred=_part(found.inferred, start, found.contexts, every),
    )


def _part(trace: Trace, start: str, names: tuple[str, ...], which: list[int]) -> SeriesPart:
    columns = {
        name: SeriesColumn(
            _listed(trace.mean[:, k]), _listed(trace.least[:, k]), _listed(trace.most[:, k])
        )
        for name, k in zip(names, which, strict=True)
    }
    return SeriesPart([moment(start, one) for one in trace.time.tolist()], columns)


def _listed(values: Floats) -> Numbers:
    """Numbers as JSON can say them."""
    finite = np.isfinite(values)
    return [
        one if there else None for one, there in zip(values.tolist(), finite.tolist(), strict=True)
    ]
