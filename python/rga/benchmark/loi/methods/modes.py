"""Contexts by the mode of their posterior under a twin and a covariance of its readings."""

from dataclasses import dataclass, replace

import numpy as np

from rga.benchmark.loi.method import Calibrated, Estimate, Method, Problem, Rows
from rga.inference.starts import best_mode
from rga.inference.twin_on_arrays import TwinOnArrays
from rga.model.parameter import FloatArray


@dataclass(frozen=True)
class Modes:
    """Modes of the posterior, with Laplace's spread.

    Attributes:
        problem: what was learned from.
        twin: what simulates.
        covariance: of what readings differ by from the twin, float[sensors, sensors].
        source: rows simulated by the twin, to start from.
        learn: what learned this from the problem; None where rows without contexts teach nothing.
    """

    problem: Problem
    twin: TwinOnArrays
    covariance: FloatArray
    source: Rows
    learn: Method | None = None

    def infer(self, readings: FloatArray) -> Estimate:
        """Mode and spread of measured rows, float[n, sensors]; NaN where a reading is missing."""
        mode = best_mode(self.twin, readings, self.covariance, self.source)
        return Estimate(mode.value, mode.spread)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the twin tells, float[n, sensors]."""
        return self.twin.simulate(contexts)

    def recalibrated(self, recent: FloatArray) -> Calibrated:
        """Learned again from the measured rows and the recent ones."""
        if self.learn is None:
            return self
        return self.learn(replace(self.problem, real=np.vstack([self.problem.real, recent])))


def maximum_posterior(problem: Problem) -> Calibrated:
    """MAP: the simulator is taken as true, and readings differ from it by their noise alone."""
    twin = TwinOnArrays(problem.simulator)
    return Modes(problem, twin, np.diag(problem.noise**2), problem.source)
