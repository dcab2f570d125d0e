"""A network, and Gauss-Newton steps on the simulator from where it points."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.posterior_mode import posterior_mode
from rga_bench.contexts.method import Calibrated, Estimate, LearningProblem, Method
from rga_bench.contexts.methods.networks import source_only

STEPS = 4


@dataclass(frozen=True)
class RefinedNetwork:
    """A network whose answers are carried on.

    Attributes:
        problem: what was learned from.
        network: that points at the contexts.
    """

    problem: LearningProblem
    network: Calibrated

    def infer(self, readings: FloatArray) -> Estimate:
        """Contexts after a few steps, with Laplace's spread."""
        twin, noise = TwinOnArrays(self.problem.simulator), self.problem.noise
        start = self.network.infer(readings).value
        mode = posterior_mode(
            twin.simulate, twin.jacobian, readings, np.diag(noise**2), twin.ranges, start, STEPS
        )
        return Estimate(mode.value, mode.spread)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model of the problem simulates."""
        return self.problem.simulate(contexts)

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> Calibrated:
        """The same with the network recalibrated."""
        network = self.network.recalibrated(recent, alone=alone)
        return self if network is self.network else RefinedNetwork(self.problem, network)


def refined_network(problem: LearningProblem, learn: Method = source_only) -> Calibrated:
    """A network that has learned, and what follows it."""
    return RefinedNetwork(problem, learn(problem))
