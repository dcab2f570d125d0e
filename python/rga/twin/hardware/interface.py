"""The hardware interface: what the structure's sensors send, packet by packet."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import seconds
from rga.records.record import time_label

#: how the source of rows that go on arriving begins; the name of the twin follows
LIVE = "live:"


@dataclass(frozen=True)
class Packet:
    """Rows that arrive together.

    Attributes:
        first: number of the first row.
        time: float[n], seconds since the first row of the record.
        readings: float[n, channels], NaN where missing.
        contexts: measured contexts, float[n, measured], NaN where missing.
    """

    first: int
    time: FloatArray
    readings: FloatArray
    contexts: FloatArray

    @property
    def end(self) -> int:
        """Number of the row after the last."""
        return self.first + len(self.time)


@dataclass(frozen=True)
class Station:
    """What is mounted on the structure.

    Attributes:
        channels: sensors, in the order of the readings.
        measured: context variables that are measured, in the order of the packets.
        start, time_format: time of the first row and how the record writes time, as of a Record.
        zero: clock (`time`) and measured contexts of the unloaded rows whose mean the logger took
            off every channel, float[n] each; of no length where nothing was taken off.
    """

    channels: tuple[str, ...]
    measured: tuple[str, ...]
    start: str | float
    time_format: Literal["iso", "seconds"]
    zero: Mapping[str, FloatArray]

    @property
    def origin(self) -> float:
        """Clock of the first row [s]."""
        return seconds(self.start)

    def to_json(self) -> str:
        """The station as text."""
        zero = {name: values.tolist() for name, values in self.zero.items()}
        return json.dumps({**vars(self), "zero": zero})

    @classmethod
    def from_json(cls, text: str | bytes) -> "Station":
        """The station that `to_json` wrote."""
        known = json.loads(text)
        zero = {name: np.array(values, dtype=float) for name, values in known["zero"].items()}
        channels, measured = tuple(known["channels"]), tuple(known["measured"])
        return cls(channels, measured, known["start"], known["time_format"], zero)

    def time_label(self, elapsed: float) -> str | float:
        """A time [s since the first row] as the record writes it."""
        return time_label(self.start, elapsed)


class HardwareInterface(Protocol):
    """Where rows come from: a record that is there as a whole, or sensors as they read.

    Attributes:
        source: what it is, of which a run is: another source, another run.
        station: what is mounted on the structure.
    """

    source: str
    station: Station

    @property
    def rows(self) -> int:
        """Rows that have arrived."""

    @property
    def ended(self) -> bool:
        """Whether no more will come."""

    def packet(self, first: int, rows: int) -> Packet:
        """At most so many rows from a row on."""

    def taken(self, rows: int) -> None:
        """So many rows are in the repository: they are not asked for again."""
