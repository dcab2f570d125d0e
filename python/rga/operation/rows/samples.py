"""Payloads as samples in the names and units of a model."""

from collections.abc import Iterable
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.operation.packets.csv_row import file_of_row
from rga.operation.packets.formats import PayloadFormat, StatedFormat, format_of_bytes, read_packets
from rga.operation.packets.packet import EPOCH, MICROSECONDS, Moments, SensorPacket
from rga.operation.packets.readings import check_json, check_size
from rga.operation.rows.cells import SensorSamples
from rga.operation.settings_types import is_readable
from rga.records.channels import ColumnSource, sources_of, values_of
from rga.records.formats import read_format
from rga.records.logger_data import measured
from rga.records.mapping import FileMapping, TimeColumns
from rga.records.table import Table
from rga.records.times.zone import zone_of
from rga.records.units import conversion

#: names and units of the columns of a packet
Columns = tuple[tuple[str, str], ...]
#: sets of columns that are remembered, and channels of which is told why they are not used
_MOST_KNOWN = 1000
#: of rows whose time is that of their arrival
_PLAIN = TimeColumns()
_UNKNOWN = "the model has no such channel"


class Reader:
    """Reads what one source sends.

    Columns that the model has no channel for are left out, and a channel may be missing.

    Args:
        source: name of it.
        model: names the sensors and contexts and states their units.
        mapping: what the names, units and signs of the logger mean.
        stated: of the format of its payloads.

    Attributes:
        left_out: names that the mapping leaves out.
        refused: by channel, why what is sent of it is not used.
    """

    def __init__(
        self,
        source: str,
        model: Model,
        mapping: FileMapping,
        stated: StatedFormat | None = None,
    ) -> None:
        self.left_out = frozenset(mapping.left_out)
        self.refused: dict[str, str] = {}
        self._where, self._model = Path(source), model
        zone = mapping.time.zone
        self._stated = replace(
            stated or StatedFormat(), zone=None if zone is None else zone_of(zone, source)
        )
        time = mapping.time.model_copy(update={"repeated_hour": "refused"})
        more = {"empty": "missing", "unknown": "unused", "time": time}
        self._mapping = mapping.model_copy(update=more)
        self._known: dict[Columns, dict[str, ColumnSource]] = {}
        self._told: set[Columns] = set()
        named = {one.column for one in mapping.channels.values() if one.column}
        self._columns = {*model.sensors, *model.context, *mapping.unused, *named}

    def format_of(self, payload: bytes) -> PayloadFormat:
        """The format of a payload: as it is stated, else as it looks."""
        return self._stated.format or format_of_bytes(payload)

    def packets_of(
        self, kind: PayloadFormat, payload: bytes, where: str, arrived: int
    ) -> list[SensorPacket]:
        """Packets of a payload in one of the formats `PACKETS`.

        Args:
            kind: the format.
            payload: as it was sent.
            where: it came from.
            arrived: microseconds since 1970 (UTC).

        Raises:
            InputError: it cannot be read, or two of its channels mean the same.
        """
        packets = read_packets(kind, payload, where, arrived, self._stated)
        for packet in packets:
            _check_names(packet.channels, where)
            self._sources(_columns(packet))
        return packets

    def of_rows(
        self, kind: PayloadFormat, payload: bytes, where: str, arrived: int
    ) -> tuple[SensorSamples, bool]:
        """SensorSamples of rows, as `packets_of`, and whether their time is the logger's.

        Raises:
            InputError: it cannot be read, or its times have no zone.
        """
        if kind == "file":
            return self.of_file(payload), True
        file, timed = file_of_row(
            payload,
            where,
            arrived,
            self._stated.columns,
            self._mapping.time.columns,
            self._mapping.delimiter,
            self._mapping.decimal,
        )
        mapping = self._mapping if timed else self._mapping.model_copy(update={"time": _PLAIN})
        return self._of_table(file, mapping), timed

    def of_packets(self, packets: Iterable[SensorPacket]) -> list[SensorSamples]:
        """SensorSamples of packets, those of the same channels together.

        Raises:
            InputError: two of the channels mean the same.
        """
        alike: dict[Columns, list[SensorPacket]] = {}
        for packet in packets:
            alike.setdefault(_columns(packet), []).append(packet)
        return [
            self._of_columns(
                columns,
                np.concatenate([one.times for one in group]),
                np.concatenate([one.values for one in group]),
            )
            for columns, group in alike.items()
        ]

    def of_file(self, payload: bytes) -> SensorSamples:
        """SensorSamples of a payload in a format that loggers write.

        Raises:
            InputError: it cannot be read, or its times have no zone.
        """
        try:
            return self._of_table(payload, self._mapping)
        except InputError:
            check_json(payload, str(self._where))
            raise

    def _of_table(self, payload: bytes, mapping: FileMapping) -> SensorSamples:
        check_size(payload, str(self._where))
        table = read_format(payload, self._where, mapping, self._columns)
        _check_names(table.frame.columns, str(self._where))
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

    def _of_columns(self, columns: Columns, times: Moments, values: FloatArray) -> SensorSamples:
        table, sources = self._table(columns, values), self._sources(columns)
        mapping = _for(table, self._mapping)
        found = np.full((len(times), len(sources)), np.nan)
        for k, (name, source) in enumerate(sources.items()):
            found[:, k] = values_of(table, mapping, name, source, self._model)
        return SensorSamples(tuple(sources), times, found)

    def _sources(self, columns: Columns) -> dict[str, ColumnSource]:
        """Sensor or context variable -> its column, of those that can be used."""
        if columns not in self._known:
            table = self._table(columns, np.zeros((0, len(columns))))
            sources = sources_of(table, _for(table, self._mapping), self._model, ())
            used = {one.column for one in sources.values()}
            for column, _ in columns:
                if column not in used and column not in self.left_out:
                    self._refuse(column, _UNKNOWN)
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
                self._refuse(source.column, error.what)
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
            if column not in known and not names & self.left_out:
                self._refuse(column, _UNKNOWN)

    def _refuse(self, column: str, why: str) -> None:
        if len(self.refused) < _MOST_KNOWN:
            self.refused[column] = why

    def _table(self, columns: Columns, values: FloatArray) -> Table:
        names = [name for name, _ in columns]
        frame = pl.DataFrame(dict(zip(names, values.T, strict=True)))
        units = {name: unit for name, unit in columns if unit}
        return Table(self._where, frame, "row", 1, format="packet", units=units)


def _check_names(names: Iterable[str], where: str) -> None:
    """Whether names can be shown to people.

    Raises:
        InputError: one has a control character.
    """
    for name in names:
        if not is_readable(name) or "\n" in name:
            raise InputError(
                f"the name {name!r} has a control character", where, "name it by visible letters"
            )


def _columns(packet: SensorPacket) -> Columns:
    return tuple((name, packet.units.get(name, "")) for name in packet.channels)


def _for(table: Table, mapping: FileMapping) -> FileMapping:
    """A mapping for a table that may lack some of the columns that it names."""
    there = {*table.frame.columns, *table.names.values()}
    channels = {
        name: one
        for name, one in mapping.channels.items()
        if one.column is None or one.column in there
    }
    return mapping.model_copy(update={"channels": channels})
