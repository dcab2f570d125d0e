"""The most probable contexts of measured rows, by damped Gauss-Newton steps of all rows at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.inference.whitening import Whitening
from rga.model.parameter import FloatArray

#: half the width of a range whose uniform law has unit variance
EDGE = np.sqrt(3.0)
#: damping at first, and what it is multiplied with after a step that failed, divided by after one
#: that did not
DAMPING, FACTOR = 1e-3, 8.0
#: steps at most; damping beyond which a row rests; gain of a step [chi square] below which it does
STEPS, STUCK, GAIN = 30, 1e8, 1e-3

OfContexts = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Mode:
    """The mode of the posterior of each row, and Laplace's approximation around it.

    Attributes:
        value: float[n, contexts], in the units of the contexts.
        spread: standard deviation of each, of the same shape.
        covariance: in standard units, float[n, contexts, contexts].
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
    """Levenberg-Marquardt steps (Marquardt, SIAM J. Appl. Math. 11, 1963) inside the ranges.

    Contexts are counted in standard units z, of which the prior is normal with unit variance, cut
    off at the ends of the range. A context that stands at an end and would leave is held there for
    the step (Bertsekas, SIAM J. Control Optim. 20, 1982).

    Args:
        simulate: contexts, float[k, contexts] -> readings without noise, float[k, sensors].
        jacobian: contexts -> derivatives by them in their units, float[k, sensors, contexts].
        readings: measured, float[n, sensors]; a reading that is not finite is left out.
        covariance: of what readings may differ by from the simulation, float[sensors, sensors].
        ranges: smallest and largest of each context, float[contexts, 2].
        start: contexts to start from, float[n, contexts].
        steps: at most; 0 linearises at the start.

    >>> slopes = np.array([[1.0, 2.0], [0.5, -1.0], [0.0, 1.0]])
    >>> found = posterior_mode(
    ...     lambda c: c @ slopes.T,
    ...     lambda c: np.tile(slopes, (len(c), 1, 1)),
    ...     np.array([[3.0, 0.0, 1.0]]),
    ...     1e-6 * np.eye(3),
    ...     np.array([[-5.0, 5.0], [-5.0, 5.0]]),
    ...     np.zeros((1, 2)),
    ... )
    >>> found.value.round(3)
    array([[1.556, 0.741]])
    """
    middle, scale = standard(ranges)
    seen = np.isfinite(readings)
    filled, whiten = np.where(seen, readings, 0.0), Whitening(covariance, seen)
    rows, size = np.arange(len(readings)), len(scale)

    def residual(z: FloatArray, of: FloatArray) -> FloatArray:
        off = filled[of] - simulate(middle + scale * z)
        return whiten(off[:, :, None], of)[:, :, 0]

    def height(off: FloatArray, z: FloatArray) -> FloatArray:
        return (off**2).sum(axis=1) + (z**2).sum(axis=1)

    def normal_equations(of: FloatArray) -> None:
        slope = whiten(jacobian(middle + scale * z[of]) * scale, of)
        turned = slope.transpose(0, 2, 1)
        normal[of] = turned @ slope + np.eye(size)
        descent[of] = (turned @ off[of, :, None])[:, :, 0] - z[of]

    z = np.clip((start - middle) / scale, -EDGE, EDGE)
    off = residual(z, rows)
    misfit, damping = height(off, z), np.full(len(z), DAMPING)
    normal, descent = np.empty((len(z), size, size)), np.empty((len(z), size))
    left, moved = rows, rows
    for _ in range(steps):
        normal_equations(moved)
        step = _inside(normal[left], descent[left], z[left], damping[left])
        promise = np.einsum("nc,nc->n", descent[left], step)
        trial = np.clip(z[left] + step, -EDGE, EDGE)
        off_there = residual(trial, left)
        there = height(off_there, trial)
        better = there <= misfit[left]
        moved = left[better]
        z[moved], off[moved], misfit[moved] = trial[better], off_there[better], there[better]
        damping[left] *= np.where(better, 1.0 / FACTOR, FACTOR)
        left = left[(promise > GAIN) & (damping[left] < STUCK)]
        moved = np.intersect1d(moved, left)
        if not len(left):
            break
    normal_equations(rows)
    spread = np.linalg.inv(normal)
    deviation = np.sqrt(np.diagonal(spread, axis1=1, axis2=2))
    return Mode(middle + scale * z, scale * deviation, spread, misfit)


def _inside(
    normal: FloatArray, descent: FloatArray, z: FloatArray, damping: FloatArray
) -> FloatArray:
    """Damped steps, float[k, contexts], that leave alone what stands at an end and would leave."""
    held = (np.abs(z) >= EDGE) & (descent * z > 0)
    diagonal = np.diagonal(normal, axis1=1, axis2=2)
    free = np.where(held[:, :, None] | held[:, None, :], 0.0, normal)
    own = np.arange(z.shape[1])
    free[:, own, own] = np.where(held, 1.0, diagonal * (1.0 + damping[:, None]))
    return np.linalg.solve(free, np.where(held, 0.0, descent)[:, :, None])[:, :, 0]
