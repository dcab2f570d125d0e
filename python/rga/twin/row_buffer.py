"""The rows of a run in memory: measured, inferred and simulated."""

from collections.abc import Container, Sequence

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.twin.messages.hardware import Packet

#: rows for which there is room at first; it is doubled when it is full, so that a row costs the
#: same however many there are
ROOM = 64


class RowBuffer:
    """Rows so far; NaN where nothing was measured, inferred or simulated.

    Args:
        channels, measured, contexts: how many channels, measured contexts and contexts there are.

    Attributes:
        stuck: channels that stand still: they have no residuals, bool[channels].
    """

    def __init__(self, channels: int, measured: int, contexts: int) -> None:
        widths = {
            "time": 1,
            "readings": channels,
            "measured": measured,
            "told": measured,
            "contexts": contexts,
            "spread": contexts,
            "simulated": channels,
        }
        self._tables = {name: np.full((ROOM, width), np.nan) for name, width in widths.items()}
        self._rows = 0
        self.stuck: NDArray[np.bool_] = np.zeros(channels, dtype=np.bool_)

    def __len__(self) -> int:
        return self._rows

    @property
    def time(self) -> FloatArray:
        """Seconds since the first row, float[rows]."""
        return self._table("time")[:, 0]

    @property
    def readings(self) -> FloatArray:
        """float[rows, channels]."""
        return self._table("readings")

    @property
    def measured(self) -> FloatArray:
        """Measured contexts, float[rows, measured]."""
        return self._table("measured")

    @property
    def told(self) -> FloatArray:
        """Measured contexts with the last known value where one is missing, float[rows, measured].

        NaN before the first.
        """
        return self._table("told")

    @property
    def contexts(self) -> FloatArray:
        """All contexts, float[rows, contexts]."""
        return self._table("contexts")

    @property
    def spread(self) -> FloatArray:
        """Standard deviations of the contexts, float[rows, contexts]."""
        return self._table("spread")

    @property
    def simulated(self) -> FloatArray:
        """float[rows, channels]."""
        return self._table("simulated")

    def leave_out(self, channels: Sequence[str], stuck: Container[str]) -> None:
        """Look no more at channels that stand still.

        Args:
            channels: names of all.
            stuck: names of these.
        """
        self.stuck = np.array([name in stuck for name in channels], dtype=np.bool_)

    def append(self, packet: Packet) -> None:
        """Add the rows of a packet."""
        first, end = self._rows, self._rows + len(packet.time)
        room = len(self._tables["time"])
        if end > room:
            more = max(end, 2 * room) - room
            self._tables = {
                name: np.pad(table, ((0, more), (0, 0)), constant_values=np.nan)
                for name, table in self._tables.items()
            }
        before = self.told[-1:]
        self._rows = end
        self.time[first:] = packet.time
        self.readings[first:] = packet.readings
        self.measured[first:] = packet.contexts
        self.told[first:] = carried_on(before, packet.contexts)

    def residuals(self, first: int, end: int) -> FloatArray:
        """Measured minus simulated, float[end - first, channels]; NaN for stuck channels."""
        left = self.readings[first:end] - self.simulated[first:end]
        return np.where(self.stuck, np.nan, left)

    def gaps(self, first: int, end: int) -> FloatArray:
        """Squares of the residuals, float[end - first, channels]."""
        return np.asarray(self.residuals(first, end) ** 2)

    def _table(self, name: str) -> FloatArray:
        return self._tables[name][: self._rows]


def carried_on(before: FloatArray, values: FloatArray) -> FloatArray:
    """Values with the last known one where one is missing, of the shape of `values`.

    Args:
        before: what was known before them, float[0 or 1, columns].
        values: float[rows, columns], NaN where missing.
    """
    rows, columns = values.shape
    start = before if len(before) else np.full((1, columns), np.nan)
    table = np.concatenate([start, values])
    last = np.where(np.isfinite(values), np.arange(1, rows + 1)[:, None], 0)
    return np.take_along_axis(table, np.maximum.accumulate(last, axis=0), axis=0)
