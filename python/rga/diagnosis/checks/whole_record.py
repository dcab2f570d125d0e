"""A record with the rows that no step of a diagnosis sees, and what a cause gains on them."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.checks.explanations import variance
from rga.diagnosis.data.held_out import Gain, gain
from rga.diagnosis.data.observations import Data
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.linearised import Problem, pose, relaxed, resimulated
from rga.diagnosis.search.stepwise import ROUNDS, UNMOVED
from rga.simulation import Simulator


@dataclass(frozen=True)
class WholeRecord:
    """All rows of a record.

    Attributes:
        data: of all rows.
        held_out: rows that no step saw, bool[rows].
        noise: standard deviation of each reading about a faultless simulation, contexts' errors
            included, float[rows, sensors].
        deviation: standard deviation of each sensor's own noise, float[sensors].
    """

    data: Data
    held_out: BoolArray
    noise: FloatArray
    deviation: FloatArray
    _believed: dict[Problem, Data] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of(cls, data: Data, held_out: BoolArray, problem: Problem) -> "WholeRecord":
        """A record in units of the noise of a problem on the rows that are not held out."""
        spread = np.sqrt(variance(problem))
        noise = np.empty_like(data.readings)
        noise[~held_out] = spread
        noise[held_out] = np.sqrt((spread**2).mean(0))
        return cls(data, held_out, noise, problem.noise.deviation)

    def believed(self, part: Problem) -> Data:
        """All rows with their latent contexts, as a problem on the other rows has them; kept.

        Lines are prolonged. What is latent row by row can only come from the readings of the row:
        on held-out rows the model infers it as it would in use.
        """
        if part not in self._believed:
            self._believed[part] = self._inferred(part)
        return self._believed[part]

    def _inferred(self, part: Problem) -> Data:
        changes = {}
        belief = part.data.belief
        clock = part.data.time - part.data.time[0]
        for name in belief.lines:
            line = np.polyfit(clock, belief.table[name], 1)
            changes[name] = np.polyval(line, self.data.time - part.data.time[0])
        whole = replace(
            self.data, belief=self.data.belief.with_values(changes), scatter=part.data.scatter
        )
        if not belief.latent:
            return whole
        problem = pose(part.simulator, whole, factors=part.factors)
        for _ in range(ROUNDS):
            inferred = relaxed(problem).belief.table
            latent = {name: column for name, column in inferred.items() if name in belief.latent}
            before, whole = whole, replace(whole, belief=whole.belief.with_values(latent))
            if whole.belief.distance(before.belief) < UNMOVED:
                break
            problem = resimulated(problem, part.simulator, whole)
        return whole

    def simulated(self, part: Problem) -> FloatArray:
        """All rows as the simulation of a problem has them, float[rows, sensors]."""
        return self.at_zero(part, self.believed(part).predict(part.simulator))

    def at_zero(self, part: Problem, simulated: FloatArray) -> FloatArray:
        """A simulation with the logger's zeros where the rows that are not held out put them.

        Within three deviations of what errors of the zero may be.

        Args:
            part: gives the errors of the zero.
            simulated: of all rows, float[rows, sensors].
        """
        variance = part.zero_variance
        if not variance.any():
            return simulated
        seen = self.data.observed & ~self.held_out[:, None]
        off = np.where(seen, self.data.readings - simulated, 0.0)
        count = np.maximum(seen.sum(0), 1)
        noise = part.noise.sigma**2 * (1 + part.noise.phi) / (1 - part.noise.phi) / count
        likely = variance / (variance + noise) * off.sum(0) / count
        limit = 3 * np.sqrt(variance)
        return np.asarray(simulated + np.clip(likely, -limit, limit))

    def gain(
        self, before: FloatArray, after: FloatArray, causes: Sequence[Hypothesis], seed: int
    ) -> Gain:
        """What one simulation gains over another by the held-out readings.

        Rows that were held out right before an onset are not compared: in which of them the cause
        began no row that was fitted shows.

        Args:
            before, after: float[rows, sensors].
            causes: of the latter.
            seed: of the bootstrap.
        """
        seen, time = self.data.observed.copy(), self.data.time
        for onset in (one.onset for one in causes if one.onset is not None):
            fitted = time[~self.held_out & (time < onset)]
            seen[(time > fitted.max(initial=-np.inf)) & (time < onset)] = False
        readings = np.where(seen, self.data.readings, np.nan)
        left = (readings - after) / self.noise
        return gain(left, (after - before) / self.noise, self.held_out, seed)


def about(problem: Problem, simulator: Simulator) -> Problem:
    """A problem about another simulation, its contexts moved to where that puts them."""
    moved = relaxed(resimulated(problem, simulator, problem.data))
    return resimulated(problem, simulator, moved)
