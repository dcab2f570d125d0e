"""Payloads as samples in the names and units of a model."""

from collections.abc import Iterable, Mapping, Sequence
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
from rga.operation.rows.remarks import ChannelRemarks
from rga.records.mapped_channels import check_channels
from rga.records.mapping import FileMapping, TimeColumns

if TYPE_CHECKING:
    from rga.operation.rows.tables import Columns, TableReader

#: reasons of which each is told
MOST_REASONS = 5
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
        place: of the mapping, for an error.

    Raises:
        InputError: the mapping speaks of channels or units that the model does not have, or of no
            zone that is known.

    Attributes:
        mapping: as it was given.
        left_out: names that the mapping leaves out.
        remarks: what is to be known of its channels.
    """

    def __init__(
        self,
        source: str,
        model: Model,
        mapping: FileMapping,
        stated: StatedFormat | None = None,
        place: str = "import.toml",
    ) -> None:
        check_channels(mapping, model, place)
        self.mapping = mapping
        self.left_out = frozenset(mapping.left_out)
        self.remarks = ChannelRemarks()
        self._where, self._model = Path(source), model
        self._stated = replace(stated or StatedFormat(), zone=_zone(mapping, place))
        time = mapping.time.model_copy(update={"repeated_hour": "refused"})
        more = {"empty": "missing", "unknown": "unused", "time": time}
        self._mapping = mapping.model_copy(update=more)

    @cached_property
    def _tables(self) -> "TableReader":
        # A service starts without what reads files, and needs it with the first payload.
        from rga.operation.rows.tables import TableReader

        return TableReader(self._where, self._model, self._mapping, self.remarks)

    def format_of(self, payload: bytes, named: PayloadFormat | None) -> PayloadFormat:
        """The format of a payload: as its sender names it, as it is stated, or as it looks."""
        if named == "file" and self._stated.format == "row":
            return "row"  # a row without names is text/csv too
        return named or self._stated.format or format_of_bytes(payload)

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
            self._tables.used(_columns(packet))
        return packets

    def stated_names(self) -> set[str]:
        """Sensors and contexts of columns that are stated; none where they are not."""
        columns = set(self._stated.columns) - set(self._mapping.time.columns)
        if not columns:
            return set()
        return set(self._tables.used(tuple((one, "") for one in sorted(columns))).sources)

    def check_used(self, packets: Sequence[SensorPacket], where: str) -> None:
        """Whether something of packets is used.

        Raises:
            InputError: nothing is, and the mapping does not leave all of it out.
        """
        used = [self._tables.used(_columns(one)) for one in packets]
        if not any(one.sources for one in used):
            _check_none_refused({k: why for one in used for k, why in one.refused.items()}, where)

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


def check_samples(samples: SensorSamples, where: str) -> None:
    """Whether something of rows is used.

    Raises:
        InputError: nothing is, and the mapping does not leave all of it out.
    """
    if not samples.names:
        _check_none_refused(samples.refused, where)


def _check_none_refused(refused: Mapping[str, str], where: str) -> None:
    if refused:
        alike: dict[str, list[str]] = {}
        for name, why in refused.items():
            alike.setdefault(why, []).append(name)
        told = [f"{_first_of(names)} ({why})" for why, names in alike.items()]
        more = [f"and {len(told) - MOST_REASONS} reasons more"] if len(told) > MOST_REASONS else []
        raise InputError(
            f"none of its channels is used: {', '.join([*told[:MOST_REASONS], *more])}",
            where,
            "name them under [channels] or [unused] in import.toml",
        )


def _first_of(names: Sequence[str]) -> str:
    return f"{names[0]} and {len(names) - 1} more" if len(names) > 1 else names[0]


def _columns(packet: SensorPacket) -> "Columns":
    return tuple((name, packet.units.get(name, "")) for name in packet.channels)


def _zone(mapping: FileMapping, place: str) -> tzinfo | None:
    """The zone that a mapping states.

    Raises:
        InputError: there is no such zone.
    """
    if mapping.time.zone is None:
        return None
    from rga.records.times.zone import zone_of

    return zone_of(mapping.time.zone, place)
