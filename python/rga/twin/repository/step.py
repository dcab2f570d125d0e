"""The writer of a run: one step, acknowledged as a whole."""

import json
from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from sqlalchemy import ColumnElement, Connection, Table, delete, insert, select, update

from rga.twin.repository import tables
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.chunks import chunks
from rga.twin.repository.entries import Origin, Time
from rga.twin.repository.faults import whole

#: bytes of a page of a state
PAGE = 16_384


class Transaction:
    """What one transaction stores; `Run.step` begins and ends it.

    Where a method takes `row`, it is the row of the record at which something was decided; where
    it takes `first_row`, the row that the arrays begin with. A ValueError reports arrays that do
    not fit one another and of bodies that JSON cannot hold.

    Args:
        connection: with a transaction that is open.
        run_id: key of the run.
        pages: of the states that were kept last, by name; what this step keeps joins them.

    Attributes:
        number: of the step in its run, from 1.
        row: last row that this step or one before it was about, -1 where there was none.
    """

    def __init__(
        self, connection: Connection, run_id: int, pages: dict[str, list[bytes]] | None = None
    ) -> None:
        before = (
            select(tables.step.c.number, tables.step.c.row)
            .where(tables.step.c.run_id == run_id)
            .order_by(tables.step.c.number.desc())
            .limit(1)
        )
        last = connection.execute(before).one_or_none()
        self.number: int = last.number + 1 if last else 1
        self.row: int = last.row if last else -1
        self._connection = connection
        self._run_id = run_id
        self._pages = {} if pages is None else pages
        self._ordinal = 0
        self._ended = False
        connection.execute(insert(tables.step).values(**self._entry()))

    def message(
        self, *, kind: str, row: int, body: dict[str, Any], time: Time | None = None
    ) -> None:
        """A query or a response; `body` is what JSON can hold."""
        self._store(
            tables.message,
            row,
            kind=kind,
            row=row,
            time=None if time is None else _json(time),
            body=_json(body),
            written_at=now(),
        )

    def measured(
        self, first_row: int, time: ArrayLike, readings: ArrayLike, contexts: ArrayLike
    ) -> None:
        """Rows of the record: float[n] [s], float[n, sensors], float[n, measured contexts]."""
        clock = np.asarray(time, dtype=float)
        for start, chunk in chunks(time=clock, readings=readings, contexts=contexts):
            first_time = float(clock[start])
            self._store_rows(tables.measured, first_row + start, chunk, first_time=first_time)

    def simulated(
        self,
        version: int,
        origin: Origin,
        row: int,
        contexts: ArrayLike,
        readings: ArrayLike,
        falling: ArrayLike | None = None,
    ) -> None:
        """Simulations of a model version: float[n, k], float[n, sensors].

        Those marked `falling`, bool[n], were simulated with a latent position that falls.
        """
        if falling is None:
            falling = np.zeros(len(np.asarray(contexts)))
        for _, chunk in chunks(contexts=contexts, readings=readings, falling=falling):
            chunk |= {"version": version, "origin": origin, "row": row}
            self._store(tables.simulated, row, **chunk)

    def inferred(
        self, first_row: int, contexts: ArrayLike, spread: ArrayLike, version: int
    ) -> None:
        """Posterior mean and standard deviation of the contexts of rows: float[n, k] each."""
        for start, chunk in chunks(contexts=contexts, spread=spread):
            self._store_rows(tables.inferred, first_row + start, chunk, version=version)

    def gaps(self, first_row: int, simulated: ArrayLike, gaps: ArrayLike, version: int) -> None:
        """What a version simulated for rows, and their gaps [unit squared]: float[n, sensors]."""
        for start, chunk in chunks(simulated=simulated, gaps=gaps):
            self._store_rows(tables.gap, first_row + start, chunk, version=version)

    def version(
        self,
        number: int,
        row: int,
        model_json: str,
        model_sha256: str,
        causes_json: str,
        gain: float | None,
        gain_ci90: tuple[float, float] | None,
        status: str,
    ) -> None:
        """A model version, each number once; `in_force` is what puts it in force."""
        low, high = gain_ci90 or (None, None)
        self._store(
            tables.version,
            row,
            number=number,
            row=row,
            model=model_json,
            model_sha256=model_sha256,
            causes=causes_json,
            gain=gain,
            gain_low=low,
            gain_high=high,
            status=status,
        )

    def in_force(self, version: int, row: int) -> None:
        """From this row on a version is in force: a new one, or with a rollback an old one."""
        self._store(tables.in_force, row, version=version, row=row)

    def findings(self, row: int, findings_json: str) -> None:
        """Findings of a diagnosis that ended with this row."""
        self._store(tables.findings, row, row=row, findings=findings_json)

    def event(
        self,
        kind: str,
        row: int,
        time: Time,
        words: str,
        sensors: tuple[str, ...] = (),
        gap_before: float | None = None,
        gap_after: float | None = None,
    ) -> None:
        """Something that happened to the twin: the parts of a `rga.twin.history.Event`."""
        self._store(
            tables.event,
            row,
            kind=kind,
            row=row,
            time=_json(time),
            words=words,
            sensors=_json(sensors),
            gap_before=gap_before,
            gap_after=gap_after,
        )

    def keep(self, name: str, data: bytes, row: int) -> None:
        """What is asked for as of a time (weights, the state of the loop) under a name."""
        self._store(tables.kept, row, name=name, row=row, data=data)

    def forget(self, first_row: int, end_row: int) -> None:
        """Leave out readings and gaps of rows from one to before another, where chunks end.

        What is read of them then is missing; times and contexts stay.
        """
        self._check_open()

        def old(table: Table) -> ColumnElement[bool]:
            c = table.c
            inside = (c.first_row >= first_row) & (c.first_row < end_row)
            return (c.run_id == self._run_id) & inside

        measured = tables.measured
        for entry in self._connection.execute(select(measured).where(old(measured))).all():
            left = whole(measured, entry)._asdict() | {"readings": b""}
            own = [measured.c[name] == left[name] for name in ("run_id", "step", "ordinal")]
            self._connection.execute(update(measured).where(*own).values(**with_checksum(**left)))
        self._connection.execute(delete(tables.gap).where(old(tables.gap)))

    def proposal(
        self,
        number: int,
        row: int,
        words: str,
        effects: dict[str, dict[str, Any]],
        gain: float | None,
        gain_ci90: tuple[float, float] | None,
    ) -> None:
        """A change of the model that a diagnosis proposes."""
        low, high = gain_ci90 or (None, None)
        self._store(
            tables.proposal,
            row,
            number=number,
            row=row,
            words=words,
            effects=_json(effects),
            gain=gain,
            gain_low=low,
            gain_high=high,
        )

    def command(
        self,
        row: int,
        kind: str,
        body: dict[str, Any],
        who: str,
        why: str,
        given_at: str,
        outcome: str,
    ) -> None:
        """What somebody asked for, and what came of it."""
        self._store(
            tables.command,
            row,
            row=row,
            kind=kind,
            body=_json(body),
            who=who,
            why=why,
            given_at=given_at,
            outcome=outcome,
        )

    def state(self, name: str, data: bytes) -> None:
        """What only a run that goes on needs (a detector), in place of what was kept last.

        Pages that are as they were are not written again.
        """
        self._check_open()
        c = tables.state_page.c
        own = (c.run_id == self._run_id) & (c.name == name)
        pages = [data[begun : begun + PAGE] for begun in range(0, len(data) or 1, PAGE)]
        known = self._pages.get(name, [])
        changed = [k for k, page in enumerate(pages) if known[k : k + 1] != [page]]
        gone = own if not known else own & (c.page.in_(changed) | (c.page >= len(pages)))
        if changed or len(known) != len(pages):
            self._connection.execute(delete(tables.state_page).where(gone))
        if changed:
            self._connection.execute(
                insert(tables.state_page),
                [
                    with_checksum(run_id=self._run_id, name=name, page=k, data=pages[k])
                    for k in changed
                ],
            )
        self._pages[name] = pages

    def end(self) -> None:
        """Note the row that the step reached; nothing more can be stored in it."""
        own = (tables.step.c.run_id == self._run_id) & (tables.step.c.number == self.number)
        self._connection.execute(update(tables.step).where(own).values(**self._entry()))
        self._ended = True

    def _store_rows(
        self, table: Table, first_row: int, chunk: dict[str, Any], **columns: Any
    ) -> None:
        last_row = first_row + chunk["length"] - 1
        self._store(table, last_row, first_row=first_row, **chunk, **columns)

    def _store(self, table: Table, about: int, **columns: Any) -> None:
        self._check_open()
        key = {"run_id": self._run_id, "step": self.number, "ordinal": self._ordinal}
        empty = {column.name: None for column in table.columns if column.nullable}
        self._connection.execute(insert(table), with_checksum(**empty | key | columns))
        self._ordinal += 1
        self.row = max(self.row, about)

    def _entry(self) -> dict[str, Any]:
        """The step itself, as far as it has come."""
        return with_checksum(
            run_id=self._run_id, number=self.number, row=self.row, written_at=now()
        )

    def _check_open(self) -> None:
        if self._ended:
            raise RuntimeError("the step has ended: begin another")


def now() -> str:
    """The wall clock, UTC, as ISO 8601 text."""
    return datetime.now(UTC).isoformat()


def _json(value: Any) -> str:
    return json.dumps(value, allow_nan=False)
