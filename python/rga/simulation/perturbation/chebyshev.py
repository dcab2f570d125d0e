"""Many structures along straight lines of parameters: a few are solved, the rest lie between.

The response of a structure to unit loads is a rational function of its parameters, smooth between
stable structures. So its interpolant in Chebyshev points converges geometrically (Trefethen,
Approximation Theory and Approximation Practice, 2013, chapter 8); points are doubled until what
they add is rounding.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import scipy

from rga.arrays import FloatArray, IntArray
from rga.model.structure import Structure

if TYPE_CHECKING:
    from rga.simulation.dispatch import Request

#: Chebyshev points to begin with and at most
FIRST, MOST = 9, 65
#: share of the largest response that the last doubling may change
EXACT = 1e-10
#: places at which that is looked for
TRIED = 40
#: values of a parameter that are few, and states on a line that are solved one by one
FEW, FEWEST = 4, 33
#: rows that are answered together
TOGETHER = 256


def along_line(
    request: "Request", solve: Callable[[Structure], tuple[FloatArray, FloatArray]]
) -> FloatArray | None:
    """Rows whose structures lie on a few lines, without memory, play or large displacements.

    Args:
        request: what is asked.
        solve: coefficients of the load patterns on a structure, float[rows, patterns], and the
            response to each pattern, float[patterns, outputs]; patterns in the same order always.

    Returns:
        float[rows, outputs], or None where few points do not suffice.
    """
    found: FloatArray | None = None
    for chosen in _apart(request.states):
        states = request.states[chosen]
        rows = np.flatnonzero(np.isin(request.state_of_row, chosen))
        of_rows = np.searchsorted(chosen, request.state_of_row[rows])
        coefficients: list[FloatArray] = []

        def response_at(state: FloatArray, known: list[FloatArray] = coefficients) -> FloatArray:
            q, response = solve(request.change(state))
            known[:] = [q]
            return response

        place = positions(states)
        if place is None and len(states) > FEWEST:
            return None
        # A stop that comes with time is none at one end of its line.
        ends = states if place is None else states[[np.argmin(place), np.argmax(place)]]
        structures = [request.change(state) for state in ends]
        if not all(structure.linear for structure in structures):
            return None
        if not all(request.same_patterns(structures[0], other) for other in structures[1:]):
            return None
        if place is None:
            each = np.stack([response_at(state) for state in states])
            part = np.einsum("tp,tpo->to", coefficients[0][rows], each[of_rows])
        else:
            response = between(ends[0], ends[-1], response_at)
            if response is None:
                return None
            few = [slice(start, start + TOGETHER) for start in range(0, len(rows), TOGETHER)]
            parts = [
                np.einsum("tp,tpo->to", coefficients[0][rows[some]], response(place[of_rows[some]]))
                for some in few
            ]
            part = np.concatenate(parts)
        if found is None:
            found = np.empty((len(request.state_of_row), part.shape[1]))
        found[rows] = part
    return found


def _apart(states: FloatArray) -> list[IntArray]:
    """Numbers of the states that share the parameters of few values, in their order.

    What begins late takes two values; what follows a context takes many.
    """
    few = [len(np.unique(column)) <= FEW for column in states.T]
    if not any(few):
        return [np.arange(len(states))]
    _, part = np.unique(states[:, few], axis=0, return_inverse=True)
    return [np.flatnonzero(part.ravel() == number) for number in range(part.max() + 1)]


def positions(states: FloatArray) -> FloatArray | None:
    """Places of parameters along the line that they all lie on, float[states] in 0..1.

    None where they lie on no line, or where there are too few to gain by it.

    >>> positions(np.array([[1.0, 2.0], [2.0, 4.0]]))
    """
    # What holds rigidly all the time has an infinite stiffness, and still varies no structure.
    states = states[:, (states != states[:1]).any(0)]
    if len(states) <= FEWEST or not np.isfinite(states).all():
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
    along = np.subtract(last, first, out=np.zeros_like(first), where=last != first)

    def interpolant(count: int) -> Callable[[FloatArray], FloatArray]:
        points = np.round(0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1)), 12)
        for point in set(points) - known.keys():
            known[point] = solve(first + point * along)
        there = np.stack([known[point] for point in points])
        # The weights of Chebyshev points are known; else they are worked out in random order.
        weights = (-1.0) ** np.arange(count)
        weights[[0, -1]] /= 2
        found: Callable[[FloatArray], FloatArray] = scipy.interpolate.BarycentricInterpolator(
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
