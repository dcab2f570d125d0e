"""Packets on the disk: each is kept once, and nothing that was acknowledged is lost."""

import json
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Literal

import numpy as np
from sqlalchemy import Connection, Table, delete, func, insert, select, update

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.operation.inbox import tables
from rga.operation.inbox.account import Account
from rga.operation.inbox.numbers import Numbers
from rga.operation.packets.packet import EPOCH, MICROSECONDS, Number
from rga.operation.rows.cells import Cell
from rga.operation.rows.grid import Grid
from rga.twin.hardware.inbox import Inbox
from rga.twin.hardware.interface import Station
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.faults import whole
from rga.twin.repository.table_file import only_entry, values_of

#: how a payload is read: as a packet of rga's own, or as any format of a logger
Kind = Literal["packet", "file"]
Fate = Literal["waiting", "late", "duplicate", "refused"]
#: how long a packet without a number is known again [µs]
REMEMBERED = 24 * 3600 * MICROSECONDS
HOUR = 3600 * MICROSECONDS
#: before any moment
NEVER = -(2**62)
#: bytes that are kept of what cannot be used
KEPT_OF_REFUSED = 64 * 1024


@dataclass(frozen=True)
class Arrival:
    """A packet as it arrives.

    Attributes:
        payload: as it was sent.
        kind: by which it is read again.
        arrived: microseconds since 1970 (UTC), by the clock of this machine.
        first, last: moments of its samples, microseconds since 1970 (UTC).
        number: None: the logger counts none.
        sha256: of what tells it from others, where it has no number.
        refused: why it cannot be used; None: it can.
    """

    payload: bytes
    kind: Kind
    arrived: int
    first: int = 0
    last: int = 0
    number: Number | None = None
    sha256: str | None = None
    refused: str | None = None


@dataclass(frozen=True)
class KeptPacket:
    """A packet that is kept.

    Attributes:
        source: that it came from.
        kind: by which its payload is read.
        payload: as it was sent.
    """

    source: str
    kind: Kind
    payload: bytes


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

    def receive(self, source: str, arrivals: Sequence[Arrival], cursor: Any = None) -> list[Fate]:
        """Keep packets; they are on the disk when this returns, and may be acknowledged.

        Args:
            source: that they came from.
            arrivals: in their order.
            cursor: where the source reads on, as JSON can say it; None: it stays.

        Returns:
            What becomes of each.

        Raises:
            InputError: nothing of them is kept, for the disk is full or the file is damaged.
        """
        with self._inbox.writing() as connection:
            sealed, latest = _until(connection), self._latest(connection)
            known = _Known(connection, source)
            entries: list[dict[str, Any]] = []
            aside: list[dict[str, Any]] = []
            number, refused = _last(connection, tables.packet), _last(connection, tables.refused)
            fates: list[Fate] = []
            for one in arrivals:
                final = self._grid.final_until(latest)
                until = sealed if final is None else max(sealed, final)
                fate, reason = known.fate_of(one, until)
                fates.append(fate)
                if fate == "waiting":
                    latest[source] = max(one.last, latest[source] or NEVER)
                if fate == "refused":
                    aside.append(_refused(refused := refused + 1, source, one, reason))
                elif fate != "duplicate":
                    entries.append(_entry(number := number + 1, source, one, fate))
            if entries:
                connection.execute(insert(tables.packet), entries)
            if aside:
                connection.execute(insert(tables.refused), aside)
            known.write()
            _move_on(connection, source, entries, cursor)
            counts: dict[int, Counter[str]] = {}
            for one, fate in zip(arrivals, fates, strict=True):
                count = counts.setdefault(one.arrived - one.arrived % HOUR, Counter())
                count.update(["received"] if fate == "waiting" else ["received", fate])
            for hour, count in counts.items():
                _count(connection, source, hour, count)
        return fates

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

    def cursor(self, source: str) -> Any:
        """Where a source reads on; None: from the beginning."""
        with self._inbox.reading() as connection:
            found = _source(connection, source)
        return json.loads(found["cursor"]) if found["cursor"] is not None else None

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
        return [KeptPacket(one.source, one.kind, bytes(one.payload)) for one in found], end

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
                connection.execute(insert(tables.cell), [_beside(cell) for cell in cells])
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


