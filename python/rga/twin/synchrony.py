"""T1: is the twin in sync? The Gaussian window over the gaps of each sensor."""

import numpy as np
from numpy.typing import NDArray

from rga.detection import GaussianWindow
from rga.model.parameter import FloatArray
from rga.twin.settings import Settings


class Synchrony:
    """The paper's rule: out of sync where the squared gap of any sensor exceeds its bound.

    Args:
        channels: number of sensors.
        settings: width and persistence of the window.
    """

    def __init__(self, channels: int, settings: Settings) -> None:
        self._channels, self._settings = channels, settings
        self._window = self._fresh()

    def exceeded(self, gaps: FloatArray) -> NDArray[np.bool_]:
        """Sensors whose gap exceeds its bound, row by row; the window moves on.

        Args:
            gaps: float[n, channels], NaN where missing.

        Returns:
            bool[n, channels].
        """
        return self._window.update_many(gaps)

    def begin_again(self, gaps: FloatArray) -> None:
        """Fill a new window with gaps of a newly calibrated twin, float[n, channels]."""
        self._window = self._fresh()
        self._window.update_many(gaps)

    def to_bytes(self) -> bytes:
        """The state of the window."""
        return self._window.to_bytes()

    def restore(self, state: bytes) -> None:
        """Go on where a window stood."""
        self._window = GaussianWindow.from_bytes(state)

    def _fresh(self) -> GaussianWindow:
        settings = self._settings
        return GaussianWindow(
            self._channels, settings.window, settings.z, persistence=settings.persistence
        )


def noise_of(stated: list[float | None], readings: FloatArray) -> FloatArray:
    """Standard deviation of each channel's noise: as stated, else from steps between rows.

    Half the variance of first differences is the variance of white noise on a slow signal
    (von Neumann, 1941); their median makes it robust. A channel that mostly repeats itself has no
    noise to be measured by: NaN.

    Args:
        stated: by the model, one a channel.
        readings: float[rows, channels], NaN where missing.
    """
    steps = np.abs(np.diff(readings, axis=0))
    found = np.full(len(stated), np.nan)
    for column, known in enumerate(stated):
        own = steps[np.isfinite(steps[:, column]), column]
        rough = 1.4826 * float(np.median(own)) / np.sqrt(2) if len(own) else 0.0
        if known or rough:
            found[column] = known or rough
    return found
