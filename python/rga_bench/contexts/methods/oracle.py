"""The floor of the Error: a posterior that knows the physical twin."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.rows import Rows
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.posterior_modes import PosteriorModes
from rga_bench.synthetic.physical_twin import PhysicalTwin

#: step of central differences, in shares of the range of a context
STEP = 1e-5


@dataclass(frozen=True)
class TrueStructure(TwinOnArrays):
    """The physical twin in the place of the simulator.

    Attributes:
        truth: the physical twin.
    """

    truth: PhysicalTwin

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings without noise, float[n, sensors]."""
        return self.truth.read(contexts)

    def jacobian(self, contexts: FloatArray) -> FloatArray:
        """Derivatives by central differences, float[n, sensors, contexts]."""
        step = STEP * np.ptp(self.ranges, axis=1)
        moves = np.concatenate([np.diag(step), -np.diag(step)])
        moved = contexts[:, None] + moves
        read = self.truth.read(moved.reshape(-1, contexts.shape[1]))
        ahead, behind = np.split(
            read.reshape(len(contexts), len(moves), len(self.truth.sd)), 2, axis=1
        )
        return np.asarray(((ahead - behind) / (2.0 * step[:, None])).transpose(0, 2, 1))


def oracle_posterior(problem: LearningProblem, truth: PhysicalTwin) -> PosteriorModes:
    """MAP with the physical twin itself."""
    twin = TrueStructure(problem.simulator, truth)
    contexts = problem.source.contexts
    source = Rows(contexts, twin.simulate(contexts))
    guess = QuadraticGuess(source, problem.noise, twin.ranges, problem.seed)
    return PosteriorModes(problem, twin, np.diag(truth.sd**2), guess)
