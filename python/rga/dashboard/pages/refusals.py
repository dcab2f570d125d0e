"""What is told of a call that cannot be answered: a page to a browser, JSON to programs."""

from collections.abc import Mapping

from fastapi import Request
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from rga.dashboard.access.login import is_browser, to_login
from rga.dashboard.access.may import NotLoggedIn, access_of
from rga.dashboard.pages.rendering import rendered

#: what the page is headed with, by its status
TITLES = {403: "This is not for you", 404: "There is no such page"}
OTHERWISE = "This cannot be shown"


def told_of_refusal(request: Request, error: Exception) -> Response:
    """Of a path that there is not, or that whoever calls may not call."""
    assert isinstance(error, HTTPException)
    return told(request, error.detail, error.status_code, error.headers)


def told(
    request: Request, words: str, status: int, headers: Mapping[str, str] | None = None
) -> Response:
    """Why a call is not answered."""
    if not is_browser(request):
        return JSONResponse({"detail": words}, status, headers)
    who = access_of(request).who_calls(request)
    if who is None:
        return to_login(request, NotLoggedIn())
    shown = {"title": TITLES.get(status, OTHERWISE), "words": words, "back": "/"}
    answer = rendered("refused", shown, who, live=False, status=status)
    answer.headers.update(headers or {})
    return answer
