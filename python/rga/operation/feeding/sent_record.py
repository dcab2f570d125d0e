"""A record as the packets of a logger."""

import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.operation.packets.packet import (
    EPOCH,
    LONGEST,
    MICROSECONDS,
    Moments,
    Number,
    SensorPacket,
)
from rga.records.mapping import FileMapping
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import read_clock
from rga.records.units import contradict, name_and_unit, states_none, without_brackets


@dataclass(frozen=True)
class SentRecord:
    """Rows of a logger's file, as it has them.

    Attributes:
        channels: its columns but the time.
        times: int64[n], microseconds since 1970 (UTC).
        values: float64[n, channels], NaN where one is missing.
        stream: of its packets.
    """

    channels: tuple[str, ...]
    times: Moments
    values: FloatArray
    stream: str

    def edges(self, rows: int) -> list[int]:
        """Rows at which packets begin, and the end of the last.

        Args:
            rows: of a packet, or fewer where they would be too long.
        """
        edges = [0]
        while (begin := edges[-1]) < len(self.times):
            end = int(np.searchsorted(self.times, self.times[begin] + LONGEST * MICROSECONDS))
            edges.append(min(begin + rows, end))
        return edges

    def packet(self, number: int, begin: int, end: int) -> SensorPacket:
        """The rows from one to before another as a packet."""
        within = slice(begin, end)
        return SensorPacket(
            Number(self.stream, number), self.channels, self.times[within], self.values[within]
        )


def sent_record(
    path: Path, mapping: FileMapping, start: datetime | None = None, stream: str | None = None
) -> SentRecord:
    """Read a logger's file to send what it holds.

    Args:
        path: the file.
        mapping: how its time and its numbers are read.
        start: of its first row; None: as it says, which takes time stamps with a zone.
        stream: of its packets; None: one is drawn.

    Raises:
        InputError: it cannot be read, or its times have no zone.
    """
    table = read_table(path, mapping)
    clock = read_clock(table, mapping.time)
    if start is None:
        start = datetime.fromisoformat(clock.start) if isinstance(clock.start, str) else None
    if start is None or start.tzinfo is None:
        raise InputError(
            "its times have no zone", str(path), "give --start with a zone, or zone in import.toml"
        )
    after = np.rint(clock.seconds * MICROSECONDS).astype(np.int64)
    channels = [one for one in table.frame.columns if one not in clock.columns]
    missing = _missing(mapping, channels)
    values = np.column_stack([table.numbers(one, missing[one]) for one in channels])
    times = (start - EPOCH) // timedelta(microseconds=1) + after
    names = tuple(_with_unit(table, one) for one in channels)
    return SentRecord(names, times, values, stream or secrets.token_hex(8))


def _with_unit(table: Table, column: str) -> str:
    """The name of a column, with its unit in brackets where only a line of units has it.

    Raises:
        InputError: the name has another unit than the line of units.
    """
    named, stated = name_and_unit(column)[1], table.units.get(column)
    if stated is None or states_none(stated):
        return column
    if named is None:
        return f"{column} [{without_brackets(stated)}]"
    if contradict(named, stated):
        raise InputError(
            f"the name of {column!r} says {named!r}, the line of units says {stated!r}",
            str(table.path),
            "correct the one that is wrong",
        )
    return column


def _missing(mapping: FileMapping, columns: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """By column, what stands for a missing value in it."""
    stated = {one.column or name: one.missing for name, one in mapping.channels.items()}
    return {
        column: (
            *mapping.missing,
            *stated.get(column, stated.get(mapping.channel_of(column)[0], ())),
        )
        for column in columns
    }
