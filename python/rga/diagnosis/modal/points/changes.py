"""Points whose sensor reads otherwise from some window on: came loose, was turned, died.

A cause at a point holds for all windows, since means of shapes know no time.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.simulation.modal.windows import MEDIAN_STEP

#: windows on either side of a change, and standard deviations from which on it is no chance
EITHER, SURE = 5, 6.0
#: change of what a sensor reads that is worth telling, as a share of it; and how many times that of
#: the point in the middle it is
LEAST, TIMES = 0.2, 3.0
#: share of a shape of length one, squared, that must be at a point in a window to say anything
MOVING = 1e-3


@dataclass(frozen=True)
class PointChange:
    """A sensor at a point that reads otherwise.

    Attributes:
        point: its number.
        window: the first of them.
        times: by what it reads more from then on.
    """

    point: int
    window: int
    times: float


def point_changes(
    shapes: FloatArray, windows: IntArray, modes: IntArray, predicted: FloatArray
) -> list[PointChange]:
    """Points that read otherwise from some window on, each with the likeliest of these.

    Args:
        shapes: of entries at all points, float[entries, points]; NaN where one did not measure.
        windows: of the entries, from 0 on, int[entries].
        modes: of the entries, int[entries]; negative: of none.
        predicted: the shapes of the modes, float[windows, modes, points].

    >>> shapes = np.random.default_rng(0).normal(1.0, 0.01, (20, 4))
    >>> shapes[10:, 2] *= 0.5
    >>> found = point_changes(shapes, np.arange(20), np.zeros(20, dtype=int), np.ones((20, 1, 4)))
    >>> [(one.point, one.window, round(one.times, 1)) for one in found]
    [(2, 10, 0.5)]
    """
    read = _read(shapes, windows, modes, predicted)
    found: list[PointChange] = []
    sizes = []
    for point, course in enumerate(read.T):
        seen = np.flatnonzero(np.isfinite(course))
        own = course[seen]
        if len(own) < 2 * EITHER:
            continue
        spread = max(float(np.median(np.abs(np.diff(own)))) / MEDIAN_STEP, 1e-12)
        before = np.cumsum(own)[EITHER - 1 : len(own) - EITHER]
        counts = np.arange(EITHER, len(own) - EITHER + 1)
        steps = (own.sum() - before) / (len(own) - counts) - before / counts
        sure = np.abs(steps) / spread / np.sqrt(1.0 / counts + 1.0 / (len(own) - counts))
        best = int(np.argmax(sure))
        first = float(before[best] / counts[best])
        size = float(steps[best]) / max(abs(first), abs(first + steps[best]), 1e-12)
        sizes.append(abs(size))
        if sure[best] > SURE and abs(size) > LEAST:
            times = (first + float(steps[best])) / (first or 1e-12)
            found.append(PointChange(point, int(seen[counts[best]]), times))
    return found if len(found) * TIMES < len(sizes) else []


def _read(
    shapes: FloatArray, windows: IntArray, modes: IntArray, predicted: FloatArray
) -> FloatArray:
    """What each point reads of what is predicted, all modes together, float[windows, points].

    NaN where no mode of a window moves it.
    """
    along, squares = np.zeros((2, len(predicted), shapes.shape[1]))
    for entry in np.flatnonzero(modes >= 0):
        window = windows[entry]
        shape = predicted[window, modes[entry]]
        seen = np.flatnonzero(np.isfinite(shapes[entry]) & (shape != 0.0))
        length = float(np.linalg.norm(shape[seen]))
        times = shapes[entry, seen] / shape[seen]
        scale = _middle(times, shape[seen] ** 2) if length > 0.0 else 0.0
        if scale:
            weights = (shape[seen] / length) ** 2
            along[window, seen] += times / scale * weights
            squares[window, seen] += weights
    return np.where(squares > MOVING, along / np.maximum(squares, 1e-300), np.nan)


def _middle(values: FloatArray, weights: FloatArray) -> float:
    """Median of weighted values: a sensor that is wrong must not scale what the others read."""
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(summed, 0.5 * summed[-1])])
