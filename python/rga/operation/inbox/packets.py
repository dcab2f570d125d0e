"""Packets on the disk: each is kept once, and nothing that was acknowledged is lost."""

import json
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

import numpy as np
from sqlalchemy import Connection, Table, delete, func, insert, select, update

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.operation.inbox import tables
from rga.operation.inbox.account import Account
from rga.operation.inbox.arrival import Arrival, Fate, Outcome
from rga.operation.inbox.known_packets import KnownPackets
from rga.operation.inbox.numbers import Numbers
from rga.operation.packets.formats import PayloadFormat
from rga.operation.packets.packet import EPOCH, MICROSECONDS
from rga.operation.rows.cells import Cell
from rga.operation.rows.grid import Grid
from rga.twin.hardware.inbox import Inbox
from rga.twin.hardware.interface import Station
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.faults import whole
from rga.twin.repository.table_file import only_entry, put, values_of

HOUR = 3600 * MICROSECONDS
#: before any moment
NEVER = -(2**62)
#: bytes that are kept of what cannot be used
KEPT_OF_REFUSED = 64 * 1024


@dataclass(frozen=True)
class KeptPacket:
    """A packet that is kept.

    Attributes:
        source: that it came from.
        kind: by which its payload is read.
        payload: as it was sent.
        place: that it came from, such as a topic.
        arrived: microseconds since 1970 (UTC).
        late_before: its samples before this moment came too late; None: all came in time.
    """

    source: str
    kind: PayloadFormat
    payload: bytes
    place: str
    arrived: int
    late_before: int | None = None


