"""Contexts by the mode of their posterior under a twin and a covariance of its readings."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.map.posterior_mode import Mode, posterior_mode
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.method import Estimate, LearningProblem, Rival


@dataclass(frozen=True)
class PosteriorModes(Rival):
    """Modes of the posterior, with Laplace's spread.

    Attributes:
        problem: what was learned from.
        twin: what simulates.
        covariance: of what readings differ by from the twin, float[sensors, sensors].
        guess: contexts to start from.
        learn: what learned this from the problem; None where rows without contexts teach nothing.
    """

    problem: LearningProblem
    twin: TwinOnArrays
    covariance: FloatArray
    guess: QuadraticGuess
    learn: Callable[[LearningProblem], "PosteriorModes"] | None = None

    def mode(self, readings: FloatArray, start: FloatArray | None = None) -> Mode:
        """Modes of measured rows, from the guess or from another start, float[n, contexts]."""
        return posterior_mode(
            self.twin.simulate,
            self.twin.jacobian,
            readings,
            self.covariance,
            self.twin.ranges,
            self.guess(readings) if start is None else start,
        )

    def estimate(self, readings: FloatArray) -> Estimate:
        """Mode and spread of measured rows, float[n, sensors]; NaN where a reading is missing."""
        mode = self.mode(readings)
        return Estimate(mode.value, mode.spread)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the twin simulates, float[n, sensors]."""
        return self.twin.simulate(contexts)

    def refined(self, lesson: Lesson) -> "PosteriorModes":
        """Learned anew from all measured rows of a lesson: the new ones alone are too few."""
        return self if self.learn is None else self.learn(LearningProblem.of(lesson))


def maximum_posterior(problem: LearningProblem) -> PosteriorModes:
    """MAP: the simulator is taken as true, and readings differ from it by their noise alone."""
    twin = TwinOnArrays(problem.simulator)
    guess = QuadraticGuess(problem.source, problem.noise, twin.ranges, problem.seed)
    return PosteriorModes(problem, twin, np.diag(problem.noise**2), guess)
