"""What asks of a path that whoever calls may call it."""

from collections.abc import Callable

from fastapi import HTTPException, Request
from starlette.requests import HTTPConnection

from rga.dashboard.access.access import Access
from rga.dashboard.access.roles import Right, Who


class NotLoggedIn(HTTPException):
    """Nobody who is known calls: a browser is led to the login."""

    def __init__(self) -> None:
        words = "log in, or send a token: Authorization: Bearer ..."
        super().__init__(401, words, {"WWW-Authenticate": "Bearer"})


def access_of(call: HTTPConnection) -> Access:
    """Users, sessions and tokens of the service that is called."""
    found: Access = call.app.state.access
    return found


def may(right: Right) -> Callable[[Request], Who]:
    """A dependency that gives who calls, if they may.

    Args:
        right: that they must have; of the twin that the path names as `{twin}`, if it does.

    Example: `def page(who: Annotated[Who, Depends(may("operator"))]) -> Response: ...`
    """

    def who(request: Request) -> Who:
        found = access_of(request).who_calls(request)
        if found is None:
            raise NotLoggedIn
        twin = request.path_params.get("twin")
        if twin is not None and found.twin not in (None, twin):
            raise HTTPException(403, f"{found.name} ({found.role}) is for twin {found.twin}")
        if not found.may(right, twin):
            raise HTTPException(403, f"{found.name} ({found.role}) may not do this")
        return found

    return who


def may_see_some(request: Request) -> Who:
    """A dependency that gives who calls, if they may look at one twin at least."""
    found = access_of(request).who_calls(request)
    if found is None:
        raise NotLoggedIn
    if not found.may("viewer", found.twin):
        raise HTTPException(403, f"{found.name} ({found.role}) may not do this")
    return found