class _Known:
    """What is known of the packets of a source, while others of it arrive."""

    def __init__(self, connection: Connection, source: str) -> None:
        self._connection, self._source = connection, source
        self._streams: dict[str, Numbers] = {}
        self._contents: set[str] = set()

    def fate_of(self, arrival: Arrival, until: int) -> tuple[Fate, str | None]:
        """What becomes of a packet, and why if it is refused."""
        reason = arrival.refused
        if arrival.number is not None:
            numbers = self._numbers(arrival.number.stream)
            if not numbers.takes(arrival.number.sequence):
                reason = "its number leaves more gaps than are kept of a stream"
            elif not numbers.take(arrival.number.sequence):
                return "duplicate", None
        elif reason is None and arrival.sha256 is not None:
            if self._has_come(arrival.sha256, arrival.arrived):
                return "duplicate", None
            self._contents.add(arrival.sha256)
        if reason is not None:
            return "refused", reason
        return ("late" if arrival.last < until else "waiting"), None

    def write(self) -> None:
        """Keep the numbers that have come."""
        for name, numbers in self._streams.items():
            c = tables.stream.c
            where = (c.source == self._source) & (c.stream == name)
            self._connection.execute(delete(tables.stream).where(where))
            gaps = json.dumps(numbers.gaps)
            entry = with_checksum(source=self._source, stream=name, next=numbers.next, gaps=gaps)
            self._connection.execute(insert(tables.stream).values(**entry))

    def _numbers(self, stream: str) -> Numbers:
        if stream not in self._streams:
            c = tables.stream.c
            where = (c.source == self._source) & (c.stream == stream)
            found = self._connection.execute(select(tables.stream).where(where)).one_or_none()
            known = Numbers()
            if found is not None:
                values = values_of(tables.stream, found)
                known = Numbers(values["next"], map(tuple, json.loads(values["gaps"])))
            self._streams[stream] = known
        return self._streams[stream]

    def _has_come(self, sha256: str, arrived: int) -> bool:
        if sha256 in self._contents:
            return True
        c = tables.packet.c
        same = (c.sha256 == sha256) & (c.source == self._source)
        recent = c.arrived.between(arrived - REMEMBERED, arrived + REMEMBERED)
        found = select(c.id).where(same & recent).limit(1)
        return self._connection.execute(found).one_or_none() is not None


def _last(connection: Connection, table: Table) -> int:
    """The highest id of a table; 0 where it is empty."""
    return int(connection.scalar(select(func.max(table.c.id))) or 0)


def _refused(id: int, source: str, arrival: Arrival, reason: str | None) -> dict[str, Any]:
    payload = arrival.payload[:KEPT_OF_REFUSED]
    return with_checksum(
        id=id, source=source, arrived=arrival.arrived, reason=reason, payload=payload
    )


def _entry(id: int, source: str, arrival: Arrival, fate: Fate) -> dict[str, Any]:
    number = arrival.number
    return with_checksum(
        id=id,
        source=source,
        stream=number.stream if number else None,
        sequence=number.sequence if number else None,
        sha256=arrival.sha256,
        kind=arrival.kind,
        first=arrival.first,
        last=arrival.last,
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
        return {"name": name, "latest": None, "cursor": None}
    return values_of(tables.source, found)


def _move_on(
    connection: Connection, name: str, entries: Sequence[dict[str, Any]], cursor: Any
) -> None:
    """Keep how far a source has come."""
    known = _source(connection, name)
    moments = [one["last"] for one in entries]
    if known["latest"] is not None:
        moments.append(known["latest"])
    now = known | {"latest": max(moments, default=None)}
    if cursor is not None:
        now["cursor"] = json.dumps(cursor)
    if now != known:
        connection.execute(delete(tables.source).where(tables.source.c.name == name))
        connection.execute(insert(tables.source).values(**with_checksum(**now)))


def _count(connection: Connection, source: str, hour: int, more: Counter[str]) -> None:
    c = tables.account.c
    where = (c.source == source) & (c.hour == hour)
    found = connection.execute(select(tables.account).where(where)).one_or_none()
    names = ("received", "used", "duplicate", "late", "refused")
    if found is None:
        known: dict[str, Any] = {"source": source, "hour": hour} | dict.fromkeys(names, 0)
        connection.execute(insert(tables.account).values(**with_checksum(**known)))
    else:
        known = values_of(tables.account, found)
    known |= {name: known[name] + more[name] for name in names}
    connection.execute(update(tables.account).where(where).values(**with_checksum(**known)))
