"""The row that looks at no reading."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.standard_units import standard
from rga_bench.contexts.method import Estimate, LearningProblem, Rival


@dataclass(frozen=True)
class PriorMean(Rival):
    """The middle of every range, with the standard deviation of contexts spread evenly over it."""

    twin: TwinOnArrays

    def estimate(self, readings: FloatArray) -> Estimate:
        """The same for every row, whatever it shows."""
        middle, scale = standard(self.twin.ranges)
        shape = (len(readings), len(scale))
        return Estimate(np.broadcast_to(middle, shape), np.broadcast_to(scale, shape))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model simulates, float[n, sensors]."""
        return self.twin.simulate(contexts)


def prior_mean(problem: LearningProblem) -> PriorMean:
    """The mean of the prior: Error 1 by definition."""
    return PriorMean(TwinOnArrays(problem.simulator))
