"""Packets of long ago: out of the inbox into files, a day at a time, and away when they are old."""

import os
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, Table, delete, func, select

from rga.files import write_table
from rga.operation.inbox import tables
from rga.operation.inbox.known_packets import IN_INBOX
from rga.operation.inbox.packets import HOUR
from rga.operation.packets.packet import MICROSECONDS
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository.faults import whole

DAY = 24 * HOUR
#: bytes of payload in one file
MOST_BYTES = 64 * 2**20
#: name of the folder beside the inbox
FOLDER = "archive"


class PacketArchive:
    """The packets of one twin that are older than a week.

    Packets of a day that all rows were made of go into Parquet files of the folder `archive`, with
    all that the inbox knows of them, and out of the inbox when the files are whole.

    Args:
        inbox: of the twin.
        directory: of the twin.
        retention: days that files are kept; None: for ever.
    """

    def __init__(self, inbox: Inbox, directory: Path, retention: float | None) -> None:
        self._inbox, self._folder, self._retention = inbox, directory / FOLDER, retention

    def tidy(self, now: int, has_room: Callable[[], bool]) -> list[Path]:
        """Archive what is old, and remove what is older than is kept.

        Args:
            now: microseconds since 1970 (UTC).
            has_room: whether the disk has room for files; while it has none, days stay in the
                inbox.

        Returns:
            Files that were written.

        Raises:
            InputError: nothing can be written or removed; it is done another time.
        """
        # What is removed makes room for what is written.
        self._remove_before(now)
        written: list[Path] = []
        for day in self._days(now - IN_INBOX):
            for table in (tables.packet, tables.refused):
                if not has_room():
                    return written
                written += self._archived(table, day)
        return written

    def _remove_before(self, now: int) -> None:
        """Remove files that are older than is kept."""
        if self._retention is None:
            return
        oldest = _date(now) - timedelta(days=self._retention)
        for file in self._folder.glob("*.parquet"):
            if date.fromisoformat("-".join(file.stem.split("-")[1:4])) < oldest:
                file.unlink()

    def _days(self, before: int) -> list[int]:
        """Begins of days that ended before a moment, and of whose packets none waits [µs]."""
        until = select(func.max(tables.sealed.c.until)).scalar_subquery()
        c = tables.packet.c
        waits = func.max((c.fate == "waiting") & (c.last >= func.coalesce(until, -(2**62))))
        found: dict[int, bool] = {}
        with self._inbox.reading() as connection:
            # Most hours end here: to look at all packets of a week takes a while.
            if all(_oldest(connection, one) > before for one in (tables.packet, tables.refused)):
                return []
            for table, is_open in ((tables.packet, waits), (tables.refused, func.max(0))):
                day = (table.c.arrived - table.c.arrived % DAY).label("day")
                for begin, waiting in connection.execute(select(day, is_open).group_by(day)):
                    found[begin] = found.get(begin, False) or bool(waiting)
        return sorted(day for day, open_ in found.items() if not open_ and day + DAY <= before)

    def _archived(self, table: Table, day: int) -> list[Path]:
        import polars as pl

        inside = (table.c.arrived >= day) & (table.c.arrived < day + DAY)
        files = []
        for number, part in enumerate(self._parts(table, inside), start=1):
            files.append(self._folder / f"{table.name}-{_date(day)}-{number:03d}.parquet")
            columns = [one.name for one in table.columns]
            frame = pl.DataFrame([tuple(one) for one in part], schema=columns, orient="row")
            write_table(frame, files[-1])
        for path in {*files, *(one.parent for one in files)}:
            _put_on_disk(path)
        if files:
            with self._inbox.writing() as connection:
                connection.execute(delete(table).where(inside))
        return files

    def _parts(self, table: Table, inside: ColumnElement[bool]) -> Iterator[Sequence[Row[Any]]]:
        """Entries of a day, as many at a time as a file holds."""
        size = func.length(table.c.payload)
        with self._inbox.reading() as connection:
            sizes = connection.execute(select(table.c.id, size).where(inside)).all()
        batches: list[list[int]] = []
        room = 0
        for id, length in sizes:
            if length > room or not batches:
                batches.append([])
                room = MOST_BYTES
            batches[-1].append(id)
            room -= length
        for batch in batches:
            between = (table.c.id >= min(batch)) & (table.c.id <= max(batch))
            chosen = select(table).where(inside & between).order_by(table.c.id)
            with self._inbox.reading() as connection:
                yield [whole(table, one) for one in connection.execute(chosen)]


def _oldest(connection: Connection, table: Table) -> float:
    """When the day of the first entry of a table ends [µs]; infinity: it is empty."""
    arrived = connection.scalar(select(table.c.arrived).order_by(table.c.id).limit(1))
    return float("inf") if arrived is None else float(arrived - arrived % DAY + DAY)


def _put_on_disk(path: Path) -> None:
    """What was written is there after a power cut, before it is removed elsewhere."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _date(moment: int) -> date:
    return datetime.fromtimestamp(moment / MICROSECONDS, UTC).date()