class Packets:
    """The packets of one twin, in the file of its inbox.

    What becomes of a packet hangs on what came before it, not on how soon rows are made of it.

    Args:
        inbox: of the twin.
        grid: of its rows.
        sources: names of all that send to it.

    Raises:
        InputError: the file cannot be written.
    """

    def __init__(self, inbox: Inbox, grid: Grid, sources: Collection[str]) -> None:
        self._inbox, self._grid, self._sources = inbox, grid, tuple(sources)
        with inbox.writing() as connection:
            tables.metadata.create_all(connection)

    def receive(
        self, source: str, arrivals: Sequence[Arrival], cursor: Mapping[str, Any] | None = None
    ) -> list[Outcome]:
        """Keep packets; they are on the disk when this returns, and may be acknowledged.

        Args:
            source: that they came from.
            arrivals: in their order.
            cursor: where the source reads on, by those of its parts that have moved, as JSON can
                say it.

        Returns:
            What becomes of each, and why if it is refused.

        Raises:
            InputError: nothing of them is kept, for the disk is full or the file is damaged.
        """
        with self._inbox.writing() as connection:
            sealed, latest = _until(connection), self._latest(connection)
            known = KnownPackets(connection, source)
            entries: list[dict[str, Any]] = []
            aside: list[dict[str, Any]] = []
            number, refused = _last(connection, tables.packet), _last(connection, tables.refused)
            outcomes: list[Outcome] = []
            counts: defaultdict[int, Counter[str]] = defaultdict(Counter)
            for one in arrivals:
                final = self._grid.final_until(latest)
                until = sealed if final is None else max(sealed, final)
                fate, reason = known.fate_of(one, until)
                outcomes.append((fate, reason))
                late_before = until if fate == "waiting" and one.first < until else None
                count = counts[one.arrived - one.arrived % HOUR]
                count["received"] += 1
                count["partly_late"] += late_before is not None
                if fate == "waiting":
                    latest[source] = max(one.last, latest[source] or NEVER)
                else:
                    count[fate] += 1
                if fate == "refused":
                    aside.append(_refused(refused := refused + 1, source, one, reason))
                elif fate != "duplicate":
                    entries.append(_entry(number := number + 1, source, one, fate, late_before))
            put(connection, tables.packet, entries)
            put(connection, tables.refused, aside)
            known.write()
            _move_on(connection, source, entries)
            for part, state in (cursor or {}).items():
                _keep_cursor(connection, source, part, json.dumps(state))
            for hour, count in counts.items():
                _count(connection, source, hour, count)
        return outcomes

    @property
    def sealed(self) -> int:
        """Moment before which rows are final [µs since 1970]; NEVER: none is."""
        with self._inbox.reading() as connection:
            return _until(connection)

    def latest(self) -> dict[str, int | None]:
        """The latest moment that each source has sent [µs since 1970]; None: nothing yet."""
        with self._inbox.reading() as connection:
            return self._latest(connection)

    def _latest(self, connection: Connection) -> dict[str, int | None]:
        known = {one.name: one.latest for one in connection.execute(select(tables.source))}
        return {name: known.get(name) for name in self._sources}

    def cursor(self, source: str) -> dict[str, Any]:
        """Where a source reads on, by its parts."""
        chosen = select(tables.cursor).where(tables.cursor.c.source == source)
        with self._inbox.reading() as connection:
            found = [whole(tables.cursor, one) for one in connection.execute(chosen)]
        return {one.part: json.loads(one.state) for one in found}

    def numbers(self, source: str) -> dict[str, Numbers]:
        """The numbers that have come of each stream of a source."""
        chosen = select(tables.stream).where(tables.stream.c.source == source)
        with self._inbox.reading() as connection:
            return {
                one.stream: Numbers(one.next, map(tuple, json.loads(one.gaps)))
                for one in connection.execute(chosen).all()
            }

    def between(self, begin: int, end: int, most_bytes: int) -> tuple[list[KeptPacket], int]:
        """What waits with samples within [begin, end) [µs], in the order of arrival.

        Args:
            most_bytes: of payload, beyond which the time is cut.

        Returns:
            The packets, and the end of the time that they are all of.
        """
        c = tables.packet.c
        waits = (c.fate == "waiting") & (c.last >= begin) & (c.first < end)
        sizes = select(c.first, func.length(c.payload)).where(waits).order_by(c.first)
        with self._inbox.reading() as connection:
            size = 0
            for first, length in connection.execute(sizes):
                size += length
                if size > most_bytes and first > begin:
                    end = min(end, first)
                    break
            chosen = select(tables.packet).where(waits & (c.first < end)).order_by(c.id)
            found = [whole(tables.packet, one) for one in connection.execute(chosen)]
        kept = [
            KeptPacket(
                one.source, one.kind, bytes(one.payload), one.place, one.arrived, one.late_before
            )
            for one in found
        ]
        return kept, end

    def seal(self, until: int, station: Station | None, cells: Sequence[Cell]) -> None:
        """Rows before a moment are final: give them to the twin, with what lies beside them.

        Args:
            until: moment [µs since 1970].
            station: what is mounted; None where there are no rows.
            cells: that the rows are the means of, of the channels and measured contexts of the
                station.

        Raises:
            InputError: the twin has ended, or nothing can be written.
        """
        with self._inbox.writing() as connection:
            before = _until(connection)
            if station is not None and cells:
                rows = _rows(station, cells)
                if self._inbox.put_within(connection, station, *rows) is None:
                    raise InputError("the twin has ended", "the inbox", "begin another")
                put(connection, tables.cell, [_beside(cell) for cell in cells])
            connection.execute(delete(tables.sealed))
            connection.execute(insert(tables.sealed).values(**with_checksum(until=until)))
            c = tables.packet.c
            hour = (c.arrived - c.arrived % HOUR).label("hour")
            used = (
                select(c.source, hour, func.count())
                .where((c.fate == "waiting") & (c.last >= before) & (c.last < until))
                .group_by(c.source, hour)
            )
            for source, when, count in connection.execute(used).all():
                _count(connection, source, when, Counter(used=count))

    def account(self) -> dict[tuple[str, int], Account]:
        """By source and hour [µs since 1970] of arrival, what became of every packet."""
        c = tables.packet.c
        hour = (c.arrived - c.arrived % HOUR).label("hour")
        with self._inbox.reading() as connection:
            until = _until(connection)
            waiting = (
                select(c.source, hour, func.count())
                .where((c.fate == "waiting") & (c.last >= until))
                .group_by(c.source, hour)
            )
            waits = {(one[0], one[1]): one[2] for one in connection.execute(waiting)}
            found = connection.execute(select(tables.account)).all()
        accounts = {}
        for one in found:
            values = values_of(tables.account, one)
            key = values.pop("source"), values.pop("hour")
            accounts[key] = Account(**values, waiting=waits.pop(key, 0))
        return accounts | {key: Account(waiting=count) for key, count in waits.items()}


