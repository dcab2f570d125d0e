"""The report of a stretch of time."""

from dataclasses import dataclass
from typing import Annotated
from urllib.parse import urlencode

import numpy as np
from fastapi import APIRouter, Depends, HTTPException, Query, Request
from starlette.responses import HTMLResponse, JSONResponse, Response

from rga.dashboard.access.may import may
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.readings import begun_twin
from rga.dashboard.api.reports import Reports, Wanted
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, Moment, TheTwin, answering
from rga.operation.reading.twin_now import moment

#: rows of a report
MOST_ROWS = 20_000
#: how long to wait before asking again whether a report is made [s]
AGAIN = 2
# It is a page of its own: nothing of it reaches the service.
POLICY = (
    "sandbox allow-scripts allow-downloads; default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; img-src data:; font-src data:; frame-ancestors 'none'"
)
router = APIRouter(prefix=PREFIX, tags=["report"], route_class=KnownQueryRoute)


@dataclass(frozen=True)
class ReportBegun:
    """A report that is being made: where to ask for it."""

    location: str


@router.get(
    "/twins/{twin}/report",
    response_class=Response,
    responses=OF_A_TWIN
    | answering(429)
    | {
        200: {"content": {"text/html": {}}, "description": "The report."},
        202: {"model": ReportBegun},
    },
    dependencies=[Depends(may("viewer"))],
)
def report(
    seen: TheTwin,
    request: Request,
    begin: Annotated[Moment | None, Query(alias="from")] = None,
    end: Annotated[Moment | None, Query(alias="to")] = None,
) -> Response:
    """What the model in force leaves unexplained within a time; 202 while it is being made."""
    twin, reading = begun_twin(seen), seen.reading
    view = reading.view()
    assert view is not None
    behind = view.rows if end is None else view.row_at(reading.elapsed(end)) + 1
    first = max(0, behind - MOST_ROWS)
    if begin is not None:
        first = view.row_at(float(np.nextafter(reading.elapsed(begin), -np.inf))) + 1
    if not 0 < behind - first <= MOST_ROWS:
        raise HTTPException(422, f"{max(0, behind - first)} rows: take 1 to {MOST_ROWS}")
    made: Reports = request.app.state.reports
    try:
        found = made.get(Wanted(str(reading.place), view.identity.source, first, behind))
    except BlockingIOError:
        told = {"Retry-After": str(AGAIN)}
        raise HTTPException(429, "other reports are being made: ask again", told) from None
    if found is not None:
        headers = {"Content-Security-Policy": POLICY}
        return HTMLResponse(found.read_bytes(), headers=headers)
    # What is asked for without an end grows with every row; this stays what it is.
    times = view.measured_at([first, behind - 1]).time
    ends = (moment(twin.station.start, float(one)).isoformat() for one in (times[0], times[-1]))
    asked = urlencode(dict(zip(("from", "to"), ends, strict=True)))
    location = f"{PREFIX}/twins/{seen.name}/report?{asked}"
    headers = {"Location": location, "Retry-After": str(AGAIN)}
    return JSONResponse({"location": location}, 202, headers)
