"""The spread of deviations that a few far out do not enlarge."""

import numpy as np

from rga.arrays import FloatArray

#: median size of a standard normal deviation: the 75 % quantile of its distribution
MEDIAN_SIZE = 0.6744897501960817


def robust_spread(deviations: FloatArray) -> float:
    """Standard deviation of normal deviations about zero, by their median size.

    The median of sizes over that of a standard normal one (F. R. Hampel, The influence curve and
    its role in robust estimation, 1974).

    Args:
        deviations: float[k], finite.

    Returns:
        In the units of the deviations; zero where there are none.

    >>> deviations = np.random.default_rng(0).normal(0.0, 2.0, 10_000)
    >>> deviations[:500] = 1e6
    >>> round(robust_spread(deviations), 1)
    2.1
    """
    if not len(deviations):
        return 0.0
    return float(np.median(np.abs(deviations))) / MEDIAN_SIZE
