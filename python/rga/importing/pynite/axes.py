"""Local axes of members as PyNite takes them: y points up, and z is level."""

from math import isclose

import numpy as np

from rga.arrays import FloatArray


def local_axes(start: FloatArray, end: FloatArray, rotation: float) -> FloatArray:
    """Local axes as rows in PyNite's axes, float[3, 3].

    Args:
        start: first end, float[3].
        end: second end, float[3].
        rotation: by which y and z are turned about x [degrees].

    >>> local_axes(np.zeros(3), np.array([0.0, 3.0, 0.0]), 0.0)[1].tolist()
    [-1.0, 0.0, 0.0]
    """
    along = end - start
    x = along / np.linalg.norm(along)
    if isclose(start[0], end[0]) and isclose(start[2], end[2]):
        # An upright member keeps y in the plane of x and y, which makes plane frames easy.
        z = np.array([0.0, 0.0, 1.0])
    else:
        z = np.cross(x, [0.0, 1.0, 0.0])
        z /= np.linalg.norm(z)
    y = np.cross(z, x)
    turn = np.radians(rotation)
    y = np.cos(turn) * y + np.sin(turn) * np.cross(x, y)
    return np.stack([x, y, np.cross(x, y)])
