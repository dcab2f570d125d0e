"""Tasks of the levels of integration, and methods that are quick to learn."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.drift import DRIFTS
from rga_bench.contexts.method import Estimate, LearningProblem, Rival
from rga_bench.contexts.setting import DRIFTING, ContextsTask, Sizes

SIZES = Sizes(source=128, unlabelled=60, stream=160, test=40)
RANGES = np.array([[0.0, 1.0], [-30.0, 30.0], [3.0, 5.5], [10.0, 12.0]])


def task(
    manner: str = DRIFTING, row: str = "nearest", split: int = 0, **changes: Any
) -> ContextsTask:
    return replace(ContextsTask(3, split, "all", manner, row, DRIFTS, SIZES), **changes)


@dataclass(frozen=True, eq=False)
class Nearest(Rival):
    """The contexts of the simulated row that is most like the reading, less a level learned."""

    problem: LearningProblem
    level: FloatArray
    learned: list[int] = field(default_factory=list)

    def estimate(self, readings: FloatArray) -> Estimate:
        source = self.problem.source
        far = ((readings[:, None] - self.level - source.readings) ** 2).sum(axis=2)
        value = source.contexts[far.argmin(axis=1)]
        return Estimate(value, np.full(value.shape, np.inf))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        return self.problem.simulate(contexts) + self.level

    def refined(self, lesson: Lesson) -> "Nearest":
        recent = lesson.data.real[lesson.new :]
        off = recent - self.simulate(self.estimate(recent).value)
        return replace(self, level=self.level + off.mean(axis=0), learned=[len(recent)])


def nearest(lesson: Lesson) -> Nearest:
    return Nearest(LearningProblem.of(lesson), np.zeros(len(lesson.noise)))
