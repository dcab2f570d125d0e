"""The repository: runs, found by their identity, in a file or a database server."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, Self
from weakref import finalize

from sqlalchemy import Connection, Row, insert, select

from rga.errors import InputError
from rga.twin.repository import migrations, tables
from rga.twin.repository.database import Database, database
from rga.twin.repository.entries import Identity
from rga.twin.repository.faults import NothingThere, NotWhole, as_input_errors, named, whole
from rga.twin.repository.proof import Proof, prove
from rga.twin.repository.source import Source
from rga.twin.repository.sqlite import PATIENCE
from rga.twin.repository.step import Transaction, now
from rga.twin.repository.view import RunView


class Run(RunView):
    """A run that this process writes; the lock is held until `close`.

    Its readers see what an open step has stored so far.
    """

    def __init__(self, connection: Connection, where: str, entry: Row[Any], held: ExitStack):
        super().__init__(Source(self._reading, entry.id), *_of(entry))
        self._connection = connection
        self._where = where
        self._held = held
        self._pages: dict[str, list[bytes]] = {}

    @contextmanager
    def step(self) -> Iterator[Transaction]:
        """Store all that the `with` block writes, acknowledged at its end, or nothing of it.

        Raises:
            InputError: the disk is full, the server is lost, or the like.
        """
        pages = self._pages.copy()
        with as_input_errors(self._where), self._transaction():
            step = Transaction(self._connection, self._source.run_id, pages)
            yield step
            step.end()
        self._pages = pages

    def state(self, name: str) -> bytes | None:
        """What the last step left under a name for a run that goes on; None where none did."""
        c = tables.state_page.c
        with self._reading() as connection:
            of_name = (c.run_id == self._source.run_id) & (c.name == name)
            found = connection.execute(
                select(tables.state_page).where(of_name).order_by(c.page)
            ).all()
            pages = [whole(tables.state_page, one) for one in found]
            if [one.page for one in pages] != list(range(len(pages))):
                raise NotWhole(f"pages of the state {name!r} are missing")
        return b"".join(one.data for one in pages) if pages else None

    def close(self) -> None:
        """Let another process write."""
        self._held.close()

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        # SQLAlchemy would connect again by itself, and the new session would have no lock.
        if self._connection.invalidated:
            raise InputError("the server was lost", self._where, "run again: the run resumes")
        with self._connection.begin():
            yield

    @contextmanager
    def _reading(self) -> Iterator[Connection]:
        with as_input_errors(self._where), ExitStack() as own:
            if not self._connection.in_transaction():
                own.enter_context(self._transaction())
            yield self._connection


class Repository:
    """A historical repository; close it, or use it in a `with` block.

    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as directory, Repository.open(directory) as repository:
    ...     run = repository.run(Identity("model", "record", 1, "{}"))
    ...     with run.step() as step:
    ...         step.measured(0, [0.0, 60.0], [[1.5], [1.7]], [[20.0], [20.5]])
    ...     run.measured(first=1).readings
    array([[1.7]])
    """

    def __init__(self, kept_in: Database) -> None:
        self._database = kept_in
        self._held = ExitStack()
        if kept_in.read_only:
            # Nothing but connections goes with it: Python may close what nobody has closed.
            finalize(self, kept_in.close)

    @classmethod
    def open(
        cls, place: str | Path, *, read_only: bool = False, patience: float = PATIENCE
    ) -> Self:
        """Open or begin a repository, and bring its tables to where the code is.

        Args:
            place: a file, a directory that holds `twin.sqlite`, or the URL of a PostgreSQL
                database, `postgresql://user@host/database`.
            read_only: take no lock and change nothing; the repository must be there.
            patience: how long to wait for another writer [s].

        Raises:
            InputError: what is there is no repository, is newer than the code, is locked, cannot
                be read or written, or is out of reach; the driver of PostgreSQL is missing.
        """
        repository = cls(database(place, read_only, patience))
        try:
            repository._prepare()
        except BaseException:
            repository.close()
            raise
        return repository

    def run(self, identity: Identity) -> Run:
        """The run with this identity, begun if it is new, for writing.

        A file has one writer at a time, a server one for each run.

        Raises:
            InputError: another writer is there, or the repository is open for reading only.
        """
        kept_in = self._database
        if kept_in.read_only:
            raise InputError("nothing can be written", kept_in.where, "open it for writing")
        with as_input_errors(kept_in.where), ExitStack() as held:
            connection = held.enter_context(kept_in.writer(identity.key))
            of_identity = select(tables.run).where(tables.run.c.key == identity.key)
            with connection.begin():
                entry = connection.execute(of_identity).one_or_none()
                if entry is None:
                    connection.execute(insert(tables.run).values(**_columns(identity)))
                    entry = connection.execute(of_identity).one()
            run = Run(connection, kept_in.where, entry, held.pop_all())
        self._held.callback(run.close)
        return run

    def runs(self) -> tuple[RunView, ...]:
        """All runs, in the order in which they were begun."""
        with self._reading() as connection:
            entries = connection.execute(select(tables.run).order_by(tables.run.c.id)).all()
            views = [RunView(Source(self._reading, one.id), *_of(one)) for one in entries]
        return tuple(views)

    def latest(self, source: str | None = None) -> RunView:
        """The run last acted on.

        Args:
            source: of its rows, as its identity has it; None: any.

        Raises:
            InputError: nothing has run here.
        """
        runs = [one for one in self.runs() if source in (None, one.identity.source)]
        if not runs:
            what = "nothing" if source is None else f"no {source!r}"
            raise InputError(f"{what} has run here", self._database.where, "begin with rga run")
        return max(runs, key=lambda view: view.acknowledged_at)

    def check(self) -> Proof:
        """Read all that is here, and prove that it is what was written.

        Raises:
            InputError: it cannot be read at all.
        """
        with self._reading() as connection:
            broken = self._database.inspect(connection)
        proof = prove(self._reading)
        return Proof(len(self.runs()) + proof.entries, (*broken, *proof.damage))

    def close(self) -> None:
        """Close all connections; the lock of a run goes with them."""
        self._held.close()
        self._database.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @contextmanager
    def _reading(self) -> Iterator[Connection]:
        with as_input_errors(self._database.where), self._database.engine.begin() as connection:
            yield connection

    def _prepare(self) -> None:
        where, read_only = self._database.where, self._database.read_only
        with as_input_errors(where):
            self._database.begin(migrations.upgrade)
        with self._reading() as connection:
            state = migrations.state(connection)
        if state == "foreign" or (state == "empty" and read_only):
            remedy = "name a repository that rga wrote, or a new one"
            kind = NothingThere if state == "empty" else InputError
            raise kind("this is no repository", where, remedy)
        if state == "newer":
            raise InputError("the repository is newer than this rga", where, "install a newer rga")
        if state == "older" and read_only:
            remedy = "open it for writing once: rga run brings it up to date"
            raise InputError("the repository is older than this rga", where, remedy)
        if state in ("empty", "older"):
            with as_input_errors(where), self._database.writer("migration") as connection:
                if state == "older":
                    with connection.begin():
                        held = migrations.revision(connection)
                    self._database.back_up(held)
                with connection.begin():
                    migrations.upgrade(connection)


def _columns(identity: Identity) -> dict[str, Any]:
    return {
        "key": identity.key,
        "model_sha256": identity.model_sha256,
        "source": identity.source,
        "seed": identity.seed,
        "settings": identity.settings,
        "begun_at": now(),
    }


def _of(entry: Row[Any]) -> tuple[Identity, datetime]:
    """What distinguishes a run, and when it was begun.

    Raises:
        NotWhole: it is not what was written.
    """
    identity = Identity(entry.model_sha256, entry.source, entry.seed, entry.settings)
    if identity.key != entry.key:
        raise NotWhole(f"{named(tables.run, entry)} is not what was written")
    try:
        return identity, datetime.fromisoformat(entry.begun_at)
    except (TypeError, ValueError):
        raise NotWhole(f"{named(tables.run, entry)} has begun at no time") from None
