"""Readings that somebody has taken out of use."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray

#: a sensor, and the clock from and to which it is out of use [s]; None: it stays so
Excluded = tuple[str, float, float | None]


def without_excluded(
    readings: FloatArray, clock: FloatArray, channels: Sequence[str], excluded: Sequence[Excluded]
) -> FloatArray:
    """Readings with NaN where a sensor is out of use, float[rows, channels].

    Args:
        readings: float[rows, channels].
        clock: of the rows [s], float[rows].
        channels: names of the sensors.
        excluded: what is out of use.

    >>> without_excluded(np.ones((3, 1)), np.arange(3.0), ["D1"], [("D1", 1.0, 2.0)]).ravel()
    array([ 1., nan,  1.])
    """
    if not excluded:
        return readings
    used = readings.copy()
    for sensor, since, until in excluded:
        out = (clock >= since) & (clock < (np.inf if until is None else until))
        used[out, channels.index(sensor)] = np.nan
    return used


def leaves_none(channels: Sequence[str], excluded: Sequence[Excluded]) -> bool:
    """Whether at some time no sensor is in use.

    Args:
        channels: names of the sensors.
        excluded: what is out of use.

    >>> late = [("D1", 100.0, None), ("D2", 50.0, 90.0)]
    >>> leaves_none(["D1", "D2"], late), leaves_none(["D1", "D2"], [*late, ("D2", 95.0, None)])
    (False, True)
    """
    # Where none is in use, it begins with one of the exclusions.
    return any(
        {name for name, begun, end in excluded if begun <= moment and (end is None or end > moment)}
        >= set(channels)
        for _, moment, _ in excluded
    )
