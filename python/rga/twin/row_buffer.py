"""The rows of a run in memory: measured, inferred and simulated."""

from collections.abc import Container, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.twin.messages.hardware import Packet


@dataclass
class RowBuffer:
    """Rows so far; NaN where nothing was measured, inferred or simulated.

    Attributes:
        time: float[rows], seconds since the first row.
        readings: float[rows, channels].
        measured: measured contexts, float[rows, measured].
        contexts, spread: all contexts and their standard deviations, float[rows, contexts].
        simulated: float[rows, channels].
        stuck: channels that stand still: they have no residuals, bool[channels].
    """

    time: FloatArray
    readings: FloatArray
    measured: FloatArray
    contexts: FloatArray
    spread: FloatArray
    simulated: FloatArray
    stuck: NDArray[np.bool_]

    @classmethod
    def empty(cls, channels: int, measured: int, contexts: int) -> "RowBuffer":
        """A ledger without rows."""

        def none(width: int) -> FloatArray:
            return np.zeros((0, width))

        return cls(
            np.zeros(0),
            none(channels),
            none(measured),
            none(contexts),
            none(contexts),
            none(channels),
            np.zeros(channels, dtype=np.bool_),
        )

    def __len__(self) -> int:
        return len(self.time)

    def leave_out(self, channels: Sequence[str], stuck: Container[str]) -> None:
        """Look no more at channels that stand still.

        Args:
            channels: names of all.
            stuck: names of these.
        """
        self.stuck = np.array([name in stuck for name in channels], dtype=np.bool_)

    def append(self, packet: Packet) -> None:
        """Add the rows of a packet."""
        rows = len(packet.time)
        self.time = np.concatenate([self.time, packet.time])
        self.readings = np.concatenate([self.readings, packet.readings])
        self.measured = np.concatenate([self.measured, packet.contexts])
        for name in ("contexts", "spread", "simulated"):
            table = getattr(self, name)
            setattr(self, name, np.concatenate([table, np.full((rows, table.shape[1]), np.nan)]))

    @property
    def residuals(self) -> FloatArray:
        """Measured minus simulated, float[rows, channels]; NaN for channels that are stuck."""
        return np.where(self.stuck, np.nan, self.readings - self.simulated)

    @property
    def gaps(self) -> FloatArray:
        """Squares of the residuals, float[rows, channels]."""
        return np.asarray(self.residuals**2)

    def last_measured(self, middle: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Measured contexts with the last known value where one is missing, and complete rows.

        Args:
            middle: taken before the first known value, float[measured].
        """
        known = np.isfinite(self.measured)
        start = np.concatenate([middle[None], np.nan_to_num(self.measured)])
        last = np.where(known, np.arange(1, len(known) + 1)[:, None], 0)
        last = np.maximum.accumulate(last, axis=0)
        return np.take_along_axis(start, last, axis=0), np.asarray(known.all(axis=1))
