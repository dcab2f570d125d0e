"""The rows that a repository holds already, for what is asked of a run beside its rows."""

import numpy as np

from rga.twin.hardware.interface import HardwareInterface, Packet
from rga.twin.repository import RunView
from rga.twin.restore import station_of
from rga.twin.settings import Settings


class Stored:
    """Rows that were taken in; no others are at hand.

    Args:
        view: the run that took them in.

    Raises:
        InputError: the run was interrupted before its first step ended.
    """

    def __init__(self, view: RunView) -> None:
        self.source, self.station = view.identity.source, station_of(view)
        self._view = view

    @property
    def rows(self) -> int:
        """Rows that were taken in."""
        return self._view.rows

    @property
    def ended(self) -> bool:
        """No others will come."""
        return True

    def packet(self, first: int, rows: int) -> Packet:
        """At most so many rows from a row on."""
        seen = self._view.measured(first, first + rows)
        count = len(seen.rows)
        return Packet(
            first,
            seen.time,
            seen.readings.reshape(count, len(self.station.channels)),
            np.reshape(seen.contexts, (count, len(self.station.measured))),
        )

    def taken(self, rows: int) -> None:
        """The repository keeps them."""


def length_of(hardware: HardwareInterface, settings: Settings) -> int | None:
    """Rows of the record that a run is of; None: it does not end."""
    if not hardware.ended:
        return None
    if isinstance(hardware, Stored):
        # More rows may have been meant to come than were taken in.
        return max(hardware.rows, settings.calibration_rows or 1)
    return hardware.rows
