"""Points whose sensor reads otherwise from some window on: came loose, was turned, died.

A cause at a point holds for all windows, since means of shapes know no time.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.numerics.robust_spread import robust_spread

#: windows on either side of a change, standard deviations from which on it is no chance, and about
#: how many moments are tried
EITHER, SURE, SPLITS = 5, 6.0, 100
#: change of what a sensor reads that is worth telling, as a share of it; and points for each that
#: changes: where more do, it is the structure's doing
LEAST, TIMES = 0.25, 3.0
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
    found, sizes = [], []
    for point, course in enumerate(read.T):
        seen = np.flatnonzero(np.isfinite(course))
        if len(seen) < 2 * EITHER:
            continue
        own = course[seen]
        at, before, after = _split(own)
        off = own - np.where(np.arange(len(own)) < at, before, after)
        spread = max(robust_spread(off), 1e-12)
        error = spread * np.sqrt(np.pi / 2 * (1.0 / at + 1.0 / (len(own) - at)))
        sure = abs(after - before) / error
        sizes.append(abs(after - before) / max(abs(before), abs(after), 1e-12))
        if sure > SURE and sizes[-1] > LEAST:
            found.append(PointChange(point, int(seen[at]), after / (before or 1e-12)))
    return found if len(found) * TIMES < len(sizes) else []


def _split(course: FloatArray) -> tuple[int, float, float]:
    """Where a course changes the likeliest, and the medians before and behind that.

    By medians, and sums of what lies about them: a window that lacks a mode, or has another, is no
    change.
    """
    best = (np.inf, 0, 0.0, 0.0)
    for at in range(EITHER, len(course) - EITHER + 1, 1 + len(course) // SPLITS):
        before, after = float(np.median(course[:at])), float(np.median(course[at:]))
        about = float(np.abs(course[:at] - before).sum() + np.abs(course[at:] - after).sum())
        best = min(best, (about, at, before, after))
    return best[1:]


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
