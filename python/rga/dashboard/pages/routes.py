"""Addresses of the pages."""

from collections.abc import Callable
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import RedirectResponse, Response

from rga.dashboard.access.may import may
from rga.dashboard.access.roles import Who
from rga.dashboard.alarm_desk import act
from rga.dashboard.api.served import TheTwin, surroundings_of
from rga.dashboard.pages.alarms import alarms_page
from rga.dashboard.pages.bridge import bridge_page
from rga.dashboard.pages.causes import causes_page, findings_of
from rga.dashboard.pages.data import data_page
from rga.dashboard.pages.fleet import fleet_page
from rga.dashboard.pages.forms import ask, form_of
from rga.dashboard.pages.heading import heading_of_damaged
from rga.dashboard.pages.queries import queries_page
from rga.dashboard.pages.rendering import rendered
from rga.dashboard.pages.sensor import sensor_page, sensors_page
from rga.dashboard.pages.versions import versions_page
from rga.dashboard.pages.windows import NotUnderstood
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.errors import InputError

Viewer = Annotated[Who, Depends(may("viewer"))]
Operator = Annotated[Who, Depends(may("operator"))]
TheService = Annotated[Surroundings, Depends(surroundings_of)]
router = APIRouter(include_in_schema=False)


@router.get("/")
def fleet(surroundings: TheService, who: Viewer) -> Response:
    return rendered("fleet", fleet_page(surroundings), who)


@router.get("/twins/{twin}")
def bridge(seen: TheTwin, request: Request, who: Viewer) -> Response:
    def page() -> dict[str, Any]:
        return bridge_page(seen, request.query_params)

    return _page("bridge", page, seen, "", who, live="at" not in request.query_params)


@router.get("/twins/{twin}/sensors")
def sensors(seen: TheTwin, request: Request, who: Viewer, name: str | None = None) -> Response:
    if name is None:
        return _page("sensors", lambda: sensors_page(seen), seen, "/sensors", who)

    def page() -> dict[str, Any]:
        return sensor_page(seen, name, request.query_params)

    return _page("sensor", page, seen, "/sensors", who)


@router.get("/twins/{twin}/alarms")
def alarms(seen: TheTwin, who: Viewer) -> Response:
    return _page("alarms", lambda: alarms_page(seen), seen, "/alarms", who)


@router.get("/twins/{twin}/causes")
def causes(seen: TheTwin, who: Viewer) -> Response:
    return _page("causes", lambda: causes_page(seen), seen, "/causes", who)


@router.get("/twins/{twin}/causes/{number}/findings.json")
def findings(seen: TheTwin, number: int, who: Viewer) -> Response:
    return _file(seen, lambda view: findings_of(view, number))


@router.get("/twins/{twin}/versions")
def versions(seen: TheTwin, who: Viewer) -> Response:
    return _page("versions", lambda: versions_page(seen), seen, "/versions", who)


@router.get("/twins/{twin}/queries")
def queries(seen: TheTwin, request: Request, who: Viewer) -> Response:
    def page() -> dict[str, Any]:
        return queries_page(seen, request.query_params)

    return _page("queries", page, seen, "/queries", who, live=False)


@router.get("/twins/{twin}/data")
def data(seen: TheTwin, who: Viewer) -> Response:
    return _page("data", lambda: data_page(seen), seen, "/data", who)


@router.post("/twins/{twin}/commands")
async def command(seen: TheTwin, request: Request, who: Operator) -> Response:
    """Keep what a form asks a twin for, and go back to its page."""
    form = await form_of(request)
    here = f"/twins/{seen.name}"
    back = form.get("back", "")
    # Nobody is led away from the pages of this twin.
    back = back if back.startswith(f"{here}/") and back.isprintable() else here
    return await _done(partial(ask, seen, form, who.name), back, who)


@router.post("/twins/{twin}/alarms/{number}")
async def alarm(seen: TheTwin, number: int, request: Request, who: Operator) -> Response:
    """Do what a form asks about an alarm of a twin."""
    form, now = await form_of(request), Surroundings.now()
    does = partial(act, seen.alarms, seen.name, number, form, who.name, now)
    return await _done(does, f"/twins/{seen.name}/alarms", who)


@router.post("/alarms/{number}")
async def alarm_of_service(
    surroundings: TheService, number: int, request: Request, who: Operator
) -> Response:
    """Do what a form asks about an alarm of the service itself."""
    form, now = await form_of(request), Surroundings.now()
    return await _done(
        partial(act, surroundings.alarms, None, number, form, who.name, now), "/", who
    )


async def _done(does: Callable[[], None], back: str, who: Who) -> Response:
    """Do what a form asks and go back, or say why it was not done."""
    try:
        await run_in_threadpool(does)
    except InputError as error:
        shown = {"title": "This was not done", "words": str(error), "back": back}
        return rendered("refused", shown, who, live=False, status=409)
    return RedirectResponse(back, 303)


def _page(
    template: str,
    page: Callable[[], dict[str, Any]],
    seen: SeenTwin,
    tab: str,
    who: Who,
    *,
    live: bool = True,
) -> Response:
    """A page of a twin, or one that says why it cannot be drawn."""
    try:
        return rendered(template, page(), who, live=live)
    except KeyError as error:
        raise HTTPException(404, f"there is no {error.args[0]!r}") from None
    except NotUnderstood as error:
        raise HTTPException(422, str(error)) from None
    except InputError as error:
        shown = {
            "heading": heading_of_damaged(seen, error),
            "tab": tab,
            "words": str(error),
        }
        return rendered("fault", shown, who, live=False, status=503)


def _file(seen: SeenTwin, content: Callable[[Any], str]) -> Response:
    """A JSON file out of the repository of a twin."""
    try:
        view = seen.reading.view()
        if view is None:
            raise HTTPException(404, "the twin has not begun")
        text = content(view)
    except KeyError:
        raise HTTPException(404, "there is no such file") from None
    except InputError as error:
        raise HTTPException(503, str(error)) from None
    return Response(text, media_type="application/json")
