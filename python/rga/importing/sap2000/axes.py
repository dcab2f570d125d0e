"""Local axes of frames as SAP2000 takes them: CSI Analysis Reference Manual, "Local Coordinate
System" of the frame element."""

import numpy as np

from rga.arrays import FloatArray

#: sine of the angle to Z below which a frame is upright
UPRIGHT = 1e-3


def local_y(along: FloatArray, angle: float) -> FloatArray:
    """Local axis 2, which is y in rga: up for frames that are not upright, else along X.

    Args:
        along: from joint I to joint J, float[3].
        angle: by which axes 2 and 3 are turned about axis 1 [degrees].
    """
    x = along / np.linalg.norm(along)
    upright = np.hypot(x[0], x[1]) < UPRIGHT
    reference = np.array([1.0, 0.0, 0.0] if upright else [0.0, 0.0, 1.0])
    second = reference - (reference @ x) * x
    second /= np.linalg.norm(second)
    turn = np.radians(angle)
    return np.asarray(np.cos(turn) * second + np.sin(turn) * np.cross(x, second))
