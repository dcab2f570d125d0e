"""Hysteresis: what follows a driver through friction, and lags behind it in a loop."""

import numpy as np

from rga.arrays import FloatArray

#: widths of play that are tried, in standard deviations of the driver: from a joint that sticks a
#: little to one that hardly ever gives
PLAY = (0.2, 0.4, 0.7, 1.2, 1.9)


def play(driver: FloatArray, width: FloatArray) -> FloatArray:
    """What is pushed by a driver that has play: it stands until the driver has come so far.

    The play operator (M. Brokate and J. Sprekels, Hysteresis and Phase Transitions, 1996, 2.1).

    Args:
        driver: float[rows, columns].
        width: of the play to either side, float[columns], in the units of the driver.

    Returns:
        float[rows, columns].

    >>> play(np.array([[0.0], [3.0], [2.0], [0.0]]), np.array([1.0])).ravel()
    array([0., 2., 2., 1.])
    """
    pushed = driver.copy()
    for row in range(1, len(driver)):
        ahead, behind = driver[row] - width, driver[row] + width
        pushed[row] = np.minimum(np.maximum(pushed[row - 1], ahead), behind)
    return pushed


def loop(driver: FloatArray, width: FloatArray) -> FloatArray:
    """The part of the play that turns its sign where time runs backwards, float[rows, columns].

    Errors of a driver that come and go in its own row are in no such part.

    Args:
        driver, width: as for `play`.
    """
    return play(driver, width) - play(driver[::-1], width)[::-1]
