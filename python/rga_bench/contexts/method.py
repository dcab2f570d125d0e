"""Ways to infer contexts that the product does without: what they get, and what they give."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from rga.arrays import FloatArray
from rga.inference.rows import Rows
from rga.model import ContextVariable, Model
from rga.simulation import Simulator
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.lesson import Lesson


@dataclass(frozen=True)
class LearningProblem:
    """A lesson of which every context is latent, as tables.

    The contexts of the measured rows are not in it.

    Attributes:
        model: the twin's.
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

    @classmethod
    def of(cls, lesson: Lesson) -> Self:
        """The tables of a lesson, all measured rows among them."""
        data, simulation = lesson.data, lesson.simulation
        none = Rows(data.contexts[:0], data.readings[:0])
        return cls(
            model=simulation.model,
            simulator=simulation.simulator,
            noise=lesson.noise,
            source=Rows(data.contexts, data.readings),
            real=data.real,
            load_tests=none if lesson.load_tests is None else lesson.load_tests,
            seed=lesson.seed,
        )

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

    @classmethod
    def by(cls, estimator: ContextEstimator, readings: FloatArray, model: Model) -> Self:
        """What an estimator infers of rows, of which no context is measured.

        Args:
            estimator: of all contexts of the model.
            readings: float[n, sensors].
            model: the twin's.
        """
        laws = list(model.context.values())
        middle = np.tile([np.mean(one.range) for one in laws], (len(readings), 1))
        value, spread = estimator.infer(0, readings, middle, np.zeros(len(readings)), laws)
        return cls(value, None if np.isnan(spread).all() else spread)


class Rival(ABC):
    """A way to infer contexts that the product does without (`ContextEstimator`).

    It infers all contexts, and takes no more from a row than its readings.
    """

    kind = "rival"
    remembers = False

    @property
    def found(self) -> None:
        """None: it goes by no joint posterior."""
        return None

    @property
    def correction(self) -> None:
        """None: what it has found of the structure, `simulate` alone shows."""
        return None

    @abstractmethod
    def estimate(self, readings: FloatArray) -> Estimate:
        """Contexts of consecutive measured rows, float[n, sensors], NaN where missing."""

    @abstractmethod
    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What it takes readings for at contexts, float[n, sensors]."""

    def refined(self, lesson: Lesson) -> ContextEstimator:
        """The same: measured rows whose contexts nobody knows teach it nothing."""
        return self

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Contexts from a row on, and their standard deviations, NaN where it has none."""
        found = self.estimate(readings[first:])
        spread = np.full(found.value.shape, np.nan) if found.spread is None else found.spread
        return found.value, spread

    def to_bytes(self) -> bytes:
        """Nothing: no run keeps it."""
        return b""
