"""The paper's rule: a Gaussian window over the squared gaps of each sensor."""

from collections.abc import Sequence

import numpy as np

from rga.detection import GaussianWindow
from rga.twin.settings import Settings
from rga.twin.sync.protocol import OutOfSync, Residuals, listed


class WindowRule:
    """Out of sync where the squared gap of any sensor exceeds its bound.

    Args:
        channels: names of the sensors.
        settings: width and persistence of the window.
    """

    #: of its alarms the rule promises nothing
    warnings: tuple[str, ...] = ()

    def __init__(self, channels: Sequence[str], settings: Settings) -> None:
        self._channels, self._settings = channels, settings
        self._window = self._fresh()

    def alarm(self, first: int, end: int, residuals: Residuals) -> OutOfSync | None:
        """The first alarm that the latest rows raise; the window moves on over all of them.

        Args:
            first, end: of these rows.
            residuals: of rows so far.
        """
        exceeded = self._window.update_many(residuals(first, end) ** 2)
        rows = np.flatnonzero(exceeded.any(axis=1))
        if not len(rows):
            return None
        row = first + int(rows[0])
        sensors = tuple(np.array(self._channels)[exceeded[rows[0]]].tolist())
        words = f"out of sync: the gap of {listed(sensors)} exceeds its bound"
        return OutOfSync(row, max(0, row - self._settings.persistence[1] + 1), sensors, words)

    def begin_again(self, first: int | None, end: int, residuals: Residuals) -> None:
        """Fill a new window with the latest rows.

        Args:
            first: of the rows that say what is usual; None: still the same.
            end: rows so far.
            residuals: of these.
        """
        self._window = self._fresh()
        self._window.update_many(residuals(max(0, end - 2 * self._settings.window), end) ** 2)

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
