"""Damped Newton steps that end inside a box."""

import numpy as np

from rga.arrays import FloatArray

#: rounds in which coordinates are set to the side that they would pass, or let go
_ROUNDS = 8


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
    # Coordinates held at a side: 1 the upper, -1 the lower, 0 free.
    held, step = np.zeros(here.shape), np.zeros(here.shape)
    for _ in range(_ROUNDS):
        fixed = held != 0.0
        free = np.where(fixed[:, :, None] | fixed[:, None, :], 0.0, damped)
        free[:, own, own] += fixed
        pull = descent - (damped @ np.where(fixed, step, 0.0)[:, :, None])[:, :, 0]
        step = np.linalg.solve(free, np.where(fixed, step, pull)[:, :, None])[:, :, 0]
        passing = (np.abs(here + step) > bound) & ~fixed
        held = np.where(passing, np.sign(step), held)
        step = np.clip(here + step, -bound, bound) - here
        # What its side no longer stops is let go, once nothing passes any more.
        inward = (descent - (damped @ step[:, :, None])[:, :, 0]) * held < 0.0
        released = inward & ~passing.any(axis=1, keepdims=True)
        held[released] = 0.0
        if not (passing.any() or released.any()):
            break
    return step
