"""Random secrets that are shown once and kept as a hash."""

import hashlib
import secrets
from collections.abc import Callable

#: seconds since 1970 (UTC)
Clock = Callable[[], float]


def drawn() -> str:
    """A secret of 256 random bits, as text."""
    return secrets.token_urlsafe(32)


def digest(secret: str) -> str:
    """What is kept of it: nobody can guess 256 bits, so that no slow hash is needed.

    >>> digest("a")[:8]
    'ca978112'
    """
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()
