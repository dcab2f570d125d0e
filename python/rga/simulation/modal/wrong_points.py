"""A mode known by its shape where a few of its points are wrong: turned, dead or exchanged."""

import numpy as np

from rga.arrays import FloatArray
from rga.simulation.modal.expected import SHAPE_ERROR, Expected
from rga.simulation.modal.mixed_shapes import unlike_mixed

#: points that may be wrong, and how many must measure for each of them
WRONG, FOR_EACH = 2, 5
#: cost of a wrong point, as a negative logarithm of a probability
A_WRONG_POINT = 3.0


def unlike_but_for_points(look: Expected, shape: FloatArray, parts: FloatArray) -> float:
    """1 - MAC of a measured and an expected shape but for points that are wrong.

    Those without which the two are most alike are left out, and what they cost is counted as if the
    shapes were so much less alike.

    Args:
        look: the expected mode.
        shape: measured at its points, float[points]; NaN where one did not.
        parts: of other modes that may be in it, float[k, points].

    >>> measured = np.array([1.0, 2.0, -3.0, 2.0, 1.0])
    >>> look = Expected(1.0, 0.1, np.arange(5), np.abs(measured))
    >>> round(unlike_but_for_points(look, measured, np.zeros((0, 5))), 2)
    0.15
    """
    seen = np.flatnonzero(np.isfinite(shape))
    least = unlike_mixed(shape, look.shape, parts)
    for count in range(1, min(WRONG, len(seen) // FOR_EACH) + 1):
        seen = np.delete(seen, _worst(look.shape[seen], shape[seen]))
        left = unlike_mixed(shape[seen], look.shape[seen], parts[:, seen])
        least = float(np.fmin(least, left + count * A_WRONG_POINT * SHAPE_ERROR))
    return least


def _worst(one: FloatArray, other: FloatArray) -> int:
    """The point without which two shapes are most alike."""
    along = float(one @ other) - one * other
    lengths = (float(one @ one) - one**2) * (float(other @ other) - other**2)
    return int(np.argmax(along**2 / np.maximum(lengths, 1e-300)))
