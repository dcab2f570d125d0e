"""Points whose sensor reads otherwise from some window on: came loose, was turned, died.

A cause at a point holds for all windows, since means of shapes know no time.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.numerics.robust_spread import robust_spread
from rga.simulation.modal.expected import mac

#: windows on either side of a change, standard deviations from which on it is no chance, and about
#: how many moments are tried
EITHER, SURE, SPLITS = 5, 6.0, 100
#: change of what a sensor reads that is worth telling, as a share of it; and points for each that
#: changes: where more do, it is the structure's doing
LEAST, TIMES = 0.25, 3.0
#: share of a shape of length one, squared, that must be at a point in a window to say anything
MOVING = 1e-3
#: MAC that a quarter of its entries must have with what is predicted of a mode, to be that
LIKE, QUARTER = 0.7, 0.75


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
    reads, weights = _read(shapes, windows, modes, predicted)
    found, sizes = [], []
    for point, (course, weight) in enumerate(zip(reads.T, weights.T, strict=True)):
        seen = np.flatnonzero(np.isfinite(course))
        if len(seen) < 2 * EITHER:
            continue
        own, told = course[seen], weight[seen]
        at, before, after = _split(own, told)
        off = own - np.where(np.arange(len(own)) < at, before, after)
        spread = max(robust_spread(np.sqrt(told) * off), 1e-12)
        error = spread * np.sqrt(np.pi / 2 * (1.0 / told[:at].sum() + 1.0 / told[at:].sum()))
        sure = abs(after - before) / error
        sizes.append(abs(after - before) / max(abs(before), abs(after), 1e-12))
        if sure > SURE and sizes[-1] > LEAST:
            found.append(PointChange(point, int(seen[at]), after / (before or 1e-12)))
    return found if len(found) * TIMES < len(sizes) else []


def _split(course: FloatArray, weights: FloatArray) -> tuple[int, float, float]:
    """Where a course changes the likeliest, and the weighted medians before and behind that.

    By medians, and sums of what lies about them: a window that lacks a mode, or has another, is no
    change.
    """
    best = (np.inf, 0, 0.0, 0.0)
    for at in range(EITHER, len(course) - EITHER + 1, 1 + len(course) // SPLITS):
        before, after = (_middle(course[own], weights[own]) for own in (slice(at), slice(at, None)))
        off = np.concatenate([course[:at] - before, course[at:] - after])
        best = min(best, (float(np.sqrt(weights) @ np.abs(off)), at, before, after))
    return best[1:]


def _read(
    shapes: FloatArray, windows: IntArray, modes: IntArray, predicted: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What each point reads of what is predicted, all modes together, float[windows, points].

    NaN where no mode of a window moves it; and how much they do, by which it says something.
    """
    along, squares = np.zeros((2, len(predicted), shapes.shape[1]))
    for entry in np.flatnonzero(_foreseen(shapes, windows, modes, predicted)):
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
    return np.where(squares > MOVING, along / np.maximum(squares, 1e-300), np.nan), squares


def _foreseen(
    shapes: FloatArray, windows: IntArray, modes: IntArray, predicted: FloatArray
) -> BoolArray:
    """Entries of modes that look as is predicted of them, before or behind a change."""
    named = np.flatnonzero(modes >= 0)
    alike = np.zeros(len(modes))
    for entry in named:
        shape = predicted[windows[entry], modes[entry]]
        seen = np.isfinite(shapes[entry])
        alike[entry] = mac(shapes[entry, seen], shape[seen]) if seen.any() else 0.0
    foreseen = np.zeros(len(modes), dtype=bool)
    for mode in np.unique(modes[named]):
        own = modes == mode
        foreseen[own] = np.quantile(alike[own], QUARTER) >= LIKE
    return foreseen


def _middle(values: FloatArray, weights: FloatArray) -> float:
    """Median of weighted values: a sensor that is wrong must not scale what the others read."""
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(summed, 0.5 * summed[-1])])
