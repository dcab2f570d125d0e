"""The readers of a run, as it stands or as it stood."""

import json
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sqlalchemy import ColumnElement, Row, Table, func

from rga.arrays import FloatArray
from rga.twin.history import Event
from rga.twin.repository import tables
from rga.twin.repository.chunks import LONGEST, unpack
from rga.twin.repository.entries import (
    Identity,
    Inferred,
    ModelVersion,
    Origin,
    Proposal,
    StoredCommand,
    StoredFindings,
    StoredGaps,
    StoredMessage,
    StoredReadings,
    StoredSimulations,
)
from rga.twin.repository.source import Source, joined

Box = tuple[ArrayLike, ArrayLike]


class RunView:
    """A run of a repository, for reading.

    Rows are rows of the record; a range of them is that of a slice, from `first` to before `end`.
    Rows that nothing was stored for are left out; of what was stored more than once for a row the
    last is read, unless a version is asked for. Without any rows, arrays of two axes are
    float[0, 0].

    Attributes:
        identity: of the run.
        begun_at: wall clock at its beginning, UTC.
    """

    def __init__(self, source: Source, identity: Identity, begun_at: datetime) -> None:
        self.identity = identity
        self.begun_at = begun_at
        self._source = source

    def as_of(self, row: int | None = None, *, time: float | None = None) -> "RunView":
        """The run as it stood when the record had reached a row, or a time [s].

        Seen is what was acknowledged in steps about rows up to this one: a step that took in
        several rows at once is seen from the last of them on. Times count from the first row of
        the record.

        Raises:
            TypeError: not exactly one of row and time is given.
        """
        if row is None and time is not None:
            reached = self._source.row_at(time)
        elif row is not None and time is None:
            reached = row
        else:
            raise TypeError("as_of takes either a row or a time")
        return self.at_step(self._source.step_at(reached))

    def at_step(self, number: int) -> "RunView":
        """The run as it stood after a step."""
        return RunView(replace(self._source, until=number), self.identity, self.begun_at)

    @property
    def steps(self) -> int:
        """Number of acknowledged steps."""
        last = self._source.last_step()
        return 0 if last is None else int(last.number)

    @property
    def acknowledged_at(self) -> str:
        """Wall clock at the last step, UTC, as ISO 8601 text; that of the beginning before it."""
        last = self._source.last_step()
        return self.begun_at.isoformat() if last is None else str(last.written_at)

    @property
    def row(self) -> int:
        """Last row of the record that a step was about; -1 where there is none."""
        last = self._source.last_step()
        return -1 if last is None else int(last.row)

    @property
    def rows(self) -> int:
        """Number of rows of the record that were taken in."""
        last = self._source.highest(tables.measured, tables.measured.c.first_row)
        return 0 if last is None else int(last.first_row + last.length)

    def row_at(self, time: float) -> int:
        """The last row of the record at or before a time [s since the first]; -1: none is."""
        return self._source.row_at(time)

    def packets(self, first: int, end: int) -> list[tuple[int, int]]:
        """First row of, and row behind, the packets from a row on that end by another."""
        c = tables.measured.c
        where = [c.first_row >= first, c.first_row + c.length <= end]
        found = self._source.entries(tables.measured, c.first_row, c.length, where=where)
        return [(one.first_row, one.first_row + one.length) for one in found]

    def packets_about(self, rows: ArrayLike) -> list[tuple[int, int]]:
        """First row of, and row behind, the packets that some rows can be in, int[n]."""
        c = tables.measured.c
        wanted = np.unique(np.asarray(rows, dtype=np.int64))
        found = self._source.about(
            tables.measured, wanted, c.step, c.ordinal, c.first_row, c.length
        )
        return sorted({(one.first_row, one.first_row + one.length) for one in found})

    def is_forgotten(self, row: int) -> bool:
        """Whether the readings of a row that was taken in are kept no more."""
        c = tables.measured.c
        near = c.first_row > row - LONGEST, c.first_row <= row
        size = func.length(c.readings).label("size")
        packets = self._source.entries(tables.measured, c.first_row, size, where=near)
        return bool(packets) and not max(packets, key=lambda one: one.first_row).size

    def measured(self, first: int = 0, end: int | None = None) -> StoredReadings:
        """Rows of the record."""
        names = ("time", "readings", "contexts")
        rows, arrays, _ = self._source.rows(tables.measured, names, first, end, None)
        time, readings, contexts = arrays
        return StoredReadings(rows, time.reshape(-1), self._of_all(readings), contexts)

    def times_and_contexts(self, end: int) -> StoredReadings:
        """The rows before one without their readings, which are float[n, 0]."""
        rows, (time, contexts), _ = self._source.rows(
            tables.measured, ("time", "contexts"), 0, end, None
        )
        return StoredReadings(rows, time.reshape(-1), np.zeros((len(rows), 0)), contexts)

    def measured_at(self, rows: ArrayLike) -> StoredReadings:
        """Chosen rows of the record, int[n], without loading what lies between them.

        Args:
            rows: in any order; those that nothing was stored for are left out.
        """
        wanted = np.unique(np.asarray(rows, dtype=np.int64))
        found, (time, readings, contexts) = self._source.chosen(
            tables.measured, ("time", "readings", "contexts"), wanted
        )
        return StoredReadings(found, time.reshape(-1), self._of_all(readings), contexts)

    def _of_all(self, readings: FloatArray) -> FloatArray:
        """Readings of all sensors, NaN where none are kept any more."""
        if readings.shape[1] or not len(readings):
            return readings
        row = tables.measured.c.first_row
        first = self._source.highest(tables.measured, row, row <= 0)
        if first is None:
            return readings
        width = unpack(first.readings, first.length).shape[1]
        return np.full((len(readings), width), np.nan)

    def inferred(
        self,
        first: int = 0,
        end: int | None = None,
        version: int | None = None,
        at_the_time: bool = False,
    ) -> Inferred:
        """Inferred contexts of rows: what was stored last, or first (`at_the_time`)."""
        names = ("contexts", "spread")
        rows, arrays, chunks = self._source.rows(
            tables.inferred, names, first, end, version, at_the_time
        )
        contexts, spread = arrays
        return Inferred(rows, contexts, spread, _versions(chunks))

    def gaps(
        self,
        first: int = 0,
        end: int | None = None,
        version: int | None = None,
        at_the_time: bool = False,
    ) -> StoredGaps:
        """What was simulated for rows, and their gaps: as stored last, or first (`at_the_time`)."""
        names = ("simulated", "gaps")
        rows, arrays, chunks = self._source.rows(
            tables.gap, names, first, end, version, at_the_time
        )
        simulated, gaps = arrays
        return StoredGaps(rows, simulated, gaps, _versions(chunks))

    def simulated(
        self, version: int | None = None, origin: Origin | None = None, within: Box | None = None
    ) -> StoredSimulations:
        """Simulations, of a version, of an origin, with contexts in a box (low, high) float[k]."""
        chunks = self._source.entries(tables.simulated, where=_conditions(version, origin))
        contexts = joined(chunks, "contexts")
        inside = _inside(contexts, within)
        owner = np.repeat(np.arange(len(chunks)), [chunk.length for chunk in chunks])[inside]
        owners = [chunks[index] for index in owner]
        return StoredSimulations(
            _versions(owners),
            np.array([chunk.origin for chunk in owners], dtype=np.str_),
            np.array([chunk.row for chunk in owners], dtype=np.int64),
            contexts[inside],
            joined(chunks, "readings")[inside],
            joined(chunks, "falling").reshape(-1)[inside] > 0,
        )

    def count_simulated(
        self, version: int | None = None, origin: Origin | None = None, within: Box | None = None
    ) -> int:
        """Number of those simulations, without loading their readings."""
        c, where = tables.simulated.c, _conditions(version, origin)
        if within is None:
            return int(self._source.scalar(tables.simulated, func.sum(c.length), *where) or 0)
        columns = c.length, c.contexts
        chunks = self._source.entries(tables.simulated, *columns, where=where)
        return int(_inside(joined(chunks, "contexts"), within).sum())

    def simulated_contexts(self, version: int) -> FloatArray:
        """Contexts of the simulations of a version, float[n, k]; float[0, 0] without any."""
        c = tables.simulated.c
        where = _conditions(version, None)
        return joined(
            self._source.entries(tables.simulated, c.length, c.contexts, where=where), "contexts"
        )

    def versions(self) -> tuple[ModelVersion, ...]:
        """Model versions in the order in which they were stored."""
        return tuple(_version(entry) for entry in self._source.entries(tables.version))

    def version_in_force(self, row: int | None = None) -> ModelVersion | None:
        """The version in force, or the one that was in force at a row; None before the first."""
        where = [] if row is None else [tables.in_force.c.row <= row]
        chosen = self._source.last(tables.in_force, *where)
        if chosen is None:
            return None
        numbered = tables.version.c.number == chosen.version
        entry = self._source.last(tables.version, numbered)
        return None if entry is None else _version(entry)

    def in_force(self) -> tuple[tuple[int, int], ...]:
        """(row, version): from which row on which version was in force, as it was stored."""
        entries = self._source.entries(tables.in_force)
        return tuple((entry.row, entry.version) for entry in entries)

    def findings(self) -> tuple[StoredFindings, ...]:
        """Findings of diagnoses."""
        entries = self._source.entries(tables.findings)
        return tuple(StoredFindings(entry.row, entry.findings) for entry in entries)

    def events(self, after: int = 0) -> tuple[Event, ...]:
        """What happened to the twin in steps behind one, in order."""
        return tuple(event for _, event in self.events_since(after))

    def events_since(self, step: int) -> tuple[tuple[int, Event], ...]:
        """What happened in the steps behind one, each with the number of its step."""
        found = self._source.entries(tables.event, where=[tables.event.c.step > step])
        return tuple((entry.step, _event(entry)) for entry in found)

    def proposals(self) -> tuple[Proposal, ...]:
        """Changes of the model that diagnoses proposed."""
        return tuple(
            Proposal(
                entry.number,
                entry.row,
                entry.words,
                json.loads(entry.effects),
                entry.gain,
                None if entry.gain_low is None else (entry.gain_low, entry.gain_high),
            )
            for entry in self._source.entries(tables.proposal)
        )

    def commands(self) -> tuple[StoredCommand, ...]:
        """What people asked for, and what came of it."""
        return tuple(
            StoredCommand(
                entry.row,
                entry.kind,
                json.loads(entry.body),
                entry.who,
                entry.why,
                entry.given_at,
                entry.outcome,
            )
            for entry in self._source.entries(tables.command)
        )

    def messages(
        self, kind: str | None = None, latest: int | None = None
    ) -> tuple[StoredMessage, ...]:
        """The log of queries and responses, or of one kind; all, or the latest so many."""
        where = [] if kind is None else [tables.message.c.kind == kind]
        if latest is None:
            found = self._source.entries(tables.message, where=where)
        else:
            found = self._source.latest(tables.message, latest, *where)
        return tuple(map(_message, found))

    def last_message(self, kind: str) -> StoredMessage | None:
        """The last message of a kind; None where there is none."""
        entry = self._source.last_of(tables.message, tables.message.c.kind == kind)
        return None if entry is None else _message(entry)

    def story(self, first: int = 0, end: int | None = None) -> tuple[StoredMessage | Event, ...]:
        """Messages and events together in the order in which they were stored, as of `messages`."""
        sent = self._source.entries(tables.message, where=_between(tables.message, first, end))
        events = self._source.entries(tables.event, where=_between(tables.event, first, end))
        both: list[tuple[Row[Any], StoredMessage | Event]] = [
            *((one, _message(one)) for one in sent),
            *((one, _event(one)) for one in events),
        ]
        return tuple(what for entry, what in sorted(both, key=lambda one: _place(one[0])))

    def kept(self, name: str) -> bytes | None:
        """What was kept last under a name; None where nothing was."""
        entry = self._source.last_of(tables.kept, tables.kept.c.name == name)
        return None if entry is None else bytes(entry.data)


