"""Single values of a course that lie far off those about them."""

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.numerics.robust_spread import robust_spread

#: values on either side that one is held against, and how many of these must be near it
BESIDE, NEAR = 3, 2
#: spreads of the steps from value to value beyond which one is not near
FAR = 8.0
#: share of the values that may lie off: where more do, they are no errors; fewest values that show
#: any
MOST, FEWEST = 0.1, 10


def lone_values(course: FloatArray, least: float) -> BoolArray:
    """Which values have hardly any near them, before or behind: no state that lasts.

    A state of three values and more is none of these, and neither is a slow change.

    Args:
        course: float[k], finite, in the order of time.
        least: what is near in any case, in the units of the course.

    Returns:
        bool[k].

    >>> course = np.sin(np.arange(40.0) / 9.0)
    >>> course[7] += 5.0
    >>> course[20:23] -= 5.0
    >>> np.flatnonzero(lone_values(course, 0.1)).tolist()
    [7]
    """
    lone = np.zeros(len(course), dtype=bool)
    if len(course) < FEWEST:
        return lone
    near = max(FAR * robust_spread(np.diff(course)), least)
    for at, value in enumerate(course):
        about = np.r_[course[max(0, at - BESIDE) : at], course[at + 1 : at + 1 + BESIDE]]
        lone[at] = (np.abs(about - value) <= near).sum() < NEAR
    return lone if lone.sum() <= MOST * len(course) else np.zeros_like(lone)
