"""Poles of many realisations that are of one mode."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray

#: of the same mode: frequencies apart, and MAC
SAME, ALIKE = 0.02, 0.9
#: share of the realisations that must have a mode
OFTEN = 0.5


def alike_poles(
    frequency: FloatArray, shape: np.ndarray, run: IntArray, runs: int
) -> Iterator[BoolArray]:
    """Poles of each mode that enough realisations have, those that the most have first.

    Args:
        frequency: float[poles], in any unit.
        shape: of length one, complex[poles, sensors].
        run: number of the realisation of each, int[poles].
        runs: number of realisations.

    Yields:
        bool[poles].

    >>> frequency, shape = np.array([1.0, 1.01, 3.0]), np.ones((3, 1))
    >>> [own.tolist() for own in alike_poles(frequency, shape, np.array([0, 1, 1]), 3)]
    [[True, True, False]]
    """
    same = np.abs(np.log(frequency[:, None] / frequency)) < SAME
    same &= np.abs(shape.conj() @ shape.T) ** 2 > ALIKE
    of_run = (run[:, None] == np.arange(runs)).astype(float)
    left = np.ones(len(frequency), dtype=bool)
    while left.any():
        times = ((same[:, left] @ of_run[left] > 0).sum(1)) * left
        most = int(np.argmax(times))
        if times[most] < OFTEN * runs:
            return
        yield same[most] & left
        left &= ~same[most]
