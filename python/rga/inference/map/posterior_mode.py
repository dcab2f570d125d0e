"""The most probable contexts of measured rows, by damped Gauss-Newton steps of all rows at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.inference.map.standard_units import EDGE, standard
from rga.inference.map.whitening import Whitening
from rga.numerics.gauss_newton import minimise

#: steps at most; gain of a step [chi square] below which a row rests
STEPS, GAIN = 20, 1e-2
#: half widths of a range that a context reaches at most, gain [twice the log likelihood] for which
#: a row leaves a range, and share of the half width from which on a context stands at an end
REACH, LEAVES, CLOSE = 3.0, 10.0, 1.0 - 1e-9
#: degrees of freedom of Student's distribution by which that gain is counted
TAILS = 3.0

OfContexts = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Mode:
    """The mode of the posterior of each row, and Laplace's approximation around it.

    Attributes:
        value: float[n, contexts], in the units of the contexts.
        spread: standard deviation of each, of the same shape.
        covariance: of the contexts in standard units, float[n, contexts, contexts].
        misfit: minus twice the log posterior, but for a constant, float[n].
    """

    value: FloatArray
    spread: FloatArray
    covariance: FloatArray
    misfit: FloatArray


def posterior_mode(
    simulate: OfContexts,
    jacobian: OfContexts,
    readings: FloatArray,
    covariance: FloatArray,
    ranges: FloatArray,
    start: FloatArray,
    steps: int = STEPS,
    reach: float = 1.0,
) -> Mode:
    """Gauss-Newton steps inside the ranges, damped as their success asks.

    Contexts are counted in standard units z, of which the prior is normal with unit variance, cut
    off at the ends of the range, or beyond them.

    Args:
        simulate: contexts, float[k, contexts] -> readings without noise, float[k, sensors].
        jacobian: contexts -> derivatives by them in their units, float[k, sensors, contexts].
        readings: measured, float[n, sensors]; a reading that is not finite is left out.
        covariance: of what readings may differ by from the simulation, float[sensors, sensors].
        ranges: smallest and largest of each context, float[contexts, 2].
        start: contexts to start from, float[n, contexts].
        steps: at most; 0 gives the spread at the start.
        reach: half widths of the ranges at which the prior is cut off.

    >>> slopes = np.array([[1.0, 2.0], [0.5, -1.0], [0.0, 1.0]])
    >>> found = posterior_mode(
    ...     lambda c: c @ slopes.T,
    ...     lambda c: np.tile(slopes, (len(c), 1, 1)),
    ...     np.array([[3.0, 0.0, 1.0], [3.0, 0.0, np.nan]]),
    ...     1e-6 * np.eye(3),
    ...     np.array([[-5.0, 5.0], [-5.0, 5.0]]),
    ...     np.zeros((2, 2)),
    ... )
    >>> found.value.round(3)
    array([[1.429, 0.81 ],
           [1.5  , 0.75 ]])
    """
    middle, scale = standard(ranges)
    seen = np.isfinite(readings)
    filled, whiten = np.where(seen, readings, 0.0), Whitening(covariance, seen)

    def residual(z: FloatArray, rows: IntArray) -> FloatArray:
        off = simulate(middle + scale * z) - filled[rows]
        return whiten(off[:, :, None], rows)[:, :, 0]

    def slope(z: FloatArray, rows: IntArray) -> FloatArray:
        return whiten(jacobian(middle + scale * z) * scale, rows)

    found = minimise(residual, slope, (start - middle) / scale, reach * EDGE, steps, GAIN)
    spread = np.asarray(np.linalg.inv(found.normal), dtype=float)
    deviation: FloatArray = np.sqrt(np.diagonal(spread, axis1=1, axis2=2))
    return Mode(middle + scale * found.z, scale * deviation, spread, found.misfit)


def mode_beyond(
    simulate: OfContexts,
    jacobian: OfContexts,
    readings: FloatArray,
    covariance: FloatArray,
    noise: FloatArray,
    ranges: FloatArray,
    start: FloatArray,
) -> Mode:
    """The same, in which a row leaves the ranges where it cannot be explained inside.

    Ranges are what is expected, and a structure sees a crowd that nobody expected. Rows that stand
    at an end of a range are tried beyond it, and stay there where many sensors are explained far
    better: a few that lie are left what they are, and what is not sure of a structure is no reason
    to think that a row lies inside.

    Args:
        noise: standard deviation of each reading, float[sensors].
    """
    inside = posterior_mode(simulate, jacobian, readings, covariance, ranges, start)
    middle, scale = standard(ranges)
    stuck = np.flatnonzero((np.abs(inside.value - middle) > scale * EDGE * CLOSE).any(axis=1))
    if not len(stuck):
        return inside
    begun, read = inside.value[stuck], readings[stuck]
    beyond = posterior_mode(simulate, jacobian, read, covariance, ranges, begun, reach=REACH)

    def unlikely(value: FloatArray) -> FloatArray:
        square = ((read - simulate(value)) / noise) ** 2
        by_sensor = np.where(np.isfinite(square), (TAILS + 1.0) * np.log1p(square / TAILS), 0.0)
        return np.asarray(by_sensor.sum(axis=1) + (((value - middle) / scale) ** 2).sum(axis=1))

    better = unlikely(beyond.value) < unlikely(begun) - LEAVES
    for own, other in zip(vars(inside).values(), vars(beyond).values(), strict=True):
        own[stuck[better]] = other[better]
    return inside
