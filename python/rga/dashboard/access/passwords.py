"""Passwords: what one must be, and how it is kept (argon2id)."""

from functools import cache
from threading import Lock

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from rga.errors import InputError

#: letters of a password
LEAST, MOST = 10, 1000
_HASHER = PasswordHasher()
# A comparison takes 64 MB: one at a time, however many guess.
_ONE = Lock()


def hashed(password: str, name: str) -> str:
    """A password as it is kept.

    Args:
        password: in plain text.
        name: of its user.

    Raises:
        InputError: it is too short or too long, or the name itself.
    """
    where = f"password of {name!r}"
    if not LEAST <= len(password) <= MOST:
        raise InputError(
            f"it has {len(password)} letters", where, f"take {LEAST} to {MOST}, such as four words"
        )
    if password.casefold() == name.casefold():
        raise InputError("it is the name itself", where, "take another")
    with _ONE:
        return _HASHER.hash(_utf8(password))


def matches(password: str, kept: str) -> bool:
    """Whether a password is the one that is kept.

    >>> matches("four words of mine", hashed("four words of mine", "Ada"))
    True
    """
    if len(password) > MOST:
        return False
    with _ONE:
        try:
            return _HASHER.verify(kept, _utf8(password))
        except (VerificationError, InvalidHashError):
            return False


def _utf8(password: str) -> bytes:
    return password.encode("utf-8", "surrogatepass")


@cache
def nobodys() -> str:
    """What is compared with where there is no such user: the time it takes tells nothing."""
    return _HASHER.hash("of nobody")
