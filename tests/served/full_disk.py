"""A disk that is full for a while: no database in a file grows."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from sqlalchemy import Connection, Engine, event

#: pages that no file has
MOST_PAGES = 2**31


class Disk:
    """What the databases of this process are kept on.

    Attributes:
        full: whether nothing grows.
        only: name of the one file that does not; None: none does.
    """

    def __init__(self) -> None:
        self.full = False
        self.only: str | None = None

    def limit(self, connection: Connection) -> None:
        """Let a database grow, or not, in the transaction that begins."""
        if connection.dialect.name != "sqlite":
            return
        path = str(connection.exec_driver_sql("PRAGMA database_list").all()[0][2])
        full = self.full and (self.only is None or path.endswith(self.only))
        # One page is fewer than any has: it stays as large as it is.
        connection.exec_driver_sql(f"PRAGMA max_page_count = {1 if full else MOST_PAGES}")


@contextmanager
def limited_disk() -> Iterator[Disk]:
    """A disk that tests fill."""
    disk = Disk()
    listening: Any = disk.limit
    event.listen(Engine, "begin", listening)
    try:
        yield disk
    finally:
        event.remove(Engine, "begin", listening)
