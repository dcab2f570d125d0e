"""The hardware interface: what the structure's sensors send, packet by packet."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import seconds
from rga.model.schema import Model
from rga.records import Record
from rga.records.zero import rows_within, zeros_of

#: rows of the zero that a station keeps at most
ZERO_ROWS = 8


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


class HardwareInterface:
    """Plays a record as the sensors sent it.

    A live station takes its place by offering the same three members.

    Args:
        record: what was measured.
        model: names the context variables, and the logger's zero where the record does not.

    Raises:
        InputError: no sensor, one that the model lacks, or channels that were zeroed over different
            times.
    """

    def __init__(self, record: Record, model: Model) -> None:
        self._record = record
        place, unknown = f"model {model.name!r}", set(record.sensors) - set(model.sensors)
        if unknown:
            names = ", ".join(sorted(unknown))
            raise InputError(f"it has no sensor {names}", place, "add it, or leave it out")
        if not record.sensors:
            raise InputError("the record holds no sensor of it", place, "give one to the record")
        measured = tuple(name for name in model.context if name in record.contexts)
        leading = _zero_rows(record, model)
        zero = {name: record.contexts[name][leading] for name in measured}
        zero["time"] = record.origin + record.time[leading]
        self.station = Station(
            tuple(record.sensors), measured, record.start, record.time_format, zero
        )

    @property
    def rows(self) -> int:
        """Rows that have arrived."""
        return len(self._record)

    def packet(self, first: int, rows: int) -> Packet:
        """At most so many rows from a row on."""
        chosen = slice(first, first + rows)
        record = self._record
        contexts = [record.contexts[name][chosen] for name in self.station.measured]
        time = record.time[chosen]
        return Packet(
            first,
            time,
            record.readings[chosen],
            np.column_stack(contexts) if contexts else np.zeros((len(time), 0)),
        )


def _zero_rows(record: Record, model: Model) -> NDArray[np.int64]:
    """Some of the rows whose mean was taken off every channel; none where nothing was."""
    of_sensors = dict(zip(model.sensors, zeros_of(model, record), strict=True))
    intervals = {of_sensors[name] for name in record.sensors}
    if len(intervals) > 1:
        raise InputError(
            "the channels were zeroed over different times",
            f"zero of the sensors of model {model.name!r}",
            "give one zero = [from, to] for all channels in import.toml",
        )
    rows = rows_within(record.time, next(iter(intervals)))
    few = np.linspace(0, len(rows) - 1, min(ZERO_ROWS, len(rows))).astype(np.int64)
    return rows[few]
