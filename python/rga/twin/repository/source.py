"""What is stored of one run, up to one of its steps."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import numpy as np
from sqlalchemy import (
    ColumnElement,
    Connection,
    LargeBinary,
    Row,
    Select,
    Table,
    func,
    or_,
    select,
    tuple_,
)

from rga.arrays import FloatArray
from rga.twin.repository import tables
from rga.twin.repository.chunks import LONGEST, one_after_another, unpack
from rga.twin.repository.entries import Rows
from rga.twin.repository.faults import could_be, whole

#: chunks that are loaded at a time
BATCH = 32


@dataclass(frozen=True)
class Source:
    """Entries of a run.

    Attributes:
        reading: opens a transaction to read in.
        run_id: key of the run in its repository.
        until: number of the last step to see; None: all.
    """

    reading: Callable[[], AbstractContextManager[Connection]]
    run_id: int
    until: int | None = None

    def last_step(self) -> Row[Any] | None:
        """The last step that was acknowledged, if any."""
        statement = self._select(tables.step, *tables.step.columns)
        with self.reading() as connection:
            entry = connection.execute(
                statement.order_by(tables.step.c.number.desc()).limit(1)
            ).one_or_none()
            return None if entry is None else whole(tables.step, entry)

    def scalar(self, table: Table, value: ColumnElement[Any], *where: ColumnElement[bool]) -> Any:
        """A value over the entries of a table, None where there are none."""
        with self.reading() as connection:
            return connection.scalar(self._select(table, value).where(*where))

    def entries(
        self, table: Table, *columns: ColumnElement[Any], where: Sequence[ColumnElement[bool]] = ()
    ) -> Sequence[Row[Any]]:
        """Columns of a table (all, if none is named), in the order in which they were stored.

        Raises:
            InputError: one of them is not what was written, or of some columns cannot be.
        """
        statement = self._by_other_than_steps(table, *(columns or table.columns)).where(*where)
        # In the order of an index nothing is sorted, and all is read: not for a few of them.
        order = (table.c.step + 0 if where else table.c.step), table.c.ordinal
        with self.reading() as connection:
            found = connection.execute(statement.order_by(*order)).all()
            checked = could_be if columns else whole
            return [checked(table, entry) for entry in found]

    def last(self, table: Table, *where: ColumnElement[bool]) -> Row[Any] | None:
        """The entry that was stored last, if any."""
        found = self.latest(table, 1, *where)
        return found[0] if found else None

    def latest(self, table: Table, number: int, *where: ColumnElement[bool]) -> Sequence[Row[Any]]:
        """The entries that were stored last, so many or fewer, in the order of storing."""
        order = table.c.step.desc(), table.c.ordinal.desc()
        statement = self._select(table, *table.columns).where(*where).order_by(*order)
        with self.reading() as connection:
            found = connection.execute(statement.limit(number)).all()
            return [whole(table, entry) for entry in reversed(found)]

    def last_of(self, table: Table, key: ColumnElement[bool]) -> Row[Any] | None:
        """The entry that was stored last under a key, however many there are under others.

        Args:
            table: which is indexed by the key and the step.
            key: the condition of it.
        """
        # By the order within a step the index would not be taken, and all entries be read.
        step = self._select(table, func.max(table.c.step)).where(key).scalar_subquery()
        return self.last(table, key, table.c.step == step)

    def highest(
        self, table: Table, column: ColumnElement[Any], *where: ColumnElement[bool]
    ) -> Row[Any] | None:
        """The entry with the highest value of a column, of several the one that was stored last.

        Args:
            table: that is indexed by the column.
            column: of it.
            where: conditions on the column.
        """
        order = column.desc(), table.c.step.desc(), table.c.ordinal.desc()
        statement = self._by_other_than_steps(table, *table.columns).where(*where).order_by(*order)
        with self.reading() as connection:
            found = connection.execute(statement.limit(1)).one_or_none()
            return None if found is None else whole(table, found)

    def rows(
        self,
        table: Table,
        names: Sequence[str],
        first: int,
        end: int | None,
        version: int | None,
        at_the_time: bool = False,
    ) -> tuple[Rows, list[FloatArray], Sequence[Row[Any]]]:
        """Rows from `first` to before `end` as they were stored last, or first (`at_the_time`).

        Returns:
            The rows int[n], an array float[n, width] for each name, and the chunk of each row.
        """
        c = table.c
        where = [c.first_row > first - LONGEST, c.first_row + c.length > first]
        if end is not None:
            where.append(c.first_row < end)
        if version is not None:
            where.append(c.version == version)
        unread = {one.name for one in c if isinstance(one.type, LargeBinary)} - {*names}
        columns = [one for one in c if one.name not in unread] if unread else []
        chunks = self.entries(table, *columns, where=where)
        spans = [np.arange(chunk.first_row, chunk.first_row + chunk.length) for chunk in chunks]
        stored = np.concatenate(spans) if spans else np.zeros(0, dtype=np.int64)
        rows, place = np.unique(stored if at_the_time else stored[::-1], return_index=True)
        inside = (rows >= first) & (rows < (np.inf if end is None else end))
        chosen = place[inside] if at_the_time else len(stored) - 1 - place[inside]
        owner = np.repeat(np.arange(len(chunks)), [chunk.length for chunk in chunks])[chosen]
        arrays = [joined(chunks, name)[chosen] for name in names]
        return rows[inside], arrays, [chunks[index] for index in owner]

    def about(self, table: Table, rows: Rows, *columns: ColumnElement[Any]) -> list[Row[Any]]:
        """Columns of the chunks that some rows can be in, in the order in which they were stored.

        Args:
            table: that holds them in chunks.
            rows: int[n], ascending.
            columns: the step and the ordinal among them.
        """
        first = table.c.first_row
        apart = np.flatnonzero(np.diff(rows) > LONGEST) + 1
        stretches = [part for part in np.split(rows, apart) if len(part)]
        ranges = [(first > int(part[0]) - LONGEST) & (first <= int(part[-1])) for part in stretches]
        found: list[Row[Any]] = []
        for number in range(0, len(ranges), BATCH):
            found += self.entries(table, *columns, where=[or_(*ranges[number : number + BATCH])])
        return sorted(found, key=lambda one: (one.step, one.ordinal))

    def chosen(
        self, table: Table, names: Sequence[str], rows: Rows
    ) -> tuple[Rows, list[FloatArray]]:
        """Some rows as they were stored last; of the others' chunks nothing is loaded.

        Args:
            table: that holds them in chunks.
            names: of arrays of the chunks.
            rows: int[n], ascending.

        Returns:
            Those that were stored, int[m], and an array float[m, width] for each name.
        """
        c = table.c
        index = self.about(table, rows, c.step, c.ordinal, c.first_row, c.length)
        owner = np.full(len(rows), -1)
        for number, chunk in enumerate(index):
            first, end = np.searchsorted(rows, [chunk.first_row, chunk.first_row + chunk.length])
            owner[first:end] = number
        stored, owner = rows[owner >= 0], owner[owner >= 0]
        wanted = np.unique(owner)
        parts: list[list[FloatArray]] = [[] for _ in names]
        for batch in np.split(wanted, range(BATCH, len(wanted), BATCH)):
            keys = [(index[number].step, index[number].ordinal) for number in batch]
            steps = c.step.in_({step for step, _ in keys})
            chunks = self.entries(table, where=[steps, tuple_(c.step, c.ordinal).in_(keys)])
            for number, chunk in zip(batch, chunks, strict=True):
                inside = stored[owner == number] - chunk.first_row
                for part, name in zip(parts, names, strict=True):
                    part.append(unpack(getattr(chunk, name), chunk.length)[inside])
        if not len(stored):
            return stored, [np.zeros((0, 0)) for _ in names]
        # Chunks came as they were stored, rows of a later one perhaps within an earlier one.
        order = np.argsort(np.concatenate([np.flatnonzero(owner == number) for number in wanted]))
        return stored, [one_after_another(part)[order] for part in parts]

    def step_at(self, row: int) -> int:
        """Number of the last step about rows up to this one; 0 where there is none."""
        step = tables.step.c
        return int(self.scalar(tables.step, func.max(step.number), step.row <= row) or 0)

    def row_at(self, time: float) -> int:
        """Last measured row at or before a time [s]; -1 where there is none."""
        c = tables.measured.c
        chunk = self.highest(tables.measured, c.first_time, c.first_time <= time)
        if chunk is None:
            return -1
        clock = unpack(chunk.time, chunk.length).ravel()
        return int(chunk.first_row + np.searchsorted(clock, time, side="right") - 1)

    def _select(self, table: Table, *columns: ColumnElement[Any]) -> Select[Any]:
        statement = select(*columns).where(table.c.run_id == self.run_id)
        if self.until is None:
            return statement
        step = table.c.number if table is tables.step else table.c.step
        return statement.where(step <= self.until)

    def _by_other_than_steps(self, table: Table, *columns: ColumnElement[Any]) -> Select[Any]:
        """As `_select`, where no database takes its index of steps.

        SQLite would take it before that of rows, and read the whole past for a few of them.
        """
        statement = select(*columns).where(table.c.run_id == self.run_id)
        return statement if self.until is None else statement.where(table.c.step + 0 <= self.until)


def joined(chunks: Sequence[Row[Any]], name: str) -> FloatArray:
    """The rows of chunks one after another, float[n, width]; float[0, 0] without chunks."""
    return one_after_another([unpack(getattr(chunk, name), chunk.length) for chunk in chunks])
