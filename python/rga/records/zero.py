"""The logger's zero: the interval whose mean was taken off a channel."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import seconds
from rga.model.schema import Model
from rga.records.record import Record

#: from and to [s since the first row]
Interval = tuple[float, float]


def zeros_of(model: Model, record: Record) -> list[Interval | None]:
    """The interval whose mean was taken off each sensor of a model; None where nothing was.

    That of the record goes before those that the model states, since it was taken off last.

    Raises:
        InputError: a channel of the record was zeroed outside the times of the record: what acted
            there is not known.
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
    outside = [
        name
        for name, zero in zip(model.sensors, found, strict=True)
        if name in record.sensors and lies_outside(record.time, zero)
    ]
    if outside:
        raise _refused(model, record, outside)
    return found


def lies_outside(time: FloatArray, interval: Interval | None) -> bool:
    """Whether an interval has no moment between the first row and the last.

    >>> [lies_outside(np.arange(4.0), one) for one in ((3.0, 9.0), (4.0, 9.0), None)]
    [False, True, False]
    """
    if interval is None or not len(time):
        return False
    return bool(interval[1] < time[0] or interval[0] > time[-1])


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


def _refused(model: Model, record: Record, outside: list[str]) -> InputError:
    name, more = outside[0], len(outside) - 1
    stated = " to ".join(str(moment) for moment in model.sensors[name].zero or ())
    start, end = (record.time_label(float(record.time[row])) for row in (0, -1))
    return InputError(
        f"the zero from {stated} lies outside the record, {start} to {end}",
        f"sensor {name!r}{f' and {more} more' if more else ''} of model {model.name!r}",
        'give "zero" in the times of the record, or leave it out where none was taken off',
    )
