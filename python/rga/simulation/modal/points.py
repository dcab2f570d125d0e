"""Motion of mode shapes at the points where it is measured."""

import numpy as np

from rga.arrays import FloatArray

#: share of the largest motion of any mode below which one that does not move a point moves it by
#: rounding, and by what is left open of its shape
STILL = 1e-5


def motion_at(shapes: FloatArray, axes: FloatArray) -> FloatArray:
    """Motion at points along their axes; none where a mode leaves a point still.

    What rounding leaves there has a direction too, and would look like any other mode.

    Args:
        shapes: motion of the nodes of the points, for the same modal mass of all modes,
            float[..., modes, points, 3].
        axes: of the points, of length one, float[points, 3].

    Returns:
        float[..., modes, points].

    >>> across, up = [[0.0, 1.0, 1e-12]], [[0.0, 1e-12, 2.0]]
    >>> motion_at(np.array([across, up]), np.array([[0.0, 0.0, 1.0]])).tolist()
    [[0.0], [2.0]]
    """
    motion = np.einsum("...pk,pk->...p", shapes, axes)
    size = np.abs(motion)
    largest = size.max(axis=(-2, -1), initial=0.0, keepdims=True)
    return np.where(size > STILL * largest, motion, 0.0)
