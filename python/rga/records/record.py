"""A measured record: time, sensor channels and the contexts that were measured."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.model.effect import seconds


@dataclass(frozen=True)
class Record:
    """Measured data in the units of the model.

    Attributes:
        time: float[n], seconds since the first row of the file; strictly increasing.
        start: time stamp of the first row of the file: ISO 8601 text, or seconds.
        time_format: how the file gives time, "iso" or "seconds".
        sensors: names of the channels present, in the order of the model.
        readings: float[n, len(sensors)], NaN where a value is missing.
        contexts: measured context variables, float[n] each, NaN where a value is missing.
        unused: channels that are left out, with the reason.
        zero: interval [s since the first row] whose mean was taken off every channel, if any.
        warnings: what the reader should know of the data, in words.
        notes: what was understood of the files, and what was assumed, in words.
        sha256: hash of the file.

    >>> record = Record(np.arange(3.0), 10.0, "seconds", ("D1",), np.zeros((3, 1)))
    >>> record.time_label(1.5)
    11.5
    >>> record.rows(slice(1, None)).time
    array([1., 2.])
    """

    time: FloatArray
    start: str | float
    time_format: Literal["iso", "seconds"]
    sensors: tuple[str, ...]
    readings: FloatArray
    contexts: dict[str, FloatArray] = field(default_factory=dict)
    unused: dict[str, str] = field(default_factory=dict)
    zero: tuple[float, float] | None = None
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    sha256: str = ""

    def __len__(self) -> int:
        return len(self.time)

    @property
    def origin(self) -> float:
        """Time of the first row on the scale of onsets [s]: as in the file, or since 1970."""
        return seconds(self.start)

    def time_label(self, elapsed: float) -> str | float:
        """A time [s since the first row] as the record writes it: ISO 8601 text, or seconds."""
        if isinstance(self.start, str):
            moment = datetime.fromisoformat(self.start) + timedelta(seconds=float(elapsed))
            whole_ms = moment.microsecond and moment.microsecond % 1000 == 0
            return moment.isoformat(timespec="milliseconds" if whole_ms else "auto")
        return round(self.start + float(elapsed), 9)

    def rows(self, chosen: NDArray[np.bool_] | slice) -> "Record":
        """The chosen rows; time still counts from the first row of the file."""
        return replace(
            self,
            time=self.time[chosen],
            readings=self.readings[chosen],
            contexts={name: values[chosen] for name, values in self.contexts.items()},
        )

    def channels(self, keep: Sequence[str]) -> "Record":
        """The record with the sensors `keep` only, in their present order.

        Raises:
            KeyError: a sensor to keep is not in the record.
        """
        if absent := set(keep) - set(self.sensors):
            raise KeyError(f"the record has no channel {sorted(absent)}")
        columns = [column for column, name in enumerate(self.sensors) if name in keep]
        return replace(
            self,
            sensors=tuple(self.sensors[column] for column in columns),
            readings=self.readings[:, columns],
        )