def _last(connection: Connection, table: Table) -> int:
    """The highest id of a table; 0 where it is empty."""
    return int(connection.scalar(select(func.max(table.c.id))) or 0)


def _refused(id: int, source: str, arrival: Arrival, reason: str | None) -> dict[str, Any]:
    """A packet that cannot be used, and why, with the file or topic that it came from."""
    payload, told = arrival.payload[:KEPT_OF_REFUSED], reason or ""
    if arrival.place not in told:
        told = f"{arrival.place}: {told}"
    return with_checksum(
        id=id, source=source, arrived=arrival.arrived, reason=told, payload=payload
    )


def _entry(
    id: int, source: str, arrival: Arrival, fate: Fate, late_before: int | None
) -> dict[str, Any]:
    number = arrival.number
    return with_checksum(
        id=id,
        source=source,
        stream=number.stream if number else None,
        sequence=number.sequence if number else None,
        sha256=arrival.sha256,
        kind=arrival.kind,
        place=arrival.place,
        first=arrival.first,
        last=arrival.last,
        late_before=late_before,
        arrived=arrival.arrived,
        fate=fate,
        payload=arrival.payload,
    )


def _rows(station: Station, cells: Sequence[Cell]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Time since the first row of all [s], readings and contexts."""
    first = (datetime.fromisoformat(str(station.start)) - EPOCH) // timedelta(microseconds=1)
    time = np.array([cell.begin - first for cell in cells]) / MICROSECONDS
    means = np.array([cell.mean for cell in cells])
    return time, means[:, : len(station.channels)], means[:, len(station.channels) :]


def _beside(cell: Cell) -> dict[str, Any]:
    """A cell as it is kept: four bytes a number are enough beside the mean."""
    return with_checksum(
        begin=cell.begin,
        count=cell.count.astype("<u4").tobytes(),
        deviation=cell.deviation.astype("<f4").tobytes(),
        least=cell.least.astype("<f4").tobytes(),
        most=cell.most.astype("<f4").tobytes(),
        conflicts=cell.conflicts.astype("<u4").tobytes(),
    )


def _until(connection: Connection) -> int:
    found = only_entry(connection, tables.sealed)
    return NEVER if found is None else int(found["until"])


def _source(connection: Connection, name: str) -> dict[str, Any]:
    chosen = select(tables.source).where(tables.source.c.name == name)
    found = connection.execute(chosen).one_or_none()
    if found is None:
        return {"name": name, "latest": None}
    return values_of(tables.source, found)


def _keep_cursor(connection: Connection, source: str, part: str, state: str) -> None:
    entry = with_checksum(source=source, part=part, state=state)
    put(connection, tables.cursor, [entry], replacing=True)


def _move_on(connection: Connection, name: str, entries: Sequence[dict[str, Any]]) -> None:
    """Keep how far a source has come."""
    known = _source(connection, name)
    moments = [one["last"] for one in entries]
    if known["latest"] is not None:
        moments.append(known["latest"])
    now = known | {"latest": max(moments, default=None)}
    if now != known:
        put(connection, tables.source, [with_checksum(**now)], replacing=True)


def _count(connection: Connection, source: str, hour: int, more: Counter[str]) -> None:
    c = tables.account.c
    where = (c.source == source) & (c.hour == hour)
    found = connection.execute(select(tables.account).where(where)).one_or_none()
    names = ("received", "used", "duplicate", "late", "partly_late", "refused")
    if found is None:
        known: dict[str, Any] = {"source": source, "hour": hour} | dict.fromkeys(names, 0)
        connection.execute(insert(tables.account).values(**with_checksum(**known)))
    else:
        known = values_of(tables.account, found)
    known |= {name: known[name] + more[name] for name in names}
    connection.execute(update(tables.account).where(where).values(**with_checksum(**known)))
