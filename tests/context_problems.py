"""Easy problems of context inference: the model itself, with noise, in place of a bridge."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.stats import norm

from rga.arrays import FloatArray
from rga.inference import TrainingSettings
from rga.inference.networks.design_samples import design
from rga.inference.rows import Rows
from rga.model import read_model
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.lesson import Lesson
from rga.twin.messages.queries import R4, sha256
from rga.twin.simulation_model import SimulationModel
from rga_bench.contexts.data import station_of
from rga_bench.contexts.drift import MeasuredRows
from rga_bench.contexts.method import Estimate, LearningProblem
from rga_bench.synthetic.bridges.full_case_study import full_case_study

#: rows of which the contexts are known
Judged = Rows | MeasuredRows


@cache
def easy(smooth: bool = False) -> tuple[LearningProblem, Rows]:
    """A problem without load tests, and rows to judge by; where asked, contexts drift slowly."""
    problem = LearningProblem.of(lesson(1000, seed=1))
    rng = np.random.default_rng(2)
    judged = measured(problem, rng, 120, smooth)
    return replace(problem, real=measured(problem, rng, 120, smooth).readings), judged


def lesson(rows: int, seed: int, real: FloatArray | None = None) -> Lesson:
    """Simulated rows, and measured ones where they are given, float[n, sensors]."""
    model = read_model(full_case_study(), "case study")
    drawn = design(model, rows, latent=list(model.context), seed=seed)
    nothing = np.zeros((0, len(model.sensors)))
    learned = Lesson(
        data=R4(
            row=0,
            simulation=SimulationModel(model, station_of(model)),
            contexts=drawn.contexts,
            readings=drawn.readings,
            falling=np.zeros(rows, dtype=bool),
            simulated_rows=rows,
            measured_rows=0,
            sha256=sha256(drawn.contexts, drawn.readings),
        ),
        latent=tuple(model.context),
        noise=np.array([sensor.noise for sensor in model.sensors.values()], dtype=float),
        clock=0.0,
        seed=seed,
        training=TrainingSettings(),
        progress=lambda done: None,
    )
    return with_rows(learned, nothing if real is None else real)


def with_rows(lesson: Lesson, real: FloatArray, new: int = 0) -> Lesson:
    """The same lesson with other measured rows, float[n, sensors]; those from `new` on are new."""
    rows = {"real": real, "real_contexts": np.zeros((len(real), 0)), "measured_rows": len(real)}
    return replace(lesson, data=lesson.data.model_copy(update=rows), new=new)


def measured(
    problem: LearningProblem, rng: np.random.Generator, rows: int, smooth: bool = False
) -> Rows:
    """Rows of the model with noise."""
    free = rng.standard_normal((rows, len(problem.ranges)))
    if smooth:
        for row in range(1, rows):
            free[row] = 0.97 * free[row - 1] + np.sqrt(1.0 - 0.97**2) * free[row]
    low, high = problem.ranges.T
    contexts = low + (high - low) * norm.cdf(free)
    shown = problem.simulate(contexts)
    return Rows(contexts, shown + problem.noise * rng.standard_normal(shown.shape))


#: what was inferred for rows, with what it was inferred by: errors and coverages ask for the same
_INFERRED: dict[tuple[int, int], tuple[ContextEstimator, Judged, Estimate]] = {}


def inferred(problem: LearningProblem, learned: ContextEstimator, judged: Judged) -> Estimate:
    """Contexts of rows, inferred once."""
    key = id(learned), id(judged)
    if key not in _INFERRED:
        _INFERRED[key] = learned, judged, Estimate.by(learned, judged.readings, problem.model)
    return _INFERRED[key][2]


def error(problem: LearningProblem, learned: ContextEstimator, judged: Judged) -> float:
    """Mean squared error of the contexts in variances of contexts spread evenly."""
    off = inferred(problem, learned, judged).value - judged.contexts
    return float((off**2 / (np.ptp(problem.ranges, axis=1) ** 2 / 12.0)).mean())


def coverage(problem: LearningProblem, learned: ContextEstimator, judged: Judged) -> float:
    """Share of the contexts that lie within central intervals of 90 %."""
    estimate = inferred(problem, learned, judged)
    assert estimate.spread is not None
    return float(
        (np.abs(estimate.value - judged.contexts) < norm.ppf(0.95) * estimate.spread).mean()
    )
