"""Derivatives along directions, as the core takes them: those entries alone that change."""

import numpy as np

from rga.arrays import FloatArray, IntArray


def along(rates: FloatArray) -> tuple[IntArray, FloatArray]:
    """Entries that change in some row.

    Args:
        rates: float[rows, entries, directions].

    Returns:
        pairs of a direction and an entry, int[changes, 2], and their rates, float[rows, changes].
    """
    pairs = np.argwhere(rates.any(axis=0).T)
    return pairs, rates[:, pairs[:, 1], pairs[:, 0]]
