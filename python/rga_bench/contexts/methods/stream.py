"""Contexts that drift from row to row: filters take the rows in their order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.posterior_mode import Mode
from rga.inference.map.standard_units import EDGE, standard
from rga.model import ContextVariable
from rga.numerics.bounded_step import bounded_step
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.method import Estimate, LearningProblem, Rival
from rga_bench.contexts.methods.posterior_modes import PosteriorModes, maximum_posterior

#: rows apart at which memory is measured: sensors' noise has forgotten itself by then
LAG = 5
#: most memory, and least share of a context that readings must determine for an estimate of its own
MOST, DETERMINED = 0.99, 0.6
#: standard errors of the likeness of rows without order that count as chance
CHANCE = 3.0

#: modes of what is filtered, readings, memory -> means and variances, float[n, contexts] each,
#: in standard units
Filter = Callable[[PosteriorModes, FloatArray, FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True)
class Filtered(Rival):
    """A filter with the memory that it learned.

    Attributes:
        modes: twin, noise, and where to start from.
        memory: phi of each context: z = phi * (z of the row before) + what is new, the variance of
            z being 1, float[contexts].
        filter: what filters.
    """

    modes: PosteriorModes
    memory: FloatArray
    filter: Filter
    remembers = True

    def estimate(self, readings: FloatArray) -> Estimate:
        """Contexts of consecutive rows, float[n, sensors], each from itself and those before."""
        middle, scale = standard(self.modes.twin.ranges)
        mean, variance = self.filter(self.modes, readings, self.memory)
        return Estimate(middle + scale * mean, scale * np.sqrt(variance))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model simulates, float[n, sensors]."""
        return self.modes.simulate(contexts)

    def refined(self, lesson: Lesson) -> "Filtered":
        """The same filter with the memory of all measured rows of a lesson."""
        return filtered(LearningProblem.of(lesson), self.filter)

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Contexts from a row on, all rows before having been filtered, and their spreads."""
        value, spread = super().infer(0, readings, contexts, time, laws)
        return value[first:], spread[first:]


def filtered(problem: LearningProblem, by: Filter) -> Filtered:
    """A filter for the model, with the memory that the measured rows of a problem show.

    Where contexts remember, errors that remember as well do not average out: the variance of the
    noise counts (1 + r) / (1 - r) times, r being the memory of what modes leave of the readings,
    as far as contexts share it.
    """
    modes, readings = maximum_posterior(problem), problem.real
    if len(readings) <= 2 * LAG:
        return Filtered(modes, np.zeros(len(modes.twin.ranges)), by)
    mode = modes.mode(readings)
    memory = drift_memory(mode, modes.twin.ranges)
    left = np.nan_to_num(readings - modes.twin.simulate(mode.value)) / problem.noise
    of_noise = float((left[1:] * left[:-1]).sum() / max((left**2).sum(), 1e-12))
    shared = np.clip(of_noise, 0.0, 0.9) * np.median(memory)
    covariance = modes.covariance * (1.0 + shared) / (1.0 - shared)
    return Filtered(replace(modes, covariance=covariance), memory, by)


def drift_memory(mode: Mode, ranges: FloatArray) -> FloatArray:
    """Memory of each context over consecutive rows, float[contexts], from their modes.

    A mode that determines the share w of its context has the variance w (1 - w) of its error beside
    w^2 times that of the context; what modes some rows apart differ by beyond the first is how far
    contexts drift. Rows without order have no memory, and every row stands for itself.
    """
    middle, scale = standard(ranges)
    z, share = (mode.value - middle) / scale, 1.0 - ((mode.spread / scale) ** 2).mean(axis=0)
    share = np.clip(share, 1e-3, 1.0)
    apart = ((z[LAG:] - z[:-LAG]) ** 2).mean(axis=0)
    alike = 1.0 - (apart - 2.0 * share * (1.0 - share)) / (2.0 * share**2)
    chance = CHANCE / (share**2 * np.sqrt(len(z)))
    alike = np.where(alike < chance, 0.0, np.minimum(alike, MOST**LAG))
    memory, well = alike ** (1.0 / LAG), share > DETERMINED
    return np.where(well, memory, np.median(memory[well]) if well.any() else 0.0)


def recursion(
    information: FloatArray, pull: FloatArray, memory: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The Kalman filter of rows that are linear in their contexts, in information form.

    Args:
        information: H' R^-1 H of each row, float[n, contexts, contexts].
        pull: H' R^-1 y, float[n, contexts].
        memory: of the contexts, float[contexts].

    Returns:
        Means within the ranges, float[n, contexts], and covariances, in standard units.
    """
    mean, covariance = np.empty(pull.shape), np.empty(information.shape)
    here, spread, still = np.zeros(len(memory)), np.eye(len(memory)), np.zeros(1)
    for row in range(len(pull)):
        before = np.linalg.inv(spread * np.outer(memory, memory) + np.diag(1.0 - memory**2))
        normal = before + information[row]
        toward = before @ (memory * here) + pull[row] - normal @ here
        here = here + bounded_step(normal[None], toward[None], here[None], still, EDGE)[0]
        spread = np.linalg.inv(normal)
        mean[row], covariance[row] = here, spread
    return mean, covariance
