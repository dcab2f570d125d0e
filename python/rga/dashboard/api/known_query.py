"""Paths of the API that refuse what they would not look at: keys of a query that they do not know.

Whoever asks for `?form=` in place of `?from=` would be answered with all there is.
"""

from collections.abc import Callable, Sequence
from typing import Any

from fastapi import Depends, HTTPException, Request
from fastapi.dependencies.models import Dependant
from fastapi.params import Depends as Needed
from fastapi.routing import APIRoute


class KnownQueryRoute(APIRoute):
    """A path that refuses keys of a query that it does not know, once it knows who calls."""

    def __init__(
        self,
        path: str,
        endpoint: Callable[..., Any],
        *,
        dependencies: Sequence[Needed] | None = None,
        **more: Any,
    ) -> None:
        needed = [*(dependencies or ()), Depends(_check_query)]
        super().__init__(path, endpoint, dependencies=needed, **more)
        self.known_query = _query_keys(self.dependant)


def _check_query(request: Request) -> None:
    """Whether the path knows every key of the query.

    Raises:
        HTTPException: it does not know one.
    """
    known: set[str] = request.scope["route"].known_query
    if unknown := next((key for key in request.query_params if key not in known), None):
        told = f"known are {', '.join(sorted(known))}" if known else "there are none here"
        raise HTTPException(422, f"query.{unknown[:100]}: there is no such key: {told}")


def _query_keys(needed: Dependant) -> set[str]:
    """Keys of a query that a path takes, itself or by what it depends on."""
    own = {one.alias for one in needed.query_params}
    return own.union(*map(_query_keys, needed.dependencies))
