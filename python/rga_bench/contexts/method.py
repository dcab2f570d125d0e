"""What a way to infer contexts gets, and what it gives."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from rga.arrays import FloatArray
from rga.inference.rows import Rows
from rga.model import Model
from rga.simulation import Simulator


@dataclass(frozen=True)
class LearningProblem:
    """What a method learns from. The contexts of the measured rows are not in it.

    Attributes:
        model: the twin's; all of its contexts are latent.
        simulator: of the model.
        noise: standard deviation of each sensor's noise, float[sensors].
        source: simulated rows, without noise.
        real: measured rows, float[n, sensors].
        load_tests: measured rows whose contexts were recorded as well; none or a few.
        seed: of everything random.
    """

    model: Model
    simulator: Simulator
    noise: FloatArray
    source: Rows
    real: FloatArray
    load_tests: Rows
    seed: int

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings without noise, float[n, sensors], of contexts, float[n, contexts]."""
        return self.simulator.predict(dict(zip(self.model.context, contexts.T, strict=True)))

    @property
    def ranges(self) -> FloatArray:
        """Smallest and largest of each context, float[contexts, 2]."""
        return np.array([variable.range for variable in self.model.context.values()])


@dataclass(frozen=True)
class Estimate:
    """What was inferred.

    Attributes:
        value: float[n, contexts], in the units of the contexts.
        spread: standard deviation of each, of the same shape; None where a method has none.
    """

    value: FloatArray
    spread: FloatArray | None


class Calibrated(Protocol):
    """A method that has learned."""

    def infer(self, readings: FloatArray) -> Estimate:
        """Contexts of measured rows, float[n, sensors]."""

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the twin of this method lets expect at contexts, float[n, sensors]."""

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> "Calibrated":
        """The method after it has also learned from measured rows, float[n, sensors].

        Args:
            recent: the rows.
            alone: whether it is for rows like the recent ones only, since states that are stored
                stand for the others; a method may learn for all rows nevertheless.
        """


#: learns
Method = Callable[[LearningProblem], Calibrated]
