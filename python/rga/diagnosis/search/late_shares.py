"""Shares of its rows that an effect has which begins late, and sums over the rows of them.

For many beginnings at once these sums are running sums from the last row on: they cost as many
operations as there are rows, not as many as rows times beginnings.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.search.hypothesis import Profile


class LateShares(Protocol):
    """Shares in the rows of effects that begin at moments."""

    def sums(self, values: FloatArray) -> FloatArray:
        """Sums of values float[k, rows] times the shares, float[k, beginnings]."""

    def squares(self, values: FloatArray) -> FloatArray:
        """Sums of values float[k, rows] times the squares of the shares, float[k, beginnings]."""


@dataclass(frozen=True)
class OneBeginning:
    """Shares of a beginning that is given.

    Attributes:
        weight: float[rows].
    """

    weight: FloatArray

    def sums(self, values: FloatArray) -> FloatArray:
        """As of `LateShares`."""
        return np.asarray(values @ self.weight)[:, None]

    def squares(self, values: FloatArray) -> FloatArray:
        """As of `LateShares`."""
        return np.asarray(values @ self.weight**2)[:, None]


@dataclass(frozen=True)
class EveryBeginning:
    """Shares of effects that begin at many moments, at once or growing up to the last row.

    Attributes:
        time: of the rows [s], float[rows].
        moments: at which the effects begin [s], float[beginnings].
        profile: how.
    """

    time: FloatArray
    moments: FloatArray
    profile: Profile

    def at(self, time: FloatArray) -> FloatArray:
        """Shares at other times [s], float[beginnings, times]."""
        later = time >= self.moments[:, None]
        if self.profile == "step":
            return later.astype(float)
        grown = (time - self.moments[:, None]) / self._left[:, None]
        return np.where(later, grown, 0.0)

    def sums(self, values: FloatArray) -> FloatArray:
        """As of `LateShares`."""
        behind = self._behind(values)
        if self.profile == "step":
            return behind
        # (t - b) / (e - b) = 1 - (e - t) / (e - b) with the end e.
        return np.asarray(behind - self._behind(values * self._to_end) / self._left)

    def squares(self, values: FloatArray) -> FloatArray:
        """As of `LateShares`."""
        behind = self._behind(values)
        if self.profile == "step":
            return behind
        first = self._behind(values * self._to_end) / self._left
        second = self._behind(values * self._to_end**2) / self._left**2
        return np.asarray(behind - 2 * first + second)

    def _behind(self, values: FloatArray) -> FloatArray:
        """Sums over the rows from each beginning on, float[k, beginnings]."""
        running = np.cumsum(values[:, ::-1], axis=1)[:, ::-1]
        return np.asarray(running[:, self._first])

    @cached_property
    def _first(self) -> IntArray:
        return np.asarray(np.searchsorted(self.time, self.moments))

    @cached_property
    def _to_end(self) -> FloatArray:
        return np.asarray(self.time[-1] - self.time)

    @cached_property
    def _left(self) -> FloatArray:
        return np.asarray(np.maximum(self.time[-1] - self.moments, 1e-12))
