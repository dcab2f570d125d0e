"""Payloads as samples in the names and units of a model."""

from collections.abc import Iterable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import polars as pl

from rga.errors import InputError
from rga.model import Model
from rga.operation.packets.packet import EPOCH, MICROSECONDS, MOST_BYTES, SensorPacket
from rga.operation.rows.cells import SensorSamples
from rga.records.channels import sources_of, values_of
from rga.records.formats import read_format
from rga.records.logger_data import measured
from rga.records.mapping import FileMapping
from rga.records.table import Table


class Reader:
    """Reads what one source sends.

    Columns that the model has no channel for are left out, and a channel may be missing.

    Args:
        source: name of it.
        model: names the sensors and contexts and states their units.
        mapping: what the names, units and signs of the logger mean.

    Attributes:
        left_out: names that the mapping leaves out.
    """

    def __init__(self, source: str, model: Model, mapping: FileMapping) -> None:
        self.left_out = frozenset(mapping.left_out)
        self._where, self._model = Path(source), model
        self._mapping = mapping.model_copy(update={"empty": "missing", "unknown": "unused"})
        named = {one.column for one in mapping.channels.values() if one.column}
        self._columns = {*model.sensors, *model.context, *mapping.unused, *named}

    def of_packets(self, packets: Iterable[SensorPacket]) -> list[SensorSamples]:
        """SensorSamples of packets, those of the same channels together.

        Raises:
            InputError: the unit that is stated of a channel is of something else.
        """
        alike: dict[tuple[str, ...], list[SensorPacket]] = {}
        for packet in packets:
            alike.setdefault(packet.channels, []).append(packet)
        return [
            self._of_columns(
                SensorSamples(
                    channels,
                    np.concatenate([one.times for one in group]),
                    np.concatenate([one.values for one in group]),
                )
            )
            for channels, group in alike.items()
        ]

    def of_file(self, payload: bytes) -> SensorSamples:
        """SensorSamples of a payload in a format that loggers write.

        Raises:
            InputError: it cannot be read, or its times have no zone.
        """
        if len(payload) > MOST_BYTES:
            raise InputError(
                f"it has {len(payload)} bytes, and {MOST_BYTES} are allowed",
                str(self._where),
                "send fewer rows at once",
            )
        table = read_format(payload, self._where, self._mapping, self._columns)
        found = measured(table, self._for(table), self._model)
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

    def _of_columns(self, samples: SensorSamples) -> SensorSamples:
        frame = pl.DataFrame(dict(zip(samples.names, samples.values.T, strict=True)))
        table = Table(self._where, frame, "row", 1, format="packet")
        mapping = self._for(table)
        sources = sources_of(table, mapping, self._model, ())
        values = np.full((len(samples.times), len(sources)), np.nan)
        for k, (name, source) in enumerate(sources.items()):
            values[:, k] = values_of(table, mapping, name, source, self._model)
        return SensorSamples(tuple(sources), samples.times, values)

    def _for(self, table: Table) -> FileMapping:
        """The mapping for a table that may lack some of the columns that it names."""
        there = {*table.frame.columns, *table.names.values()}
        channels = {
            name: one
            for name, one in self._mapping.channels.items()
            if one.column is None or one.column in there
        }
        return self._mapping.model_copy(update={"channels": channels})
