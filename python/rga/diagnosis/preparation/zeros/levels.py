"""Levels of residuals: offsets, jumps, and how much of them few causes of the structure make."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.suspicious import doubted_units
from rga.diagnosis.search.hypothesis import hypotheses
from rga.diagnosis.search.signatures import signatures
from rga.model.schema import Model
from rga.numerics.decompositions import thin_svd
from rga.numerics.robust_spread import robust_spread
from rga.simulation import Simulator

#: rows that what causes change is worked out in: all of their constants are known by fewer
MOST_ROWS = 2_000
#: rows that are compared at a time
BLOCK = 8_192


@dataclass(frozen=True)
class Compared:
    """Readings of all rows beside their simulation.

    Attributes:
        model: as it was given.
        simulator: of it.
        data: of all rows.
        simulated: float[rows, sensors].
        noise: of the residual of each channel from row to row, float[sensors].
        own: noise of each sensor itself, float[sensors].
        doubted: channels whose unit is in doubt, bool[sensors]: what they read next to nothing of,
            or far too much, is no zero.
    """

    model: Model
    simulator: Simulator
    data: Data
    simulated: FloatArray
    noise: FloatArray
    own: FloatArray
    doubted: BoolArray

    @classmethod
    def of(cls, model: Model, simulator: Simulator, data: Data) -> "Compared":
        """Readings beside what a simulator says of them."""
        simulated = data.predict(simulator)
        noise = noise_by_steps(np.where(data.observed, data.readings - simulated, np.nan))
        stated = np.array([model.sensors[name].noise or np.inf for name in data.sensors])
        doubted = doubted_units(data, simulated)
        return cls(model, simulator, data, simulated, noise, np.minimum(stated, noise), doubted)

    @property
    def working(self) -> BoolArray:
        """Channels that do not stand still, in units that are not doubted, bool[sensors]."""
        return np.asarray((self.noise > 0) & ~self.doubted)

    def at_least(self, share: float) -> float:
        """Number of channels that must be off, for it to be no fault of their own.

        Args:
            share: of the working channels.
        """
        return float(max(self.data.criteria.zeros.fewest_channels, share * self.working.sum()))

    @cached_property
    def readings(self) -> FloatArray:
        """Float[rows, sensors], NaN where missing."""
        return np.where(self.data.observed, self.data.readings, np.nan)

    @cached_property
    def residual(self) -> FloatArray:
        """Readings less simulation, float[rows, sensors], NaN where missing."""
        return self.readings - self.simulated

    def changes_from(self, row: int, rows: int) -> Iterator[FloatArray]:
        """What causes of the structure that begin at a row change, over the noise.

        Args:
            row: the first.
            rows: how many rows the change is the mean of.

        Yields:
            Float[sensors] for each.
        """
        # Of a long record those about it are enough.
        first = max(0, min(row - MOST_ROWS // 2, len(self.simulated) - MOST_ROWS))
        about = self._of_rows(np.arange(first, min(first + MOST_ROWS, len(self.simulated))))
        behind = slice(row - first, row - first + rows)
        for change, late in about.changes():
            yield self.over_noise(change[behind].mean(0) + late)

    def changes(self) -> Iterator[tuple[FloatArray, FloatArray]]:
        """What causes of the structure change, float[rows, sensors], and what a late one adds.

        The latter, float[sensors], is what the zero takes off one that always acts.
        """
        data, sensors = self.data, len(self.data.sensors)
        candidates = [
            one
            for one in hypotheses(self.model, data.sensors, list(data.belief.spread))
            if not one.kind.on_sensors
        ]
        for found in signatures(data, data.about(self.simulator), candidates):
            touched = slice(None) if found.channels is None else found.channels
            change, late = np.zeros((len(data.time), sensors)), np.zeros(sensors)
            change[:, touched], late[touched] = found.values.T, found.zero
            yield change, late

    def thinned(self) -> "Compared":
        """The same of a bounded number of rows, evenly chosen."""
        return self._of_rows(
            np.arange(0, len(self.simulated), -(-len(self.simulated) // MOST_ROWS))
        )

    def _of_rows(self, chosen: IntArray) -> "Compared":
        if len(chosen) == len(self.simulated):
            return self
        return replace(self, data=self.data.rows(chosen), simulated=self.simulated[chosen])

    def over_noise(self, values: FloatArray) -> FloatArray:
        """Values in units of the noise; zero of channels that do not work, or where missing."""
        shown = np.nan_to_num(values) / np.where(self.working, self.noise, 1.0)
        return np.where(self.working, shown, 0.0)

    def sizes(self, levels: FloatArray, off: BoolArray) -> str:
        """The largest levels [units of the sensors] of some channels, a unit each, in words."""
        largest: dict[str, float] = {}
        for k in np.flatnonzero(off):
            unit = self.model.sensors[self.data.sensors[k]].unit
            largest[unit] = max(largest.get(unit, 0.0), abs(float(levels[k])))
        return " and ".join(f"{size:.3g} {unit}" for unit, size in largest.items())


def noise_by_steps(residual: FloatArray) -> FloatArray:
    """Robust deviation of each channel's noise, by what changes from row to row, float[sensors]."""
    steps = np.diff(residual, axis=0)
    typical = [robust_spread(one[np.isfinite(one)]) for one in steps.T]
    return np.asarray(np.array(typical, dtype=float) / np.sqrt(2))


