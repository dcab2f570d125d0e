"""Payloads as samples in the names and units of a model."""

from collections.abc import Iterable
from dataclasses import replace
from datetime import tzinfo
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rga.errors import InputError
from rga.model import Model
from rga.operation.packets.csv_row import file_of_row
from rga.operation.packets.formats import PayloadFormat, StatedFormat, format_of_bytes, read_packets
from rga.operation.packets.packet import SensorPacket
from rga.operation.packets.readings import check_json, check_names
from rga.operation.rows.cells import SensorSamples
from rga.records.mapping import FileMapping, TimeColumns

if TYPE_CHECKING:
    from rga.operation.rows.tables import Columns, TableReader

#: of rows whose time is that of their arrival
_PLAIN = TimeColumns()


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
        self._stated = replace(stated or StatedFormat(), zone=_zone(mapping, source))
        time = mapping.time.model_copy(update={"repeated_hour": "refused"})
        more = {"empty": "missing", "unknown": "unused", "time": time}
        self._mapping = mapping.model_copy(update=more)

    @cached_property
    def _tables(self) -> "TableReader":
        # A service starts without what reads files, and needs it with the first payload.
        from rga.operation.rows.tables import TableReader

        return TableReader(self._where, self._model, self._mapping, self.refused)

    def refuse(self, channel: str, why: str) -> None:
        """Tell that what is sent of a channel is not used."""
        self._tables.refuse(channel, why)

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
            check_names(packet.channels, where)
            self._tables.sources(_columns(packet))
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
        return self._tables.of_table(file, mapping), timed

    def of_packets(self, packets: Iterable[SensorPacket]) -> list[SensorSamples]:
        """SensorSamples of packets, those of the same channels together.

        Raises:
            InputError: two of the channels mean the same.
        """
        alike: dict[Columns, list[SensorPacket]] = {}
        for packet in packets:
            alike.setdefault(_columns(packet), []).append(packet)
        return [
            self._tables.of_columns(
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
            return self._tables.of_table(payload, self._mapping)
        except InputError:
            check_json(payload, str(self._where))
            raise


def _columns(packet: SensorPacket) -> "Columns":
    return tuple((name, packet.units.get(name, "")) for name in packet.channels)


def _zone(mapping: FileMapping, source: str) -> tzinfo | None:
    """The zone that a mapping states.

    Raises:
        InputError: there is no such zone.
    """
    if mapping.time.zone is None:
        return None
    from rga.records.times.zone import zone_of

    return zone_of(mapping.time.zone, source)
