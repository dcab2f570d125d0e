"""T1: is the twin in sync? The Gaussian window over the gaps of each sensor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.detection import GaussianWindow
from rga.model.parameter import FloatArray
from rga.twin.settings import Settings

SHOWN = 4


@dataclass(frozen=True)
class Alarm:
    """The twin is out of sync.

    Attributes:
        row: at which it was found.
        since: first row that it is about.
        sensors: that show it.
        words: what was found.
    """

    row: int
    since: int
    sensors: tuple[str, ...]
    words: str


class Synchrony:
    """The paper's rule: out of sync where the squared gap of any sensor exceeds its bound.

    Args:
        channels: names of the sensors.
        settings: width and persistence of the window.
    """

    def __init__(self, channels: Sequence[str], settings: Settings) -> None:
        self._channels, self._settings = channels, settings
        self._window = self._fresh()

    def alarm(self, first: int, residuals: FloatArray) -> Alarm | None:
        """The first alarm that rows raise; the window moves on over all of them.

        Args:
            first: number of the first row.
            residuals: measured minus simulated, float[n, channels], NaN where missing.
        """
        exceeded = self._window.update_many(residuals**2)
        rows = np.flatnonzero(exceeded.any(axis=1))
        if not len(rows):
            return None
        row = first + int(rows[0])
        sensors = tuple(np.array(self._channels)[exceeded[rows[0]]].tolist())
        more = f" and {len(sensors) - SHOWN} more" if len(sensors) > SHOWN else ""
        words = f"out of sync: the gap of {', '.join(sensors[:SHOWN])}{more} exceeds its bound"
        return Alarm(row, max(0, row - self._settings.persistence[1] + 1), sensors, words)

    def begin_again(self, residuals: FloatArray) -> None:
        """Fill a new window with the latest rows of a newly calibrated twin.

        Args:
            residuals: of all rows so far, float[rows, channels], NaN where missing.
        """
        self._window = self._fresh()
        self._window.update_many(residuals[-2 * self._settings.window :] ** 2)

    def to_bytes(self) -> bytes:
        """The state of the window."""
        return self._window.to_bytes()

    def restore(self, state: bytes) -> None:
        """Go on where a window stood."""
        self._window = GaussianWindow.from_bytes(state)

    def _fresh(self) -> GaussianWindow:
        settings = self._settings
        return GaussianWindow(
            len(self._channels), settings.window, settings.z, persistence=settings.persistence
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