def moving_means(values: FloatArray, width: int) -> FloatArray:
    """Means over so many rows from each row on, NaN where there is none, float[rows, sensors]."""
    first = np.arange(len(values) - width + 1)
    return means_between(values, first, first + width)


def means_between(values: FloatArray, first: IntArray, end: IntArray) -> FloatArray:
    """Means over rows from `first` to before `end`, NaN where there is none, float[n, sensors]."""
    return RunningSums.of(values).means(first, end)


@dataclass(frozen=True)
class RunningSums:
    """Sums of values over all rows before each, of which means over any rows follow.

    Attributes:
        total: float[rows + 1, sensors].
        count: of the values that are there, int[rows + 1, sensors].
    """

    total: FloatArray
    count: NDArray[np.int32]

    @classmethod
    def of(cls, values: FloatArray) -> "RunningSums":
        """Those of values float[rows, sensors], NaN where missing."""
        seen = np.isfinite(values)
        total = np.zeros((len(values) + 1, values.shape[1]))
        np.cumsum(np.where(seen, values, 0.0), axis=0, out=total[1:])
        count = np.zeros(total.shape, dtype=np.int32)
        np.cumsum(seen, axis=0, out=count[1:])
        return cls(total, count)

    def means(self, first: IntArray, end: IntArray) -> FloatArray:
        """As `means_between`."""
        total, count = self.total[end] - self.total[first], self.count[end] - self.count[first]
        return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def blocks(count: int) -> Iterator[slice]:
    """Slices of so many rows that what is made of each stays small."""
    for first in range(0, count, BLOCK):
        yield slice(first, min(first + BLOCK, count))


def constant(simulator: Simulator, data: Data) -> FloatArray:
    """A constant, less what the time histories of the loads have of it, float[rows]."""
    loads = simulator.load_coefficients(data.belief.table)
    u, s, _ = thin_svd(loads)
    courses = u[:, s > 1e-6 * s.max(initial=0.0)]
    ones = np.ones(len(data.time))
    rest = ones - courses @ (courses.T @ ones)
    # Under loads that hardly vary no constant can be distinguished from their response.
    return rest if rest @ rest > 1e-3 * len(rest) else ones


def left_by_causes(levels: FloatArray, patterns: Sequence[FloatArray], most: int) -> FloatArray:
    """What is left of levels after so many causes, each the best beside those before it.

    Args:
        levels: of the channels, over their noise, float[sensors].
        patterns: of single causes, in the same units, float[sensors] each.
        most: causes.
    """
    left = levels
    rest = np.array([one for one in patterns if one.any()]).reshape(-1, len(left))
    for _ in range(min(most, len(rest))):
        sizes = (rest**2).sum(1)
        along = rest @ left / np.sqrt(np.maximum(sizes, 1e-300))
        best = rest[np.argmax(np.abs(along))] / np.sqrt(sizes[np.argmax(np.abs(along))])
        left = left - best * (best @ left)
        rest = rest - np.outer(rest @ best, best)
        rest = rest[(rest**2).sum(1) > 1e-6 * sizes]
        if not len(rest):
            break
    return left
