"""A file of tables that threads and processes read and write side by side."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, Self

from sqlalchemy import Connection, MetaData, Row, Table, insert, inspect, select
from sqlalchemy.dialects.sqlite import dialect

from rga.twin.repository.checksum import COLUMN
from rga.twin.repository.faults import as_input_errors, whole
from rga.twin.repository.sqlite import SQLite


class TableFile:
    """A file of tables whose entries have checksums.

    Args:
        path: of the file, which is made.
        metadata: of the tables that are made in it.
        read_only: nothing is written; the file must be there.

    Raises:
        InputError: the file cannot be written, or is none.
    """

    def __init__(self, path: Path, metadata: MetaData, *, read_only: bool = False) -> None:
        self._database = SQLite(path, read_only)
        if not read_only and not self._has(metadata):
            with self.writing() as connection:
                metadata.create_all(connection)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _has(self, metadata: MetaData) -> bool:
        # Whoever waits for something to be written is not to be told that a file was opened.
        with self.reading() as connection:
            return metadata.tables.keys() <= set(inspect(connection).get_table_names())

    def close(self) -> None:
        """Close the file; it opens again where it is asked more."""
        self._database.close()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction to read in.

        Raises:
            InputError: the file cannot be read, or an entry is not what was written.
        """
        with as_input_errors(self._database.where), self._database.engine.begin() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction that writes: what it did is on the disk when it ends, or nothing of it.

        Raises:
            InputError: the disk is full, or the file is damaged.
        """
        with self.reading() as connection:
            # Whoever reads before writing is refused when another has written meanwhile.
            connection.exec_driver_sql("PRAGMA user_version = 1")
            yield connection


def put(
    connection: Connection,
    table: Table,
    entries: Sequence[Mapping[str, Any]],
    *,
    replacing: bool = False,
) -> None:
    """Put entries in a table, each with all of its columns, as the driver takes them.

    Args:
        connection: of a transaction that writes.
        table: that they are of.
        entries: of texts, bytes and plain numbers.
        replacing: those of the same keys.
    """
    names = table.columns.keys()
    rows = [tuple([entry[name] for name in names]) for entry in entries]
    if rows:
        connection.exec_driver_sql(_putting(table, replacing), rows)


@cache
def _putting(table: Table, replacing: bool) -> str:
    statement = insert(table).prefix_with("OR REPLACE") if replacing else insert(table)
    return str(statement.compile(dialect=dialect()))


def values_of(table: Table, entry: Row[Any]) -> dict[str, Any]:
    """The columns of an entry without its checksum.

    Raises:
        NotWhole: it is not what was written.
    """
    values = whole(table, entry)._asdict()
    values.pop(COLUMN)
    return values


def only_entry(connection: Connection, table: Table) -> dict[str, Any] | None:
    """The values of a table of one entry; None where it has none."""
    found = connection.execute(select(table)).one_or_none()
    return None if found is None else values_of(table, found)
