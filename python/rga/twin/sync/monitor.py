"""The monitor over the residuals of the twin."""

import json
from collections.abc import Sequence

from rga.detection import SyncMonitor
from rga.detection.baseline.baseline_model import unwatched
from rga.twin.settings import Settings
from rga.twin.sync.protocol import OutOfSync, Residuals, listed

#: rows that say what is usual, at the most: two weeks of minutes
MOST_ROWS = 20_000


class Monitored:
    """Out of sync where residuals are no longer what they were when the twin was calibrated.

    What they were is learned from the rows since the model came into force, the latest where they
    are many, so that what a recalibration has dealt with is usual from then on. Until there are
    enough of them there is no alarm. Sensors with few readings are not watched.

    Args:
        channels: names of the sensors.
        settings: rows between false alarms.
    """

    def __init__(self, channels: Sequence[str], settings: Settings) -> None:
        self._channels, self._settings = tuple(channels), settings
        self._monitor: SyncMonitor | None = None
        #: rows that the baseline begins with, and that the monitor began with
        self._baseline = self._began = 0

    def alarm(self, first: int, end: int, residuals: Residuals) -> OutOfSync | None:
        """The first alarm that the latest rows raise.

        Args:
            first, end: of these rows.
            residuals: of rows so far.
        """
        if self._monitor is None:
            self._learn(end, residuals)
            return None
        self._monitor.update_many(residuals(first, end))
        alarm = self._monitor.alarm
        if alarm is None:
            return None
        sensors = tuple(self._channels[one] for one in alarm.sensors)
        since = self._began + alarm.since
        words = f"out of sync: {alarm.looks} in {listed(sensors)} since row {since}"
        return OutOfSync(self._began + alarm.row, since, sensors, words)

    def begin_again(self, first: int | None, end: int, residuals: Residuals) -> None:
        """Learn what residuals are now.

        Args:
            first: of the rows that say what is usual; None: still the same.
            end: rows so far.
            residuals: of these.
        """
        self._monitor = None
        if first is not None:
            self._baseline = first
        self._learn(end, residuals)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why alarms may come without a change."""
        return () if self._monitor is None else self._monitor.warnings

    def to_bytes(self) -> bytes:
        """The state."""
        head = {"baseline": self._baseline, "began": self._began}
        monitor = b"" if self._monitor is None else self._monitor.to_bytes()
        return json.dumps(head).encode() + b"\n" + monitor

    def restore(self, state: bytes) -> None:
        """Go on where another stood."""
        head, _, monitor = state.partition(b"\n")
        known = json.loads(head)
        self._baseline, self._began = known["baseline"], known["began"]
        self._monitor = SyncMonitor.from_bytes(monitor) if monitor else None

    def _learn(self, end: int, residuals: Residuals) -> None:
        baseline = residuals(max(self._baseline, end - MOST_ROWS), end)
        if len(unwatched(baseline)) < len(self._channels):
            self._monitor = SyncMonitor(baseline, arl0=self._settings.arl0, names=self._channels)
            self._began = end
