"""Means of a channel about the rows of another logger."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: usual steps between two rows, beyond which nothing is put between them
GAP = 1.5
#: share of a window that readings must fill, and that two of them may lie apart
FILLED, APART = 0.5, 0.5


def means_about(
    times: FloatArray, values: FloatArray, rows: FloatArray, width: float
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Means in time of a signal that runs straight from reading to reading, about each row.

    A window that is not filled is narrowed alike on both sides of its row, so that a signal that
    grows evenly keeps its value; where less than half of it is left, the mean is missing.

    Args:
        times: of the readings, which increase [s], float[n].
        values: readings, float[n], NaN where one is missing.
        rows: times of the rows [s], float[m].
        width: of the window about each row [s].

    Returns:
        Means, float[m], NaN where readings are lacking; how many readings each has, int[m].

    >>> times, rows = np.arange(7.0), np.array([0.0, 2.0, 3.0, 5.5])
    >>> means_about(times, 10 + times, rows, 4.0)
    (array([nan, 12., 13., nan]), array([0, 5, 5, 0]))
    """
    held = np.isfinite(values)
    times, values = times[held], values[held]
    means, counts = np.full(len(rows), np.nan), np.zeros(len(rows), dtype=np.int64)
    if len(times) < 2 or width <= 0:
        return means, counts
    steps = np.diff(times)
    breaks = np.flatnonzero(steps > max(APART * width, GAP * float(np.median(steps))))
    begins, ends = times[np.append(0, breaks + 1)], times[np.append(breaks, len(times) - 1)]
    run = np.searchsorted(begins, rows, side="right").clip(1) - 1
    half = np.minimum(np.minimum(rows - begins[run], ends[run] - rows), width / 2)
    filled = half >= FILLED * width / 2
    first, last = (rows - half)[filled], (rows + half)[filled]
    # About a middle, sums lose no digits.
    middle = float(np.mean(values))
    area = _areas(times, values - middle, last) - _areas(times, values - middle, first)
    means[filled] = area / (last - first) + middle
    counts[filled] = np.searchsorted(times, last, "right") - np.searchsorted(times, first, "left")
    return means, counts


def _areas(times: FloatArray, values: FloatArray, until: FloatArray) -> FloatArray:
    """Integrals of the signal from the first reading to some times."""
    steps, rises = np.diff(times), np.diff(values)
    whole = np.append(0.0, np.cumsum(steps * (values[:-1] + values[1:]) / 2))
    before = (np.searchsorted(times, until, side="right") - 1).clip(0, len(steps) - 1)
    rest = until - times[before]
    slope = rises[before] / steps[before]
    return np.asarray(whole[before] + rest * (values[before] + slope * rest / 2))
