"""What every answer carries, and every change must: headers that keep other pages out."""

from urllib.parse import urlsplit

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rga.dashboard.access.access import COOKIE, Access

#: methods that change nothing
_SAFE = ("GET", "HEAD", "OPTIONS")
# Drawings carry their style in attributes; nothing but that stands within a page.
POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    # Without a referrer, browsers send no origin with a form either.
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Cache-Control": "no-store",
}
_A_YEAR = "max-age=31536000"


class Guard:
    """Refuses changes that another page asks for, and adds headers to every answer.

    Args:
        app: that is guarded.
        access: of the service.
    """

    def __init__(self, app: ASGIApp, access: Access) -> None:
        self._app, self._access = app, access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a call on, or refuse it."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        secure = self._access.origin_of(request).secure

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers.setdefault(name, value)
                if secure:
                    headers["Strict-Transport-Security"] = _A_YEAR
            await send(message)

        if request.method in _SAFE or _is_asked_by_own_page(request, secure):
            await self._app(scope, receive, with_headers)
        else:
            words = "another page asks for this change"
            await JSONResponse({"detail": words}, 403)(scope, receive, with_headers)


def _is_asked_by_own_page(request: Request, secure: bool) -> bool:
    """Whether a page of this service, or a program that is no browser, asks."""
    if request.headers.get("sec-fetch-site") in ("cross-site", "same-site"):
        return False
    origin = request.headers.get("origin")
    if origin is None:
        # Browsers send it with every change; only what lacks their cookie can be something else.
        return COOKIE not in request.cookies
    parts = urlsplit(origin)
    own = ("https" if secure else "http", request.headers.get("host", "").casefold())
    return (parts.scheme, parts.netloc.casefold()) == own
