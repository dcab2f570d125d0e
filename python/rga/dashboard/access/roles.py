"""What somebody may do."""

from dataclasses import dataclass
from typing import Literal, get_args

from rga.errors import InputError

#: of a person
Role = Literal["viewer", "operator", "admin"]
#: what a token is for
Purpose = Literal["ingest", "read", "operate"]
#: what is asked of whoever calls: to send packets, to look, to decide, to rule over users
Right = Literal["ingest", "viewer", "operator", "admin"]

_ROLES: tuple[Role, ...] = get_args(Role)
_PURPOSES: tuple[Purpose, ...] = get_args(Purpose)
_RIGHTS: dict[str, frozenset[Right]] = {
    "ingest": frozenset({"ingest"}),
    "read": frozenset({"viewer"}),
    "operate": frozenset({"viewer", "operator"}),
    "viewer": frozenset({"viewer"}),
    "operator": frozenset({"ingest", "viewer", "operator"}),
    "admin": frozenset({"ingest", "viewer", "operator", "admin"}),
}


@dataclass(frozen=True)
class Who:
    """Somebody who calls.

    Attributes:
        name: of a person; of a token, the words that it was given.
        role: of a person, or what a token is for.
        twin: the only one that a token is for; None: all.
        session: whether a browser is logged in, and can log out.

    >>> Who("Ada", "viewer").may("viewer"), Who("Ada", "viewer").may("operator")
    (True, False)
    """

    name: str
    role: Role | Purpose
    twin: str | None = None
    session: bool = False

    def may(self, right: Right, twin: str | None = None) -> bool:
        """Whether something is allowed, of one twin or of all.

        >>> logger = Who("logger", "ingest", twin="east")
        >>> logger.may("ingest", "east"), logger.may("ingest", "west"), logger.may("ingest")
        (True, False, False)
        """
        return right in _RIGHTS[self.role] and self.twin in (None, twin)


def role_named(given: str, where: str) -> Role:
    """A role by its name.

    Raises:
        InputError: it is none.
    """
    for one in _ROLES:
        if one == given:
            return one
    raise _unknown(f"{given!r} is no role", where, _ROLES)


def purpose_named(given: str, where: str) -> Purpose:
    """A purpose by its name.

    Raises:
        InputError: it is none.
    """
    for one in _PURPOSES:
        if one == given:
            return one
    raise _unknown(f"no token is for {given!r}", where, _PURPOSES)


def _unknown(what: str, where: str, known: tuple[str, ...]) -> InputError:
    return InputError(what, where, f"take one of {', '.join(known)}")
