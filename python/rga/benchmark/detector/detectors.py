"""The detectors that are measured."""

from functools import partial

import numpy as np
from scipy.signal import lfilter

from rga.benchmark.detector.charts import Chart, Method
from rga.detection import GaussianWindow
from rga.model.parameter import FloatArray

#: of the paper's rule
WINDOW = 100
Z = 3.0
#: weight of a row in the average of `Mewma`
WEIGHT = 0.1


class WindowRule:
    """The paper's rule as a chart: alarms where it exceeds z.

    The value is the largest, over sensors, of (squared gap - mean) / standard deviation of the
    sensor's last squared gaps.

    Args:
        window: how many of them.
        center: what residuals differ from to make gaps, float[sensors].
    """

    def __init__(self, window: int, center: FloatArray) -> None:
        self._window, self._center = window, center
        self._held = np.zeros((0, len(center)))

    def values(self, rows: FloatArray) -> FloatArray:
        """Of each row, float[n]; below any limit until the window is full."""
        gaps = np.concatenate([self._held, (rows - self._center) ** 2])
        self._held = gaps[-self._window :]
        filling = max(len(rows) - max(len(gaps) - self._window, 0), 0)
        found = np.full(len(rows), -np.inf)
        if filling < len(rows):
            sums, squares = (_windows(part, self._window) for part in (gaps, gaps**2))
            mean = sums / self._window
            spread = np.sqrt(squares / self._window - mean**2)
            found[filling:] = ((gaps[self._window :] - mean) / spread).max(axis=1)
        return found


class Mewma:
    """Hotelling's T^2 of an exponentially weighted average (Lowry et al., Technometrics 34, 1992).

    Args:
        weight: of a row.
        center: mean of a row, float[sensors].
        whitening: makes its covariance the identity, float[sensors, sensors].
    """

    def __init__(self, weight: float, center: FloatArray, whitening: FloatArray) -> None:
        self._weight, self._center, self._whitening = weight, center, whitening
        self._state = np.zeros((1, len(center)))
        self._rows = 0

    def values(self, rows: FloatArray) -> FloatArray:
        """T^2 after each row, float[n]."""
        fresh = (rows - self._center) @ self._whitening.T
        kept = 1.0 - self._weight
        average, self._state = lfilter([self._weight], [1.0, -kept], fresh, axis=0, zi=self._state)
        ages = self._rows + 1.0 + np.arange(len(rows))
        self._rows += len(rows)
        variance = self._weight / (2.0 - self._weight) * (1.0 - kept ** (2.0 * ages))
        return np.asarray((average**2).sum(axis=1) / variance)


def window_rule(sensors: int, window: int, baseline: FloatArray | None, seed: int) -> Chart:
    """Of that many sensors; a baseline gives the mean and fills the window."""
    if baseline is None:
        return WindowRule(window, np.zeros(sensors))
    chart = WindowRule(window, baseline.mean(axis=0))
    chart.values(baseline)
    return chart


def mewma(sensors: int, weight: float, baseline: FloatArray | None, seed: int) -> Chart:
    """Of that many sensors, with mean and covariance of the baseline."""
    if baseline is None:
        return Mewma(weight, np.zeros(sensors), np.eye(sensors))
    factor = np.linalg.cholesky(np.cov(baseline, rowvar=False))
    return Mewma(weight, baseline.mean(axis=0), np.linalg.inv(factor))


def _windows(values: FloatArray, window: int) -> FloatArray:
    """Sums of each `window` values in turn, but the last."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return np.asarray(sums[window:-1] - sums[: -window - 1])
