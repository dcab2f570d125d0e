"""Contexts in standard units: spread evenly over a range, with mean 0 and variance 1."""

import numpy as np

from rga.arrays import FloatArray

#: half the width of a range in standard units
EDGE = float(np.sqrt(3.0))


def standard(ranges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean and standard deviation of contexts spread evenly over ranges, float[contexts] each.

    Args:
        ranges: smallest and largest of each context, float[contexts, 2].

    >>> standard(np.array([[0.0, 6.0]]))[0]
    array([3.])
    """
    return ranges.mean(axis=1), np.ptp(ranges, axis=1) / (2.0 * EDGE)
