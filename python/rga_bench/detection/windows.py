"""The paper's rule as other packages compute it: what the window of rga is measured beside."""

from math import sqrt
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga_bench.installed import NotInstalledError


class Bottleneck:
    """`move_mean` and `move_std` over all rows.

    Args:
        window: values before the one that is tested.
        z: bound in standard deviations.
    """

    #: rows of a call that suit it
    rows = 2000

    def __init__(self, window: int, z: float) -> None:
        """Takes nothing yet.

        Raises:
            NotInstalledError: bottleneck is not there.
        """
        try:
            import bottleneck
        except ImportError:
            raise NotInstalledError("bottleneck") from None
        self._window, self._z = window, z
        self._mean, self._std = bottleneck.move_mean, bottleneck.move_std

    def alarms(self, rows: FloatArray) -> NDArray[np.bool_]:
        """Of the rows behind the first window, bool[n - window, sensors].

        Args:
            rows: float[n, sensors]; read fastest with columns in one piece (Fortran's order).
        """
        window = self._window
        mean = self._mean(rows, window, axis=0)[window - 1 : -1]
        std = self._std(rows, window, axis=0)[window - 1 : -1]
        return np.asarray(rows[window:] > mean + self._z * std)


class River:
    """A windowed `GaussianScorer` a sensor; its score is two-sided, its variance that of samples.

    Args:
        window: values before the one that is tested.
        z: bound in standard deviations.
    """

    def __init__(self, window: int, z: float) -> None:
        """Takes nothing yet.

        Raises:
            NotInstalledError: river is not there.
        """
        try:
            from river.anomaly import GaussianScorer
        except ImportError:
            raise NotInstalledError("river") from None
        self._window = window
        self._scorer = GaussianScorer
        self._limit = 2.0 * NormalDist().cdf(z * sqrt((window - 1) / window)) - 1.0

    def alarms(self, rows: FloatArray) -> NDArray[np.bool_]:
        """Of the rows behind the first window, bool[n - window, sensors]."""
        window, limit = self._window, self._limit
        scorers = [self._scorer(window_size=window, grace_period=window) for _ in rows[0]]
        found = np.zeros(rows.shape, bool)
        for row, values in enumerate(rows.tolist()):
            for sensor, (scorer, value) in enumerate(zip(scorers, values, strict=True)):
                if scorer.score_one(None, value) > limit:
                    found[row, sensor] = value > scorer.gaussian.mu
                scorer.learn_one(None, value)
        return found[window:]
