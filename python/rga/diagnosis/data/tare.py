"""The tare: the rows whose mean was taken off the channels, of each its own."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.model.effect import Values
from rga.records import Record
from rga.records.zero import Interval, rows_within

#: rows that stand for all of a zero interval; where it has more, each is the mean of several
MOST_ROWS = 32


@dataclass(frozen=True)
class Tare:
    """Rows whose mean was taken off channels; none where nothing was taken off.

    Attributes:
        contexts: `time` [s] included, float[zero rows] each.
        shares: of each row in the mean of each sensor of the model, float[zero rows, sensors]; 0
            where nothing was taken off a sensor.
        counts: readings that the mean of each sensor was taken over, int[sensors].
        rows: of the record, that these stand for.
    """

    contexts: Values
    shares: FloatArray
    counts: IntArray
    rows: int

    @classmethod
    def of(
        cls, record: Record, contexts: Values, columns: IntArray, zeros: Sequence[Interval | None]
    ) -> "Tare":
        """The tare of a record.

        Args:
            record: of all rows.
            contexts: of its rows, `time` included, float[rows] each.
            columns: of its channels among the sensors of the model.
            zeros: of each sensor of the model, the interval whose mean was taken off it [s since
                the first row]; None where nothing was.
        """
        taken = np.zeros((len(record), len(zeros)), dtype=bool)
        for column, zero in enumerate(zeros):
            taken[rows_within(record.time, zero), column] = True
        rows = np.flatnonzero(taken.any(1))
        parts = [part for part in np.array_split(rows, MOST_ROWS) if len(part)]
        read = taken.copy()
        read[:, columns] &= np.isfinite(record.readings)
        # A channel without a reading there was zeroed all the same.
        read = np.where(read.any(0), read, taken)
        counts = read.sum(0)
        of_parts = np.array([read[part].sum(0) for part in parts]).reshape(-1, len(zeros))
        middle = {
            name: np.array([column[part].mean() for part in parts])
            for name, column in contexts.items()
        }
        return cls(middle, of_parts / np.maximum(counts, 1), counts, len(rows))

    def __len__(self) -> int:
        return len(self.shares)

    @property
    def time(self) -> FloatArray:
        """Clock of the zero rows [s], float[zero rows]."""
        return self.contexts["time"]

    def mean(self, values: FloatArray, columns: IntArray) -> FloatArray:
        """What is taken off channels, float[channels].

        Args:
            values: in the zero rows, float[zero rows, channels].
            columns: of the channels among the sensors of the model.
        """
        return np.asarray((self.shares[:, columns] * values).sum(0))

    def mean_weight(self, weights: FloatArray) -> FloatArray:
        """Mean share over the zero rows, of late effects, float[...].

        Args:
            weights: shares of the effects that act in the zero rows, float[..., zero rows].
        """
        tared = max(int((self.counts > 0).sum()), 1)
        return np.asarray(weights @ self.shares.sum(1) / tared)
