"""Many structures along a straight line of parameters: a few are solved, the rest lie between.

The response of a structure to unit loads is a rational function of its parameters, smooth between
stable structures. So its interpolant in Chebyshev points converges geometrically (Trefethen,
Approximation Theory and Approximation Practice, 2013, chapter 8); points are doubled until what
they add is rounding.
"""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from rga.model.parameter import FloatArray

#: Chebyshev points to begin with and at most
FIRST, MOST = 9, 33
#: share of the largest response that the last doubling may change
EXACT = 1e-11
#: places at which that is looked for
TRIED = 40


def positions(states: FloatArray) -> FloatArray | None:
    """Places of parameters along the line that they all lie on, float[states] in 0..1.

    None where they lie on no line, or where there are too few to gain by it.

    >>> positions(np.array([[1.0, 2.0], [2.0, 4.0]]))
    """
    if len(states) <= MOST or not np.isfinite(states).all():
        return None
    start, end = states[0], states[np.argmax(np.abs(states - states[0]).sum(1))]
    along = end - start
    if not along.any():
        return None
    place = (states - start) @ along / (along @ along)
    off = states - start - place[:, None] * along
    scale = np.abs(states).max(0)
    if (np.abs(off) > 1e-12 * scale).any():
        return None
    low, high = place.min(), place.max()
    return np.asarray((place - low) / (high - low))


def between(
    first: FloatArray, last: FloatArray, solve: Callable[[FloatArray], FloatArray]
) -> Callable[[FloatArray], FloatArray] | None:
    """Responses by places between two states; None where few points do not suffice.

    Args:
        first, last: the parameters at both ends, float[parameters].
        solve: the response of parameters, float[patterns, outputs].

    Returns:
        A function from places float[n] in 0..1 to responses float[n, patterns, outputs].
    """
    known: dict[float, FloatArray] = {}

    def interpolant(count: int) -> Callable[[FloatArray], FloatArray]:
        points = np.round(0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1)), 12)
        for point in set(points) - known.keys():
            known[point] = solve(first + point * (last - first))
        there = np.stack([known[point] for point in points])
        # The weights of Chebyshev points are known; else they are worked out in random order.
        weights = (-1.0) ** np.arange(count)
        weights[[0, -1]] /= 2
        found: Callable[[FloatArray], FloatArray] = BarycentricInterpolator(
            points, there, wi=weights
        )
        return found

    tried = np.linspace(0.0, 1.0, TRIED)
    count = FIRST
    found = interpolant(count)
    while count < MOST:
        count = 2 * count - 1
        before, found = found, interpolant(count)
        there = found(tried)
        if np.abs(there - before(tried)).max() <= EXACT * np.abs(there).max():
            return found
    return None
