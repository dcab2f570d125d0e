"""The logger's zero: the interval whose mean was taken off a channel."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.model.effect import seconds
from rga.model.schema import Model
from rga.records.record import Record

#: from and to [s since the first row]
Interval = tuple[float, float]


def zeros_of(model: Model, record: Record) -> list[Interval | None]:
    """The interval whose mean was taken off each sensor of a model; None where nothing was.

    That of the record goes before those that the model states, since it was taken off last.
    """
    if record.zero is not None:
        return [record.zero] * len(model.sensors)
    found: list[Interval | None] = []
    for sensor in model.sensors.values():
        if sensor.zero is None:
            found.append(None)
        else:
            first, last = (seconds(moment) - record.origin for moment in sensor.zero)
            found.append((first, last))
    return found


def rows_within(time: FloatArray, interval: Interval | None) -> NDArray[np.int64]:
    """The rows within an interval; where there are none, the row nearest to it.

    >>> rows_within(np.arange(4.0), (0.0, 1.0))
    array([0, 1])
    """
    if interval is None or not len(time):
        return np.zeros(0, dtype=np.int64)
    first, end = interval
    within = np.flatnonzero((time >= first) & (time <= end))
    if len(within):
        return within
    return np.array([np.abs(time - (first + end) / 2).argmin()], dtype=np.int64)
