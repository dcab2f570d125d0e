"""Decompositions of matrices that always come to an end."""

import numpy as np
from scipy.linalg import svd

from rga.arrays import FloatArray


def thin_svd(matrix: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Singular value decomposition U S V' of a finite matrix.

    Args:
        matrix: float[n, m].

    Returns:
        U, float[n, k]; singular values, falling, float[k]; V', float[k, m]; k = min(n, m).

    >>> thin_svd(np.diag([1.0, 3.0]))[1]
    array([3., 1.])
    """
    try:
        u, size, across = np.linalg.svd(matrix, full_matrices=False)
    except np.linalg.LinAlgError:
        # Divide and conquer gives up on rare finite matrices, which plain QR iterations solve.
        u, size, across = svd(matrix, full_matrices=False, lapack_driver="gesvd")
    return u, size, across
