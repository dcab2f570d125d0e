"""Damped Newton steps that end inside a box."""

import numpy as np

from rga.arrays import FloatArray

#: rounds in which coordinates are set to the side that they would pass
_ROUNDS = 4


def bounded_step(
    normal: FloatArray, descent: FloatArray, here: FloatArray, damping: FloatArray, bound: float
) -> FloatArray:
    """Steps s that make s' N s / 2 - d' s small while `here` + s stays within +-`bound`.

    What a step would carry out of the box is set to its side, and the others are solved for again
    (an active set, Bertsekas, SIAM J. Control Optim. 20, 1982).

    Args:
        normal: N, float[problems, parameters, parameters], positive definite.
        descent: d, float[problems, parameters].
        here: float[problems, parameters] within the box.
        damping: what the diagonal of N grows by, as a share of it, float[problems].
        bound: half the width of the box; may be infinite.

    >>> normal, descent = np.array([[[2.0, 1.0], [1.0, 2.0]]]), np.array([[8.0, 4.0]])
    >>> bounded_step(normal, descent, np.zeros((1, 2)), np.zeros(1), bound=1.5).round(3)
    array([[1.5 , 1.25]])
    """
    own = np.arange(here.shape[1])
    damped = normal.copy()
    damped[:, own, own] *= 1.0 + damping[:, None]
    held, step = np.zeros(here.shape, dtype=bool), np.zeros(here.shape)
    for _ in range(_ROUNDS):
        free = np.where(held[:, :, None] | held[:, None, :], 0.0, damped)
        free[:, own, own] += held
        pull = descent - (damped @ np.where(held, step, 0.0)[:, :, None])[:, :, 0]
        step = np.linalg.solve(free, np.where(held, step, pull)[:, :, None])[:, :, 0]
        passing = (np.abs(here + step) > bound) & ~held
        step = np.clip(here + step, -bound, bound) - here
        held |= passing
        if not passing.any():
            break
    return step
