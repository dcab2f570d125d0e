"""Twins that a worker cannot play: it says so in the file of the service, which outlives it."""

from collections.abc import Mapping

from sqlalchemy import delete, insert, select

from rga.operation.alarms import tables
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of


class WorkerFailures:
    """What workers cannot play, and why.

    Args:
        file: of the service, with the tables of alarms.
    """

    def __init__(self, file: TableFile) -> None:
        self._file = file

    def tell(self, worker: str, failed: Mapping[str, str]) -> None:
        """A worker says which twins it cannot play now, in place of what it said before.

        Raises:
            InputError: nothing can be written.
        """
        table = tables.failure
        entries = [
            with_checksum(worker=worker, twin=twin, words=words) for twin, words in failed.items()
        ]
        with self._file.writing() as connection:
            connection.execute(delete(table).where(table.c.worker == worker))
            if entries:
                connection.execute(insert(table), entries)

    def now(self) -> dict[str, str]:
        """Why twins cannot be played, by their names."""
        with self._file.reading() as connection:
            found = connection.execute(select(tables.failure)).all()
            entries = [values_of(tables.failure, one) for one in found]
        return {one["twin"]: one["words"] for one in entries}
