"""What any delay costs in false alarms: a detector at all of its limits."""

import math
from collections.abc import Sequence

import numpy as np

from rga_bench.detection.rates import arl0, delay, limit_for
from rga_bench.detection.result import Point
from rga_bench.detection.watch import Course

#: limits to a curve
POINTS = 25
#: part of the rows between false alarms at which the optimum's curve begins
LOWEST = 20.0


def curve(
    name: str,
    undisturbed: Sequence[Course],
    changed: Sequence[Course],
    rows: float,
) -> list[Point]:
    """Limits from an alarm at almost every row to one in so many rows.

    Args:
        name: of the detector.
        undisturbed: streams without a change, watched without a ceiling.
        changed: streams with one, watched up to the last of the limits.
        rows: between false alarms at the last limit.
    """
    limits = (limit_for(undisturbed, one) for one in np.geomspace(1.0, rows, POINTS))
    points = []
    for limit in dict.fromkeys(limits):
        found = arl0(undisturbed, limit).rows
        if found is not None:
            points.append(Point(name, limit, found, _next(changed, limit)))
    return points


def optimal_curve(name: str, limit: float, changed: Sequence[Course], rows: float) -> list[Point]:
    """The same of the optimum, whose rows between false alarms are proportional to exp(limit).

    It sums up all that came before, so that only runs without an alarm before the onset count.

    Args:
        name: of the detector.
        limit: for so many rows between false alarms.
        changed: streams with a change.
        rows: between false alarms at that limit.
    """
    points = []
    for lower in np.linspace(-math.log(LOWEST), 0.0, POINTS // 2).tolist():
        found = delay(changed, limit + lower).mean
        if found is not None:
            points.append(Point(name, limit + lower, rows * math.exp(lower), found))
    return points


def _next(courses: Sequence[Course], limit: float) -> float:
    """Mean of the rows from the onset to the next alarm."""
    return float(np.mean([course.length(limit)[0] for course in courses]))
