"""Readings of correlated sensors, of which some are missing, as independent unit noise."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray


class Whitening:
    """Inverse Cholesky factors of the covariance of the sensors that each row has.

    A missing sensor is left out of the row: its row and column of the factor are zero.

    Args:
        covariance: of the sensors, float[sensors, sensors], positive definite.
        observed: bool[n, sensors].

    >>> whitening = Whitening(np.diag([4.0, 9.0]), np.array([[True, True], [True, False]]))
    >>> whitening(np.full((2, 2, 1), 6.0), np.arange(2))[:, :, 0]
    array([[3., 2.],
           [3., 0.]])
    """

    def __init__(self, covariance: FloatArray, observed: NDArray[np.bool_]) -> None:
        patterns, of_row = np.unique(observed, axis=0, return_inverse=True)
        self._of_row = of_row.ravel()
        self._roots = np.zeros((len(patterns), *covariance.shape))
        for root, seen in zip(self._roots, patterns, strict=True):
            own = np.ix_(seen, seen)
            root[own] = np.linalg.inv(np.linalg.cholesky(covariance[own]))

    def __call__(self, values: FloatArray, rows: NDArray[np.int64]) -> FloatArray:
        """Whitened values, float[k, sensors, columns], of the k rows named."""
        out = np.empty(values.shape)
        for chosen, root in self.parts(rows):
            out[chosen] = root @ values[chosen]
        return out

    def parts(self, rows: NDArray[np.int64]) -> list[tuple[NDArray[np.int64], FloatArray]]:
        """Of rows: which (by their place in `rows`) share a factor, and the factor."""
        of_row = self._of_row[rows]
        return [(np.flatnonzero(of_row == k), self._roots[k]) for k in np.unique(of_row)]
