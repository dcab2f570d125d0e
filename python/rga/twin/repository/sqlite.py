"""A repository in a file: SQLite, one writer for the file."""

import glob
import logging
import os
import shutil
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path

from sqlalchemy import Connection, QueuePool, create_engine, event

from rga.errors import InputError
from rga.inputs import remember
from rga.one_writer import Held, only_writer
from rga.twin.repository.faults import DiskFull, InUse

# Of a connection that a signal meets as it is closed; the signal itself is told.
logging.getLogger("sqlalchemy.pool").addHandler(logging.NullHandler())

# How long to wait for a lock [s]: a killed writer's may need a moment to vanish.
PATIENCE = 2.0


class SQLite:
    """Connections to a file, for all or for reading only.

    Args:
        path: of the file.
        read_only: nothing is written.
        patience: how long to wait for another writer [s].
        journal: of SQLite, for writing.

    Raises:
        InputError: the file is missing where it is only to be read, or cannot be written.
    """

    def __init__(
        self, path: Path, read_only: bool, patience: float = PATIENCE, journal: str = "WAL"
    ) -> None:
        self.where = f"repository {path}"
        self.read_only = read_only
        self._path, self._patience, self._journal = path, patience, journal
        if path.is_dir():
            raise InputError("this is a directory", self.where, "name a file, or its directory")
        if read_only and not path.is_file():
            raise InputError("there is no such file", self.where, "name a repository of a run")
        if not read_only and not os.access(path if path.exists() else path.parent, os.W_OK):
            remedy = "name a file in a directory that exists and can be written"
            raise InputError("the repository cannot be written", self.where, remedy)
        self._begun_by_another = self._log.exists()
        self.engine = create_engine("sqlite://", creator=self._connect, poolclass=QueuePool)
        event.listen(self.engine, "begin", _begin)

    def _connect(self) -> sqlite3.Connection:
        query = "mode=ro" if self.read_only else "mode=rwc"
        if self.read_only and not (self._log.exists() or os.access(self._path.parent, os.W_OK)):
            # SQLite cannot put its files beside a database on a medium that is read-only.
            query += "&immutable=1"
        connection = self._opened(query)
        remember(self._path)
        try:
            self._set_up(connection)
        except BaseException:
            connection.close()
            raise
        return connection

    def _opened(self, query: str) -> sqlite3.Connection:
        return sqlite3.connect(
            f"{self._path.absolute().as_uri()}?{query}",
            uri=True,
            timeout=PATIENCE,
            isolation_level=None,
            check_same_thread=False,
        )

    def close(self) -> None:
        """Close all connections, and leave no file that was not there."""
        self.engine.dispose()
        if self.read_only and not self._begun_by_another and self._log.exists():
            # SQLite removes its own files with the last connection, unless that only reads.
            # Of what is damaged, SQLite tells in words that may not be text.
            told = (sqlite3.Error, UnicodeDecodeError)
            with suppress(*told), closing(self._opened("mode=rw")) as connection:
                connection.execute("SELECT * FROM sqlite_master")

    def _set_up(self, connection: sqlite3.Connection) -> None:
        if not self.read_only:
            # Of a new file: less of its last page is left empty by what a step stores.
            connection.execute("PRAGMA page_size = 2048")
            connection.execute(f"PRAGMA journal_mode = {self._journal}")
        # What is acknowledged survives a power cut; fullfsync is what that takes on macOS.
        connection.execute("PRAGMA synchronous = FULL")
        connection.execute("PRAGMA fullfsync = ON")
        connection.execute("PRAGMA foreign_keys = ON")

    @property
    def _log(self) -> Path:
        return self._path.with_name(f"{self._path.name}-wal")

    @contextmanager
    def writer(self, key: str) -> Iterator[Connection]:
        """The connection of the one writer; the system drops its lock if the process is killed.

        Raises:
            InUse: another writer holds the lock.
        """
        with self._alone(), self.engine.connect() as connection:
            yield connection

    def begin(self, fill: Callable[[Connection], None]) -> None:
        """Make the file where it is missing, with its tables or not at all."""
        if self.read_only or self._path.exists():
            return
        with self._alone():
            # A log of writing would be brought into the file as it is closed, unless the disk is
            # full, which nothing tells.
            file = self._path.with_name(f"{self._path.name}.draft")
            draft = SQLite(file, read_only=False, journal="DELETE")
            draft._remove()
            try:
                with draft.engine.begin() as connection:
                    fill(connection)
                draft.close()
                if not self._path.exists():
                    draft._path.replace(self._path)
            finally:
                draft.close()
                draft._remove()

    def _remove(self) -> None:
        for file in self._path.parent.glob(f"{glob.escape(self._path.name)}*"):
            file.unlink()

    @contextmanager
    def _alone(self) -> Iterator[None]:
        with ExitStack() as held:
            try:
                held.enter_context(only_writer(self._path, self._patience, stays=True))
            except Held as error:
                raise InUse(error.what, self.where, error.remedy) from None
            yield

    def inspect(self, connection: Connection) -> list[str]:
        """What is wrong with pages and indices of the file, in words."""
        found = connection.exec_driver_sql("PRAGMA integrity_check(20)").scalars().all()
        return [] if found == ["ok"] else [str(one) for one in found]

    def back_up(self, revision: str | None) -> None:
        """Copy the file beside itself, named after the revision of its tables.

        Raises:
            DiskFull: there is no room for the copy, and for what the file grows by meanwhile.
        """
        if shutil.disk_usage(self._path.parent).free < 2 * self._path.stat().st_size:
            what = "its tables are to be brought up to date, and the disk has no room for a copy"
            raise DiskFull(what, self.where, "make room for twice its size")
        copy = self._path.with_name(f"{self._path.name}.revision-{revision}")
        draft = copy.with_name(f"{copy.name}.draft")
        draft.unlink(missing_ok=True)
        connection = self._connect()
        try:
            connection.execute("VACUUM INTO ?", (str(draft),))
        finally:
            connection.close()
        draft.replace(copy)


def _begin(connection: Connection) -> None:
    # The driver by itself begins no transaction before the first change, and none for tables.
    connection.exec_driver_sql("BEGIN")
