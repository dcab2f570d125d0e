"""What a database driver complains of, and what is damaged, as an error for the user."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from sqlalchemy import Row, Table
from sqlalchemy.exc import DBAPIError, OperationalError

from rga.errors import InputError
from rga.twin.repository.checksum import is_whole
from rga.twin.repository.chunks import LONGEST

# By the beginning of SQLite's name of the error, and by PostgreSQL's state.
_MENDED = {
    "SQLITE_NOTADB": ("the file is no repository", "name a file that rga wrote, or a new one"),
    "SQLITE_BUSY": ("the repository is locked by another process", "wait for it, or end it"),
    "SQLITE_LOCKED": ("the repository is locked by another process", "wait for it, or end it"),
    "SQLITE_PROTOCOL": ("the repository cannot be locked", "keep it on a local disk"),
    "SQLITE_CANTOPEN": ("the repository cannot be opened", "name a file in a writable directory"),
    "SQLITE_PERM": ("the repository cannot be opened", "allow access to the file"),
    "SQLITE_READONLY": (
        "the repository cannot be written",
        "allow writing to it and its directory",
    ),
    "SQLITE_TOOBIG": ("too much for one entry", "give it less at once"),
    "SQLITE_FULL": ("the disk of the repository is full", "make room"),
    "SQLITE_IOERR": ("the disk of the repository fails or is full", "make room, or check the disk"),
    "55P03": ("another process writes this run", "wait for it, or end it"),
    "42501": ("the server allows too little", "grant this user CREATE on the schema"),
    "25006": ("the server allows reading only", "name a server that accepts writing"),
}


class RepositoryFault(InputError):
    """What keeps a repository from being used for now: whatever was begun may be done later."""


class InUse(RepositoryFault):
    """Another process writes there."""


class DiskFull(RepositoryFault):
    """There is no room."""


class Damaged(RepositoryFault):
    """What is there is not what was written."""


class NothingThere(InputError):
    """Nothing was ever written there."""


class NotWhole(Exception):
    """An entry does not hold what was written, in words."""


#: rows that no record has
MOST_ROWS = 2**40
_KINDS = {"SQLITE_BUSY": InUse, "55P03": InUse, "SQLITE_FULL": DiskFull}


@contextmanager
def as_input_errors(where: str) -> Iterator[None]:
    """Turns what a user can mend into an InputError; other faults pass."""
    try:
        yield
    except NotWhole as error:
        raise _damaged(str(error), where) from error
    except UnicodeDecodeError as error:
        # SQLite tells of damage in words that hold it.
        raise _damaged("what it is built of cannot be read", where) from error
    except DBAPIError as error:
        name = getattr(error.orig, "sqlite_errorname", None)
        name = name or getattr(error.orig, "sqlstate", None) or ""
        for beginning, (what, remedy) in _MENDED.items():
            if name.startswith(beginning):
                raise _KINDS.get(name, RepositoryFault)(what, where, remedy) from error
        words = str(error.orig).strip().partition("\n")[0]
        if isinstance(error.orig, sqlite3.Error):
            raise _damaged(words, where) from error
        if isinstance(error, OperationalError):
            remedy = "check the URL, and that the server runs and lets you in"
            raise RepositoryFault(f"the server says: {words}", where, remedy) from error
        raise


def _damaged(words: str, where: str) -> Damaged:
    remedy = (
        "restore it from a copy; rga replay --check lists the damage, and rga export saves the "
    )
    remedy += "rows that were taken in and can be read"
    return Damaged(f"the repository is damaged: {words}", where, remedy)


def whole(table: Table, entry: Row[Any]) -> Row[Any]:
    """An entry with all columns of its table, as it was written.

    Raises:
        NotWhole: it is not.
    """
    if is_whole(dict(zip(table.columns.keys(), entry, strict=True))):
        return entry
    raise NotWhole(f"{named(table, entry)} is not what was written")


def could_be(table: Table, entry: Row[Any]) -> Row[Any]:
    """Some columns of an entry, if an entry can hold them.

    Raises:
        NotWhole: they cannot be.
    """
    values = entry._mapping
    numbers = [values[name] for name in ("first_row", "length") if name in values]
    arrays = [one for one in values.values() if isinstance(one, bytes)]
    size = values.get("length", 1)
    if all(isinstance(one, int) and 0 <= one < MOST_ROWS for one in numbers) and (
        0 < size <= LONGEST and not any(len(one) % (8 * size) for one in arrays)
    ):
        return entry
    raise NotWhole(f"{named(table, entry)} is nothing that is written")


def named(table: Table, entry: Row[Any]) -> str:
    """Which entry it is, in words."""
    values = entry._mapping
    key = [f"{one.name} {values[one.name]}" for one in table.primary_key if one.name in values]
    return " ".join([f"an entry of {table.name}", *key]).replace("run_id", "run")
