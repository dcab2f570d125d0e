"""Contexts that instruments read, beside those that nothing does."""

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.inference.map.array_simulator import TwinOnArrays

#: least noise of an instrument, as a share of the range of its context
EXACT = 1e-4
#: widths of its range by which a context that is read may lie beyond it
BEYOND = 3.0


@dataclass(frozen=True)
class MeasuredContexts:
    """What instruments read of the contexts, row by row: each is a sensor that sees one context.

    Attributes:
        values: float[n, contexts], NaN where nothing was read.
        noise: standard deviation of each, above 0, float[contexts].
    """

    values: FloatArray
    noise: FloatArray

    @classmethod
    def of(cls, values: FloatArray, noise: FloatArray, ranges: FloatArray) -> Self:
        """Those of instruments that may be exact.

        Args:
            values: float[n, contexts], NaN where nothing was read.
            noise: standard deviation of each, 0 of one that is exact, float[contexts].
            ranges: smallest and largest of each context, float[contexts, 2].
        """
        return cls(values, np.maximum(noise, EXACT * np.ptp(ranges, axis=1)))

    @classmethod
    def none(cls, rows: int, contexts: int) -> Self:
        """None in so many rows."""
        return cls(np.full((rows, contexts), np.nan), np.ones(contexts))

    @cached_property
    def columns(self) -> IntArray:
        """Contexts that were read in some row."""
        return np.flatnonzero(np.isfinite(self.values).any(axis=0))

    def within(self, ranges: FloatArray) -> FloatArray:
        """Ranges widened to what was read, float[contexts, 2]."""
        if not len(self.columns):
            return ranges
        read = self.values[:, self.columns]
        wide, reach = ranges.astype(float), 4.0 * self.noise[self.columns]
        low, high = np.nanmin(read, axis=0) - reach, np.nanmax(read, axis=0) + reach
        wide[self.columns, 0] = np.minimum(wide[self.columns, 0], low)
        wide[self.columns, 1] = np.maximum(wide[self.columns, 1], high)
        return wide

    def widest(self, ranges: FloatArray) -> FloatArray:
        """Ranges widened to what may be read, whatever these rows hold, float[contexts, 2]."""
        wide, read = ranges.astype(float), self.columns
        reach = BEYOND * np.ptp(ranges[read], axis=1)[:, None] + 4.0 * self.noise[read][:, None]
        wide[read] += reach * [-1.0, 1.0]
        return wide

    def beside(self, twin: TwinOnArrays) -> "WithInstruments":
        """The readings of a twin, and of the instruments behind them."""
        return WithInstruments(twin, self.columns)

    def behind(self, readings: FloatArray) -> FloatArray:
        """Readings, float[n, sensors], with those of the instruments behind them."""
        return np.hstack([readings, self.values[:, self.columns]])

    def behind_noise(self, noise: FloatArray) -> FloatArray:
        """Standard deviations, float[sensors], with those of the instruments behind them."""
        return np.concatenate([noise, self.noise[self.columns]])


@dataclass(frozen=True)
class WithInstruments:
    """A twin whose contexts are partly read.

    Attributes:
        twin: it.
        columns: contexts that are read.
    """

    twin: TwinOnArrays
    columns: IntArray

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings without noise, float[n, sensors + columns], of float[n, contexts]."""
        return np.hstack([self.twin.simulate(contexts), contexts[:, self.columns]])

    def jacobian(self, contexts: FloatArray) -> FloatArray:
        """Derivatives by the contexts, float[n, sensors + columns, contexts]."""
        own = np.eye(contexts.shape[1])[self.columns]
        return np.concatenate(
            [self.twin.jacobian(contexts), np.tile(own, (len(contexts), 1, 1))], axis=1
        )
