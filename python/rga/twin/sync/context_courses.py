"""What contexts do to readings, learned while nothing changed: a line with a bend for each."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.errors import InputError
from rga.quantities import counted

#: readings for each number that is fitted, at least
EACH = 30
#: share of the error of a reading that what was fitted may add: beyond it nothing is judged
MOST_LEVERAGE = 0.5
#: part of the range of a context by which a window may lie outside
BESIDE = 0.02


@dataclass(frozen=True)
class ContextCourses:
    """A line for each context that varies, and a bend where there are readings enough to tell.

    Attributes:
        ranges: lowest and highest value of each context in the baseline.
        bends: whether lines bend.
    """

    ranges: Mapping[str, tuple[float, float]]
    bends: bool

    @classmethod
    def of(cls, contexts: Mapping[str, FloatArray], readings: int) -> "ContextCourses":
        """Those that a baseline of so many readings can tell.

        Args:
            contexts: of its rows, float[rows] each, NaN where unknown.
            readings: of a sensor, in most of them.

        Raises:
            InputError: there are too few.
        """
        ranges = {}
        for name, column in contexts.items():
            known = column[np.isfinite(column)]
            if len(known) and np.ptp(known) > 0:
                ranges[name] = (float(known.min()), float(known.max()))
        if readings < EACH * (1 + len(ranges)):
            beside = f" beside {counted(len(ranges), 'context')}" if ranges else ""
            raise InputError(
                f"the baseline has {readings} readings of a mode{beside}, and the monitor needs "
                f"{EACH * (1 + len(ranges))}",
                "setting calibration_rows",
                "let more windows say what is usual, or leave contexts out",
            )
        return cls(ranges, readings >= EACH * (1 + 3 * len(ranges)))

    @property
    def fitted(self) -> int:
        """Numbers beside the level."""
        return (3 if self.bends else 1) * len(self.ranges)

    def columns(self, contexts: Mapping[str, FloatArray], rows: int) -> FloatArray:
        """What readings may follow, float[rows, 1 + fitted]; NaN outside of what was seen."""
        found = [np.ones(rows)]
        for name, (low, high) in self.ranges.items():
            course = 2.0 * (contexts[name] - low) / (high - low) - 1.0
            course = np.where(np.abs(course) <= 1.0 + 2.0 * BESIDE, course, np.nan)
            found += [course, course**2, np.abs(course)] if self.bends else [course]
        return np.column_stack(found)


def without_courses(columns: FloatArray, readings: FloatArray, baseline: int) -> FloatArray:
    """Readings less what they follow, to one variance, whether or not a row was learned from.

    What a fit leaves of its own rows is too small, and of others too large, by the leverage of the
    row (Cook and Weisberg, Residuals and Influence in Regression, 1982, section 2.1).

    Args:
        columns: as `ContextCourses.columns` has them, float[rows, k]; NaN in rows that are not to
            be judged.
        readings: float[rows, sensors], NaN where missing.
        baseline: rows that are learned from, the first ones.

    Returns:
        float[rows, sensors]; NaN as well for all of a sensor that has fewer readings there than two
        for each column, and where what was fitted is hardly known.

    >>> columns = np.column_stack([np.ones(6), [0.0, 0.0, 1.0, 1.0, 0.5, np.nan]])
    >>> readings = np.array([[1.0], [3.0], [5.0], [7.0], [5.0], [4.0]])
    >>> without_courses(columns, readings, 4).round(3).ravel().tolist()
    [-1.414, 1.414, -1.414, 1.414, 0.894, nan]
    """
    found = np.full_like(readings, np.nan)
    judged = np.isfinite(columns).all(axis=1)
    for sensor, column in enumerate(readings.T):
        known = judged & np.isfinite(column)
        learned = known & (np.arange(len(column)) < baseline)
        if learned.sum() < 2 * columns.shape[1]:
            continue
        inverse = np.linalg.pinv(columns[learned])
        left = column[known] - columns[known] @ (inverse @ column[learned])
        leverage = ((columns[known] @ inverse) ** 2).sum(axis=1)
        own = learned[known]
        size = np.sqrt(np.where(own, np.maximum(1.0 - leverage, 1e-9), 1.0 + leverage))
        found[known, sensor] = np.where(leverage <= MOST_LEVERAGE, left / size, np.nan)
    return found


def outside(columns: FloatArray) -> BoolArray:
    """Rows whose contexts are unknown, or outside of what was seen, bool[rows]."""
    return np.asarray(~np.isfinite(columns).all(axis=1))
