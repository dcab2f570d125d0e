"""What a database driver complains of, as an error for the user."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy.exc import DBAPIError, OperationalError

from rga.errors import InputError

# By the beginning of SQLite's name of the error, and by PostgreSQL's state.
_MENDED = {
    "SQLITE_NOTADB": ("the file is no repository", "name a file that rga wrote, or a new one"),
    "SQLITE_CORRUPT": ("the repository is damaged", "restore it from a copy"),
    "SQLITE_BUSY": ("the repository is locked by another process", "wait for it, or end it"),
    "SQLITE_LOCKED": ("the repository is locked by another process", "wait for it, or end it"),
    "SQLITE_PROTOCOL": ("the repository cannot be locked", "keep it on a local disk"),
    "SQLITE_CANTOPEN": ("the repository cannot be opened", "name a file in a writable directory"),
    "SQLITE_PERM": ("the repository cannot be opened", "allow access to the file"),
    "SQLITE_READONLY": (
        "the repository cannot be written",
        "allow writing to it and its directory",
    ),
    "SQLITE_FULL": ("the disk of the repository is full", "make room"),
    "SQLITE_IOERR": ("the disk of the repository fails", "check the disk"),
    "55P03": ("another process writes this run", "wait for it, or end it"),
    "42501": ("the server allows too little", "grant this user CREATE on the schema"),
    "25006": ("the server allows reading only", "name a server that accepts writing"),
}


class RepositoryFault(InputError):
    """What keeps a repository from being used for now: whatever was begun may be done later."""


class InUse(RepositoryFault):
    """Another process writes there."""


#: what says that another process writes there
_LOCKED = ("SQLITE_BUSY", "55P03")


@contextmanager
def as_input_errors(where: str) -> Iterator[None]:
    """Turns what a user can mend into an InputError; other faults pass."""
    try:
        yield
    except DBAPIError as error:
        name = getattr(error.orig, "sqlite_errorname", None)
        name = name or getattr(error.orig, "sqlstate", None) or ""
        for beginning, (what, remedy) in _MENDED.items():
            if name.startswith(beginning):
                kind = InUse if name in _LOCKED else RepositoryFault
                raise kind(what, where, remedy) from error
        if isinstance(error, OperationalError) and not name.startswith("SQLITE_"):
            words = str(error.orig).strip().partition("\n")[0]
            remedy = "check the URL, and that the server runs and lets you in"
            raise RepositoryFault(f"the server says: {words}", where, remedy) from error
        raise
