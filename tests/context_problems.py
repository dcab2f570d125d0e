"""Easy problems of context inference: the model itself, with noise, in place of a bridge."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.stats import norm

from rga.inference.networks.design_samples import design
from rga.inference.rows import Rows
from rga.model import read_model
from rga.simulation import Simulator
from rga_bench.contexts.method import Calibrated, Estimate, LearningProblem
from rga_bench.synthetic.bridges.full_case_study import full_case_study


@cache
def easy(smooth: bool = False) -> tuple[LearningProblem, Rows]:
    """A problem without load tests, and rows to judge by; where asked, contexts drift slowly."""
    model = read_model(full_case_study(), "case study")
    simulator = Simulator(model)
    noise = np.array([float(sensor.noise or 0.0) for sensor in model.sensors.values()])
    drawn = design(model, 1000, latent=list(model.context), seed=1)
    nothing = Rows(np.zeros((0, len(model.context))), np.zeros((0, len(noise))))
    problem = LearningProblem(
        model, simulator, noise, Rows(drawn.contexts, drawn.readings), np.zeros(0), nothing, 1
    )
    rng = np.random.default_rng(2)
    judged = measured(problem, rng, 120, smooth)
    return replace(problem, real=measured(problem, rng, 120, smooth).readings), judged


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
_INFERRED: dict[tuple[int, int], tuple[Calibrated, Rows, Estimate]] = {}


def inferred(learned: Calibrated, judged: Rows) -> Estimate:
    """Contexts of rows, inferred once."""
    key = id(learned), id(judged)
    if key not in _INFERRED:
        _INFERRED[key] = learned, judged, learned.infer(judged.readings)
    return _INFERRED[key][2]


def error(problem: LearningProblem, learned: Calibrated, judged: Rows) -> float:
    """Mean squared error of the contexts in variances of contexts spread evenly."""
    off = inferred(learned, judged).value - judged.contexts
    return float((off**2 / (np.ptp(problem.ranges, axis=1) ** 2 / 12.0)).mean())


def coverage(learned: Calibrated, judged: Rows) -> float:
    """Share of the contexts that lie within central intervals of 90 %."""
    estimate = inferred(learned, judged)
    assert estimate.spread is not None
    return float(
        (np.abs(estimate.value - judged.contexts) < norm.ppf(0.95) * estimate.spread).mean()
    )
