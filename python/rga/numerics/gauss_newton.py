"""Many small nonlinear least-squares problems at once, by damped Gauss-Newton steps in a box."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.numerics.bounded_step import bounded_step

#: damping at first, what it falls to at most after a step, as a share, and where a problem rests
_DAMPING, _FALL, _STUCK = 1e-2, 0.2, 1e8

#: parameters, float[k, parameters], of problems, int[k] -> float[k, residuals, ...]
OfProblems = Callable[[FloatArray, IntArray], FloatArray]


@dataclass(frozen=True)
class Minimum:
    """Where the problems end.

    Attributes:
        z: parameters, float[problems, parameters].
        misfit: |r|^2 + |z|^2 there, float[problems].
        normal: J'J + 1 there, float[problems, parameters, parameters].
    """

    z: FloatArray
    misfit: FloatArray
    normal: FloatArray


def minimise(
    residual: OfProblems,
    slope: OfProblems,
    start: FloatArray,
    bound: float,
    steps: int,
    gain: float,
) -> Minimum:
    """Parameters z that make |r(z)|^2 + |z|^2 small within +-`bound`, for each problem.

    Each problem has a damping of its own, Nielsen's (Madsen, Nielsen and Tingleff, Methods for
    non-linear least squares problems, 2004). The second term is a normal prior of unit variance.

    Args:
        residual: r, float[k, residuals].
        slope: J, its derivatives by z, float[k, residuals, parameters].
        start: float[problems, parameters]; what lies outside the box is taken to its side.
        bound: half the width of the box; may be infinite.
        steps: at most; 0 gives what holds at the start.
        gain: fall of the misfit that a step must promise to be worth another.

    >>> goal = np.array([[1.0], [4.0]])  # (z^2 - goal)^2, weighed 100 times the prior
    >>> found = minimise(
    ...     lambda z, of: 10.0 * (z**2 - goal[of]),
    ...     lambda z, of: 20.0 * z[:, :, None],
    ...     np.array([[3.0], [3.0]]), bound=1.5, steps=20, gain=1e-12,
    ... )
    >>> found.z.round(3)
    array([[0.997],
           [1.5  ]])
    """
    problems = np.arange(len(start))
    size = start.shape[1]
    z = np.clip(start, -bound, bound)
    off = residual(z, problems)
    misfit = _height(off, z)
    damping, rise = np.full(len(z), _DAMPING), np.full(len(z), 2.0)
    normal, descent = np.empty((len(z), size, size)), np.empty((len(z), size))

    def linearise(of: IntArray) -> None:
        if not len(of):
            return
        columns = slope(z[of], of)
        turned = columns.transpose(0, 2, 1)
        normal[of] = turned @ columns + np.eye(size)
        descent[of] = -(turned @ off[of, :, None])[:, :, 0] - z[of]

    left, moved = problems, problems
    for _ in range(steps):
        linearise(moved)
        step = bounded_step(normal[left], descent[left], z[left], damping[left], bound)
        curved = (normal[left] @ step[:, :, None])[:, :, 0]
        promised = ((2.0 * descent[left] - curved) * step).sum(axis=1)
        off_there = residual(z[left] + step, left)
        gained = misfit[left] - _height(off_there, z[left] + step)
        good = gained >= 0.0
        moved = left[good]
        z[moved] += step[good]
        off[moved], misfit[moved] = off_there[good], misfit[moved] - gained[good]
        share = gained / np.maximum(promised, gain)
        falls = np.maximum(_FALL, 1.0 - (2.0 * share - 1.0) ** 3)
        damping[left] *= np.where(good, falls, rise[left])
        rise[left] = np.where(good, 2.0, 2.0 * rise[left])
        left = left[(promised > gain) & (damping[left] < _STUCK)]
        moved = np.intersect1d(moved, left)
        if not len(left):
            break
    linearise(problems)
    return Minimum(z, misfit, normal)


def _height(off: FloatArray, z: FloatArray) -> FloatArray:
    return np.asarray((off**2).sum(axis=1) + (z**2).sum(axis=1))
