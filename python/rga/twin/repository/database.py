"""Which database a place names."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Protocol

from sqlalchemy import Connection, Engine, make_url
from sqlalchemy.exc import ArgumentError

from rga.errors import InputError
from rga.files import as_path
from rga.twin.repository.postgresql import PostgreSQL
from rga.twin.repository.sqlite import PATIENCE, SQLite

FILE_NAME = "twin.sqlite"


class Database(Protocol):
    """What a repository needs of its database; `where` names it in errors."""

    where: str
    read_only: bool
    engine: Engine

    def writer(self, key: str) -> AbstractContextManager[Connection]:
        """A connection that only one process holds at a time."""

    def close(self) -> None:
        """Close all connections, and leave no file that was not there."""

    def begin(self, fill: Callable[[Connection], None]) -> None:
        """Make what holds the tables where that is this package's business, and fill it."""

    def inspect(self, connection: Connection) -> list[str]:
        """What is wrong with how the database itself is built, in words."""

    def back_up(self, revision: str | None) -> None:
        """Copy what is there before its tables change, where that is this package's business."""


def database(place: str | Path, read_only: bool, patience: float = PATIENCE) -> Database:
    """The database at a path (a file, or a directory that holds `twin.sqlite`) or a URL.

    Args:
        place: it.
        read_only: nothing is written.
        patience: how long to wait for another writer [s].

    Raises:
        InputError: the URL cannot be read or is not PostgreSQL's, the driver is missing, or the
            file is missing or cannot be written.
    """
    if isinstance(place, str) and "://" in place:
        remedy = "name a file, or a server as postgresql://user@host/database"
        try:
            url = make_url(place)
        except (ArgumentError, ValueError) as error:
            raise InputError("the URL cannot be read", "repository", remedy) from error
        if url.drivername not in ("postgresql", "postgresql+psycopg"):
            where = f"repository {url.render_as_string(hide_password=True)}"
            raise InputError(f"no repository is kept in {url.drivername!r}", where, remedy)
        return PostgreSQL(url.set(drivername="postgresql+psycopg"), read_only, patience)
    path = as_path(place, "repository")
    held = path.is_dir() and path.name != FILE_NAME
    return SQLite(path / FILE_NAME if held else path, read_only, patience)
