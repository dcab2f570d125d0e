"""The page to log in, and the way out."""

from math import ceil
from typing import Annotated
from urllib.parse import parse_qs, quote

from fastapi import APIRouter, Depends, HTTPException, Request
from jinja2 import Environment, PackageLoader, select_autoescape
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response

from rga.dashboard.access.access import COOKIE, Access
from rga.dashboard.access.may import NotLoggedIn, access_of
from rga.dashboard.access.sessions import IDLE

#: bytes of what a form says
MOST_BYTES = 10_000
router = APIRouter(include_in_schema=False)
_TEMPLATES = Environment(
    loader=PackageLoader("rga.dashboard.access"), autoescape=select_autoescape()
)
_Given = Annotated[Access, Depends(access_of)]


@router.get("/login")
def page(next: str = "/") -> HTMLResponse:
    """The page to log in."""
    return _page(next)


@router.post("/login")
async def log_in(request: Request, access: _Given) -> Response:
    """Log in, and go on to where somebody wanted to."""
    form = await _form_of(request)
    name, password, target = (form.get(key, "") for key in ("name", "password", "next"))
    origin = access.origin_of(request)
    found = await run_in_threadpool(access.log_in, name, password, origin)
    if isinstance(found, str):
        answer = RedirectResponse(_own(target), 303)
        answer.set_cookie(
            COOKIE, found, max_age=int(IDLE), secure=origin.secure, httponly=True, samesite="strict"
        )
        return answer
    if found > 0:
        wait = ceil(found)
        words = f"Too many tries: wait for {wait} s."
        return _page(target, words, 429, {"Retry-After": str(wait)})
    return _page(target, "No such name with this password.", 401)


@router.post("/logout")
def log_out(request: Request, access: _Given) -> Response:
    """End the session of a browser."""
    access.log_out(request.cookies.get(COOKIE, ""), access.origin_of(request))
    answer = RedirectResponse("/login", 303)
    answer.delete_cookie(COOKIE, httponly=True, samesite="strict")
    return answer


def to_login(request: Request, error: Exception) -> Response:
    """What somebody who is not logged in gets: a browser the page to log in, others an error."""
    assert isinstance(error, NotLoggedIn)
    if is_browser(request):
        return RedirectResponse(f"/login?next={quote(request.url.path)}", 303)
    return JSONResponse({"detail": error.detail}, error.status_code, error.headers)


def is_browser(request: Request) -> bool:
    """Whether a page is wanted."""
    asked = "text/html" in request.headers.get("accept", "")
    return asked and not request.url.path.startswith("/api/")


def _page(
    target: str, words: str = "", status: int = 200, headers: dict[str, str] | None = None
) -> HTMLResponse:
    html = _TEMPLATES.get_template("login.html").render(next=_own(target), words=words)
    return HTMLResponse(html, status, headers)


def _own(target: str) -> str:
    """A path of this service, whatever is asked for.

    >>> _own("/twins/east"), _own("//elsewhere"), _own("/\\\\elsewhere"), _own("https://elsewhere")
    ('/twins/east', '/', '/', '/')
    """
    # Browsers take a backslash for a slash, and pass over line breaks.
    own = target[:1] == "/" and target[1:2] not in ("/", "\\") and target.isprintable()
    return target if own else "/"


async def _form_of(request: Request) -> dict[str, str]:
    """The fields of a form, each once."""
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > MOST_BYTES:
            raise HTTPException(413, f"a form has {MOST_BYTES} bytes at most")
    try:
        fields = parse_qs(body.decode(), max_num_fields=10)
    except ValueError:
        raise HTTPException(400, "this is no form") from None
    return {name: values[0] for name, values in fields.items()}
