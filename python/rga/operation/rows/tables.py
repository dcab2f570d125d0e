"""Payloads and packets as tables of named columns, as records of files are."""

from collections.abc import Iterable
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
from rga.records.channels import ColumnSource, sources_of, values_of
from rga.records.formats import read_format
from rga.records.logger_data import measured
from rga.records.mapping import FileMapping
from rga.records.table import Table
from rga.records.units import conversion

#: names and units of the columns of a packet
Columns = tuple[tuple[str, str], ...]
#: sets of columns that are remembered, and channels of which is told why they are not used
_MOST_KNOWN = 1000
_UNKNOWN = "the model has no such channel"


class TableReader:
    """Reads what one source sends as tables.

    Args:
        where: it comes from.
        model: names the sensors and contexts and states their units.
        mapping: what the names, units and signs of the logger mean.
        refused: takes, by channel, why what is sent of it is not used.
    """

    def __init__(
        self, where: Path, model: Model, mapping: FileMapping, refused: dict[str, str]
    ) -> None:
        self._where, self._model, self._mapping = where, model, mapping
        self._refused, self._left_out = refused, frozenset(mapping.left_out)
        self._known: dict[Columns, dict[str, ColumnSource]] = {}
        self._told: set[Columns] = set()
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
        check_names(table.frame.columns, str(self._where))
        chosen = _for(table, mapping)
        found = measured(table, chosen, self._model)
        self._tell_unknown(table, chosen, found.clock.columns)
        if not isinstance(found.clock.start, str):
            raise InputError(
                "its times are no time stamps",
                str(self._where),
                "send time stamps with a zone, or state [time] format in import.toml",
            )
        start = datetime.fromisoformat(found.clock.start)
        if start.tzinfo is None:
            raise InputError(
                "its times have no zone", str(self._where), "state [time] zone in import.toml"
            )
        after = np.rint(found.clock.seconds * MICROSECONDS).astype(np.int64)
        times = (start - EPOCH) // timedelta(microseconds=1) + after
        columns = [np.zeros((len(times), 0)), *(one[:, None] for one in found.values.values())]
        return SensorSamples(tuple(found.values), times, np.hstack(columns))

    def of_columns(self, columns: Columns, times: Moments, values: FloatArray) -> SensorSamples:
        """SensorSamples of packets of the same columns, float[n, columns]."""
        table, sources = self._table(columns, values), self.sources(columns)
        mapping = _for(table, self._mapping)
        found = np.full((len(times), len(sources)), np.nan)
        for k, (name, source) in enumerate(sources.items()):
            found[:, k] = values_of(table, mapping, name, source, self._model)
        return SensorSamples(tuple(sources), times, found)

    def sources(self, columns: Columns) -> dict[str, ColumnSource]:
        """Sensor or context variable -> its column, of those that can be used."""
        if columns not in self._known:
            table = self._table(columns, np.zeros((0, len(columns))))
            sources = sources_of(table, _for(table, self._mapping), self._model, ())
            used = {one.column for one in sources.values()}
            for column, _ in columns:
                if column not in used and column not in self._left_out:
                    self.refuse(column, _UNKNOWN)
            if len(self._known) >= _MOST_KNOWN:
                self._known.clear()
            self._known[columns] = {
                name: one for name, one in sources.items() if self._converts(name, one)
            }
        return self._known[columns]

    def _converts(self, name: str, source: ColumnSource) -> bool:
        """Whether the unit of a column can be that of its channel."""
        if source.unit is not None:
            try:
                conversion(source.unit, name, self._model, source.column)
            except InputError as error:
                self.refuse(source.column, error.what)
                return False
        return True

    def _tell_unknown(
        self, table: Table, mapping: FileMapping, time_columns: Iterable[str]
    ) -> None:
        """Tell of columns of a file that the model has no channel for, once for each set."""
        columns = tuple((name, "") for name in table.frame.columns)
        if columns in self._told:
            return
        if len(self._told) >= _MOST_KNOWN:
            self._told.clear()
        self._told.add(columns)
        sources = sources_of(table, mapping, self._model, tuple(time_columns))
        known = {one.column for one in sources.values()} | {*time_columns, *table.bookkeeping}
        for column, _ in columns:
            names = {column, table.names.get(column, column), mapping.channel_of(column)[0]}
            if column not in known and not names & self._left_out:
                self.refuse(column, _UNKNOWN)

    def refuse(self, column: str, why: str) -> None:
        """Tell that what is sent of a column is not used, unless that is told of very many."""
        if len(self._refused) < _MOST_KNOWN:
            self._refused[column] = why

    def _table(self, columns: Columns, values: FloatArray) -> Table:
        names = [name for name, _ in columns]
        frame = pl.DataFrame(dict(zip(names, values.T, strict=True)))
        units = {name: unit for name, unit in columns if unit}
        return Table(self._where, frame, "row", 1, format="packet", units=units)


def _for(table: Table, mapping: FileMapping) -> FileMapping:
    """A mapping for a table that may lack some of the columns that it names."""
    there = {*table.frame.columns, *table.names.values()}
    channels = {
        name: one
        for name, one in mapping.channels.items()
        if one.column is None or one.column in there
    }
    return mapping.model_copy(update={"channels": channels})
