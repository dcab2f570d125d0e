"""What somebody may do."""

from dataclasses import dataclass
from typing import Literal

#: of a person
Role = Literal["viewer", "operator", "admin"]
#: what a token is for
Purpose = Literal["ingest", "read", "operate"]
#: what is asked of whoever calls: to send packets, to look, to decide, to rule over users
Right = Literal["ingest", "viewer", "operator", "admin"]

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
