"""The HTTP door of a service: its API, its pages, and what guards both."""

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response
from starlette.staticfiles import StaticFiles

from rga.dashboard.access.access import Access
from rga.dashboard.access.guard import Guard
from rga.dashboard.access.login import router as login
from rga.dashboard.access.login import to_login
from rga.dashboard.access.may import NotLoggedIn
from rga.dashboard.api import (
    alarms,
    commands,
    health,
    metrics,
    packets,
    past,
    readings,
    report,
    series,
    stream,
    twins,
    whatif,
)
from rga.dashboard.api.bounds import IntakeRoom, RateLimit
from rga.dashboard.api.following import FollowedTwin
from rga.dashboard.api.reports import Reports
from rga.dashboard.api.served import PREFIX
from rga.dashboard.bounded_body import BoundedBody
from rga.dashboard.pages.refusals import told, told_of_refusal
from rga.dashboard.pages.routes import router as pages
from rga.dashboard.surroundings import Surroundings
from rga.errors import InputError
from rga.operation.service import Service
from rga.settings_files import in_words
from rga.twin.repository.faults import RepositoryFault

#: name of the folder of reports, which is that of no twin
REPORTS = ".reports"


def app_of(service: Service, is_ending: Callable[[], bool] = lambda: False) -> FastAPI:
    """The API and the pages of a service.

    Args:
        service: that runs.
        is_ending: whether streams are to end.

    Raises:
        InputError: anybody could come in.
    """
    settings = service.configuration.service
    access, reports = Access(settings), Reports(settings.data / REPORTS)

    @asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        yield
        reports.close()
        access.close()

    app = FastAPI(
        title="rga",
        docs_url=None,
        redoc_url=None,
        openapi_url=f"{PREFIX}/openapi.json",
        lifespan=life,
    )
    app.state.access, app.state.reports = access, reports
    app.state.surroundings = known = Surroundings(service)
    app.state.followed = {name: FollowedTwin(known.twin(name)) for name in known.names}
    app.state.rate_limit, app.state.room = RateLimit(), IntakeRoom()
    app.state.is_ending = is_ending
    app.add_middleware(BoundedBody)
    app.add_middleware(Guard, access=access)
    app.add_exception_handler(NotLoggedIn, to_login)
    app.add_exception_handler(HTTPException, told_of_refusal)
    app.add_exception_handler(RequestValidationError, _told_of_mistake)
    app.add_exception_handler(InputError, _told_of_error)
    add_routes(app)
    app.mount("/static", StaticFiles(packages=[("rga.dashboard", "static")]), name="static")
    return app


def add_routes(app: FastAPI) -> None:
    """Give an application every path of the API and of the pages."""
    parts = (twins, readings, series, past, whatif, commands, alarms, packets, stream, report)
    for one in (*parts, health, metrics):
        app.router.routes += one.router.routes
    app.router.routes += [*login.routes, *pages.routes]


def _told_of_mistake(request: Request, error: Exception) -> Response:
    """Of a call that is not what its path takes: the first mistake, in words."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    place = ".".join(str(one) for one in first["loc"])
    return told(request, f"{place}: {in_words(first)}", 422)


def _told_of_error(request: Request, error: Exception) -> Response:
    """Of what cannot be done: 503 where it may be done later, else 422."""
    status = 503 if isinstance(error, RepositoryFault) else 422
    return JSONResponse({"detail": str(error)}, status)
