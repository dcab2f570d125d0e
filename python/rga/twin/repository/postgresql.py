"""A repository in a database server: PostgreSQL, one writer for each run."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sqlalchemy import URL, Connection, Engine, create_engine, text

from rga.errors import InputError

_LOCK = text("SELECT pg_advisory_lock(hashtextextended(current_schema() || ' ' || :key, 0))")


#: how long to wait for a lock [s]
PATIENCE = 2.0


class PostgreSQL:
    """Connections to a database, for all or for reading only.

    Args:
        url: of it.
        read_only: nothing is written.
        patience: how long to wait for another writer [s].

    Raises:
        InputError: the driver is not installed.
    """

    def __init__(self, url: URL, read_only: bool, patience: float = PATIENCE) -> None:
        self.where = f"repository {url.render_as_string(hide_password=True)}"
        self.read_only, self._patience = read_only, patience
        try:
            engine = create_engine(url)
        except ImportError as error:
            remedy = "install it: pip install 'rga[postgres]'"
            raise InputError("PostgreSQL needs the driver psycopg", self.where, remedy) from error
        self.engine: Engine = engine.execution_options(postgresql_readonly=read_only)

    @contextmanager
    def writer(self, key: str) -> Iterator[Connection]:
        """The connection of the one writer under this key; the lock ends with the connection.

        Raises:
            sqlalchemy.exc.OperationalError: another writer holds the lock.
        """
        with self.engine.connect() as connection:
            # Not handed back to the pool: closing it ends the session, and with it the lock.
            connection.detach()
            with connection.begin():
                # None at all would be to wait for ever.
                wait = max(1, round(1000 * self._patience))
                connection.execute(text(f"SET LOCAL lock_timeout = '{wait}ms'"))
                connection.execute(_LOCK, {"key": key})
                connection.execute(text("SET synchronous_commit = on"))
            yield connection

    def close(self) -> None:
        """Close all connections."""
        self.engine.dispose()

    def begin(self, fill: Callable[[Connection], None]) -> None:
        """Nothing: whoever runs a server makes its databases."""

    def inspect(self, connection: Connection) -> list[str]:
        """Nothing: a server watches over its own files."""
        return []

    def back_up(self, revision: str | None) -> None:
        """Nothing: those who run a server back it up, and a migration is one transaction."""
