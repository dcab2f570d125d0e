"""A network, and Gauss-Newton steps on the simulator from where it points."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference import TrainingSettings
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.posterior_mode import posterior_mode
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.method import Estimate, LearningProblem, Rival
from rga_bench.contexts.methods.networks import NETWORKS, trained

STEPS = 4


@dataclass(frozen=True)
class RefinedNetwork(Rival):
    """A network whose answers are carried on.

    Attributes:
        problem: what was learned from.
        network: that points at the contexts.
    """

    problem: LearningProblem
    network: ContextEstimator

    def estimate(self, readings: FloatArray) -> Estimate:
        """Contexts after a few steps, with Laplace's spread."""
        twin, noise = TwinOnArrays(self.problem.simulator), self.problem.noise
        start = Estimate.by(self.network, readings, self.problem.model).value
        mode = posterior_mode(
            twin.simulate, twin.jacobian, readings, np.diag(noise**2), twin.ranges, start, STEPS
        )
        return Estimate(mode.value, mode.spread)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model of the problem simulates."""
        return self.problem.simulate(contexts)

    def refined(self, lesson: Lesson) -> "RefinedNetwork":
        """The same with the network refined."""
        network = self.network.refined(lesson)
        return self if network is self.network else RefinedNetwork(self.problem, network)


def refined_network(
    lesson: Lesson, settings: TrainingSettings = NETWORKS["source only"]
) -> RefinedNetwork:
    """A network that has learned with some settings, and what follows it."""
    return RefinedNetwork(LearningProblem.of(lesson), trained(settings)(lesson))