def _place(entry: Row[Any]) -> tuple[int, int]:
    return entry.step, entry.ordinal


def _between(table: Table, first: int, end: int | None) -> list[ColumnElement[bool]]:
    """What belongs to rows of the record from one to before another."""
    where = [] if first <= 0 else [table.c.row >= first]
    return where if end is None else [*where, table.c.row < end]


def _event(entry: Row[Any]) -> Event:
    return Event(
        entry.kind,
        entry.row,
        json.loads(entry.time),
        entry.words,
        tuple(json.loads(entry.sensors)),
        entry.gap_before,
        entry.gap_after,
    )


def _message(entry: Row[Any]) -> StoredMessage:
    return StoredMessage(
        entry.kind,
        entry.row,
        None if entry.time is None else json.loads(entry.time),
        json.loads(entry.body),
        datetime.fromisoformat(entry.written_at),
    )


def _conditions(version: int | None, origin: Origin | None) -> list[ColumnElement[bool]]:
    c = tables.simulated.c
    wanted = ((c.version, version), (c.origin, origin))
    return [column == value for column, value in wanted if value is not None]


def _inside(contexts: FloatArray, within: Box | None) -> NDArray[np.bool_]:
    if within is None or not len(contexts):
        return np.ones(len(contexts), dtype=np.bool_)
    low, high = (np.asarray(side, dtype=float) for side in within)
    return np.asarray(((contexts >= low) & (contexts <= high)).all(axis=1))


def _versions(chunks: Sequence[Row[Any]]) -> NDArray[np.int64]:
    return np.array([chunk.version for chunk in chunks], dtype=np.int64)


def _version(entry: Row[Any]) -> ModelVersion:
    interval = None if entry.gain_low is None else (entry.gain_low, entry.gain_high)
    return ModelVersion(
        entry.number,
        entry.row,
        entry.model,
        entry.model_sha256,
        entry.causes,
        entry.gain,
        interval,
        entry.status,
    )
