"""The tare: the rows whose mean was taken off every channel."""

from dataclasses import dataclass

import numpy as np

from rga.model.effect import Values
from rga.model.parameter import FloatArray
from rga.model.structure import IntArray
from rga.records import Record

#: rows that stand for all of a zero interval; where it has more, each is the mean of several
MOST_ROWS = 32


@dataclass(frozen=True)
class Tare:
    """Rows whose mean was taken off every channel; none where nothing was taken off.

    Attributes:
        contexts: `time` [s] included, float[zero rows] each.
        shares: of each row in the mean of each sensor of the model, float[zero rows, sensors].
        counts: readings that the mean of each sensor was taken over, float[sensors].
        rows: of the record, that these stand for.
    """

    contexts: Values
    shares: FloatArray
    counts: FloatArray
    rows: int

    @classmethod
    def of(cls, record: Record, contexts: Values, columns: list[int], sensors: int) -> "Tare":
        """The tare of a record.

        Args:
            record: of all rows.
            contexts: of its rows, `time` included, float[rows] each.
            columns: of its channels among the sensors of the model.
            sensors: of the model.
        """
        rows = record.rows_of_zero()
        parts = [part for part in np.array_split(rows, MOST_ROWS) if len(part)]
        seen = np.isfinite(record.readings)
        found = np.array([seen[part].sum(0) for part in parts]).reshape(-1, len(columns))
        # A channel without a reading there was zeroed all the same.
        found = np.where(found.any(0), found, 1.0)
        counts, shares = np.ones(sensors), np.full((len(parts), sensors), 1 / max(len(parts), 1))
        counts[columns] = found.sum(0)
        shares[:, columns] = found / np.maximum(found.sum(0), 1.0)
        of_parts = {
            name: np.array([column[part].mean() for part in parts])
            for name, column in contexts.items()
        }
        return cls(of_parts, shares, counts, len(rows))

    def __len__(self) -> int:
        return len(self.shares)

    @property
    def time(self) -> FloatArray:
        """Clock of the zero rows [s], float[zero rows]."""
        return self.contexts["time"]

    def mean(self, values: FloatArray, columns: list[int] | IntArray) -> FloatArray:
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
        return np.asarray(weights @ self.shares.mean(1))
