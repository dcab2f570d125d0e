"""The most probable contexts of measured rows, by damped Gauss-Newton steps of all rows at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference.map.bounded_newton import EDGE, box_step
from rga.inference.map.whitening import Whitening

#: damping at first, and what it falls to at most after a step, as a share
DAMPING, FALL = 1e-2, 0.2
#: steps at most; damping beyond which a row rests; gain of a step [chi square] below which it does
STEPS, STUCK, GAIN = 20, 1e8, 1e-2

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


def standard(ranges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Middle and standard deviation of contexts spread evenly over ranges, float[contexts] each."""
    return ranges.mean(axis=1), np.ptp(ranges, axis=1) / (2.0 * EDGE)


def posterior_mode(
    simulate: OfContexts,
    jacobian: OfContexts,
    readings: FloatArray,
    covariance: FloatArray,
    ranges: FloatArray,
    start: FloatArray,
    steps: int = STEPS,
) -> Mode:
    """Gauss-Newton steps inside the ranges, damped as their success asks.

    Contexts are counted in standard units z, of which the prior is normal with unit variance, cut
    off at the ends of the range. The damping is Nielsen's (Madsen, Nielsen and Tingleff, Methods
    for non-linear least squares problems, 2004).

    Args:
        simulate: contexts, float[k, contexts] -> readings without noise, float[k, sensors].
        jacobian: contexts -> derivatives by them in their units, float[k, sensors, contexts].
        readings: measured, float[n, sensors]; a reading that is not finite is left out.
        covariance: of what readings may differ by from the simulation, float[sensors, sensors].
        ranges: smallest and largest of each context, float[contexts, 2].
        start: contexts to start from, float[n, contexts].
        steps: at most; 0 tells the spread at the start.

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
    rows, size = np.arange(len(readings)), len(scale)

    def residual(z: FloatArray, of: NDArray[np.int64]) -> FloatArray:
        off = filled[of] - simulate(middle + scale * z)
        return whiten(off[:, :, None], of)[:, :, 0]

    def height(off: FloatArray, z: FloatArray) -> FloatArray:
        return np.asarray((off**2).sum(axis=1) + (z**2).sum(axis=1))

    z = np.clip((start - middle) / scale, -EDGE, EDGE)
    off = residual(z, rows)
    misfit = height(off, z)
    damping, rise = np.full(len(z), DAMPING), np.full(len(z), 2.0)
    normal, descent = np.empty((len(z), size, size)), np.empty((len(z), size))

    def linearise(of: NDArray[np.int64]) -> None:
        slope = whiten(jacobian(middle + scale * z[of]) * scale, of)
        turned = slope.transpose(0, 2, 1)
        normal[of] = turned @ slope + np.eye(size)
        descent[of] = (turned @ off[of, :, None])[:, :, 0] - z[of]

    left, moved = rows, rows
    for _ in range(steps):
        linearise(moved)
        step = box_step(normal[left], descent[left], z[left], damping[left])
        bent = (normal[left] @ step[:, :, None])[:, :, 0]
        promised = ((2.0 * descent[left] - bent) * step).sum(axis=1)
        off_there = residual(z[left] + step, left)
        gained = misfit[left] - height(off_there, z[left] + step)
        good = gained >= 0.0
        moved = left[good]
        z[moved] += step[good]
        off[moved], misfit[moved] = off_there[good], misfit[moved] - gained[good]
        share = gained / np.maximum(promised, GAIN)
        falls = np.maximum(FALL, 1.0 - (2.0 * share - 1.0) ** 3)
        damping[left] *= np.where(good, falls, rise[left])
        rise[left] = np.where(good, 2.0, 2.0 * rise[left])
        left = left[(promised > GAIN) & (damping[left] < STUCK)]
        moved = np.intersect1d(moved, left)
        if not len(left):
            break
    linearise(rows)
    spread = np.asarray(np.linalg.inv(normal), dtype=float)
    deviation: FloatArray = np.sqrt(np.diagonal(spread, axis1=1, axis2=2))
    return Mode(middle + scale * z, scale * deviation, spread, misfit)
