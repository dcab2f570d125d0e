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
