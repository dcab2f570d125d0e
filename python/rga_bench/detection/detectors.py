"""The detectors that are measured."""

from functools import partial

import numpy as np
from scipy.signal import lfilter

from rga.arrays import FloatArray
from rga.detection import SyncMonitor
from rga_bench.detection.charts import Chart, Method, detecting

WINDOW_RULE, MEWMA, MONITOR = "window rule", "MEWMA", "monitor"
#: rows of the window, and the bound of the paper [sd]
WINDOW, Z = 100, 3.0
#: of a row in the average of `Mewma`
WEIGHT = 0.05
#: relative, of a standard deviation that comes from running sums
ROUNDING = 1e-6


def free(sensors: int) -> tuple[Method, ...]:
    """Detectors whose limit is set here, for so many rows between false alarms in white noise."""
    return (
        Method(WINDOW_RULE, partial(window_rule, sensors), np.inf, WINDOW),
        Method(MEWMA, partial(mewma, sensors), np.inf),
    )


def ready(sensors: int, arl0: float) -> tuple[Method, ...]:
    """Detectors that set their limit themselves, for that many rows between false alarms."""
    return (detecting(MONITOR, partial(monitor, sensors, arl0)),)


def monitor(sensors: int, arl0: float, baseline: FloatArray | None, seed: int) -> SyncMonitor:
    """Of that many sensors; the seed of its thresholds is its own."""
    if baseline is None:
        return SyncMonitor.known(sensors, arl0=arl0)
    return SyncMonitor(baseline, arl0=arl0)


def window_rule(sensors: int, baseline: FloatArray | None, seed: int) -> Chart:
    """Of that many sensors; a baseline gives the mean and fills the window."""
    if baseline is None:
        return WindowChart(WINDOW, np.zeros(sensors))
    chart = WindowChart(WINDOW, baseline.mean(axis=0))
    chart.values(baseline)
    return chart


def mewma(sensors: int, baseline: FloatArray | None, seed: int) -> Chart:
    """Of that many sensors, with mean and covariance of the baseline."""
    if baseline is None:
        return Mewma(WEIGHT, np.zeros(sensors), np.eye(sensors))
    factor = np.linalg.cholesky(np.cov(baseline, rowvar=False))
    return Mewma(WEIGHT, baseline.mean(axis=0), np.linalg.inv(factor))


class WindowChart:
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
            # A sensor that is stuck has no spread but that of rounding.
            spread = np.sqrt(np.maximum(squares / self._window - mean**2, (ROUNDING * mean) ** 2))
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


def _windows(values: FloatArray, window: int) -> FloatArray:
    """Sums of each `window` values in turn, but the last."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return np.asarray(sums[window:-1] - sums[: -window - 1])
