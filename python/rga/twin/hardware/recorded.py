"""A finished record, played as the sensors sent it."""

import numpy as np
from numpy.typing import NDArray

from rga.errors import InputError
from rga.model.schema import Model
from rga.records import Record
from rga.records.zero import rows_within, zeros_of
from rga.twin.hardware.interface import Packet, Station

#: rows of the zero that a station keeps at most
ZERO_ROWS = 8


class Recorded:
    """Plays a record as the sensors sent it.

    Args:
        record: what was measured.
        model: names the context variables, and the logger's zero where the record does not.

    Attributes:
        record: it.

    Raises:
        InputError: no sensor, one that the model lacks, or channels that were zeroed over different
            times.
    """

    def __init__(self, record: Record, model: Model) -> None:
        self.record, self.source = record, record.sha256
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
        """Rows of the record."""
        return len(self.record)

    @property
    def ended(self) -> bool:
        """A record has all of its rows."""
        return True

    def packet(self, first: int, rows: int) -> Packet:
        """At most so many rows from a row on."""
        chosen = slice(first, first + rows)
        record = self.record
        contexts = [record.contexts[name][chosen] for name in self.station.measured]
        time = record.time[chosen]
        return Packet(
            first,
            time,
            record.readings[chosen],
            np.column_stack(contexts) if contexts else np.zeros((len(time), 0)),
        )

    def taken(self, rows: int) -> None:
        """The record stays whole."""


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
