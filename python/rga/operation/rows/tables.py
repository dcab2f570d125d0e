"""Payloads and packets as tables of named columns, as records of files are."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.operation.packets.packet import EPOCH, MICROSECONDS, Moments
from rga.operation.packets.readings import check_names, check_size
from rga.operation.rows.cells import SensorSamples
from rga.operation.rows.remarks import MOST_KNOWN, ChannelRemarks
from rga.records.channels import ColumnSource, doubts_of, sources_of, unit_fault, values_of
from rga.records.formats import read_format
from rga.records.mapping import FileMapping
from rga.records.table import Table
from rga.records.times import read_clock
from rga.records.units import name_and_unit

#: names and units of the columns of a packet
Columns = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class ColumnUse:
    """What of a table is used.

    Attributes:
        sources: sensor or context variable -> its column.
        refused: columns that are not used though nobody leaves them out, with the reason.
    """

    sources: Mapping[str, ColumnSource]
    refused: Mapping[str, str]


class TableReader:
    """Reads what one source sends as tables.

    Args:
        where: it comes from.
        model: names the sensors and contexts and states their units.
        mapping: what the names, units and signs of the logger mean.
        remarks: takes what is to be known of its channels.
    """

    def __init__(
        self, where: Path, model: Model, mapping: FileMapping, remarks: ChannelRemarks
    ) -> None:
        self._where, self._model, self._mapping = where, model, mapping
        self._remarks, self._left_out = remarks, frozenset(mapping.left_out)
        self._known: dict[Columns, ColumnUse] = {}
        named = {one.column for one in mapping.channels.values() if one.column}
        self._columns = {*model.sensors, *model.context, *mapping.unused, *named}

    def of_table(self, payload: bytes, mapping: FileMapping) -> SensorSamples:
        """SensorSamples of a text or file.

        Args:
            payload: as it was sent.
            mapping: how it is read.

        Raises:
            InputError: it cannot be read, or its times have no zone.
        """
        check_size(payload, str(self._where))
        table = read_format(payload, self._where, mapping, self._columns)
        table.check_rows()
        check_names(table.frame.columns, str(self._where))
        chosen = _for(table, mapping)
        clock = read_clock(table, chosen.time)
        if not isinstance(clock.start, str):
            raise InputError(
                "its times are no time stamps",
                str(self._where),
                "send time stamps with a zone, or state [time] format in import.toml",
            )
        start = datetime.fromisoformat(clock.start)
        if start.tzinfo is None:
            raise InputError(
                "its times have no zone", str(self._where), "state [time] zone in import.toml"
            )
        used = self._used(table, chosen, clock.columns)
        after = np.rint(clock.seconds * MICROSECONDS).astype(np.int64)
        times = (start - EPOCH) // timedelta(microseconds=1) + after
        values = self._values(table, chosen, used, len(times))
        return SensorSamples(tuple(used.sources), times, values, used.refused)

    def of_columns(self, columns: Columns, times: Moments, values: FloatArray) -> SensorSamples:
        """SensorSamples of packets of the same columns, float[n, columns]."""
        table, used = self._table(columns, values), self.used(columns)
        found = self._values(table, _for(table, self._mapping), used, len(times))
        return SensorSamples(tuple(used.sources), times, found, used.refused)

    def used(self, columns: Columns) -> ColumnUse:
        """What is used of packets with these columns.

        Raises:
            InputError: two of them mean the same.
        """
        if columns not in self._known:
            table = self._table(columns, np.zeros((0, len(columns))))
            found = self._used(table, _for(table, self._mapping), ())
            if len(self._known) >= MOST_KNOWN:
                self._known.clear()
            self._known[columns] = found
        return self._known[columns]

    def _used(self, table: Table, mapping: FileMapping, time_columns: Iterable[str]) -> ColumnUse:
        """What is used of a table; of the rest it is told why it is not."""
        times = tuple(time_columns)
        sources = sources_of(table, mapping, self._model, times)
        claimed = {*times, *table.bookkeeping, *(one.column for one in sources.values())}
        refused = {}
        for column in table.frame.columns:
            names = {column, table.names.get(column, column), mapping.channel_of(column)[0]}
            if column not in claimed and not names & self._left_out:
                refused[column] = "the model has no such channel"
        for name, source in [*sources.items()]:
            if fault := unit_fault(table, name, source, self._model):
                refused[source.column] = fault.what
                del sources[name]
        for column, why in refused.items():
            self._remarks.refuse(column, why)
        for column, why in doubts_of(sources).items():
            self._remarks.doubt(column, why)
        return ColumnUse(sources, refused)

    def _values(self, table: Table, mapping: FileMapping, used: ColumnUse, rows: int) -> FloatArray:
        """What is used of a table in the units of the model, float[rows, channels]."""
        found = np.full((rows, len(used.sources)), np.nan)
        for k, (name, source) in enumerate(used.sources.items()):
            found[:, k] = values_of(table, mapping, name, source, self._model)
        return found

    def _table(self, columns: Columns, values: FloatArray) -> Table:
        """Packets as a table; as in a file, a unit may stand in brackets behind a name."""
        frame = pl.DataFrame(dict(zip((name for name, _ in columns), values.T, strict=True)))
        parts = {name: name_and_unit(name) for name, _ in columns}
        names = {name: bare for name, (bare, _) in parts.items() if bare != name}
        stated = {name: unit or parts[name][1] for name, unit in columns}
        units = {name: unit for name, unit in stated.items() if unit}
        return Table(self._where, frame, "row", 1, format="packet", units=units, names=names)


def _for(table: Table, mapping: FileMapping) -> FileMapping:
    """A mapping for a table that may lack some of the columns that it names."""
    there = {*table.frame.columns, *table.names.values()}
    channels = {
        name: one
        for name, one in mapping.channels.items()
        if one.column is None or one.column in there
    }
    return mapping.model_copy(update={"channels": channels})
