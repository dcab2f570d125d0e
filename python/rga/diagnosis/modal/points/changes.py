"""Points whose sensor reads otherwise from some window on: came loose, was turned, died.

A cause at a point holds for all windows, since means of shapes know no time. What a structure does
to shapes it does to many points, and by little at each.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.simulation.modal.pairing import Expected
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
    shapes: FloatArray, windows: IntArray, modes: IntArray, looks: Sequence[Expected]
) -> list[PointChange]:
    """Points that read otherwise from some window on, each with the likeliest of these.

    Args:
        shapes: of entries at all points, float[entries, points]; NaN where one did not measure.
        windows: of the entries, from 0 on, int[entries].
        modes: of the entries, int[entries]; -1: of none.
        looks: mean shapes of the modes.

    >>> look = Expected(1.0, 0.1, np.arange(4), np.full(4, 0.5))
    >>> shapes = np.random.default_rng(0).normal(1.0, 0.01, (20, 4))
    >>> shapes[10:, 2] *= 0.5
    >>> found = point_changes(shapes, np.arange(20), np.zeros(20, dtype=int), [look])
    >>> [(one.point, one.window, round(one.times, 1)) for one in found]
    [(2, 10, 0.5)]
    """
    read = _read(shapes, windows, modes, looks)
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
    shapes: FloatArray, windows: IntArray, modes: IntArray, looks: Sequence[Expected]
) -> FloatArray:
    """What each point reads of what it does on average, all modes together, float[windows, points].

    NaN where no mode of a window moves it.
    """
    count = int(windows.max(initial=-1)) + 1
    along, squares = np.zeros((2, count, shapes.shape[1]))
    for mode, look in enumerate(looks):
        for entry in np.flatnonzero(modes == mode):
            own = shapes[entry, look.at]
            seen = np.isfinite(own)
            length = float(own[seen] @ own[seen])
            if not length:
                continue
            scaled = own[seen] * float(own[seen] @ look.shape[seen]) / length
            at = look.at[seen]
            along[windows[entry], at] += scaled * look.shape[seen]
            squares[windows[entry], at] += look.shape[seen] ** 2
    return np.where(squares > MOVING, along / np.maximum(squares, 1e-300), np.nan)
