"""Test rows as an estimator infers them, each by itself."""

import numpy as np

from rga.arrays import FloatArray
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.simulation_model import SimulationModel
from rga_bench.contexts.data import CalibrationData
from rga_bench.contexts.method import Estimate, Rival
from rga_bench.contexts.score import Score, score


def evaluated(estimator: ContextEstimator, known: CalibrationData) -> Score:
    """How good contexts of the test rows are.

    Args:
        estimator: that has learned.
        known: what it has learned from, and the test rows.
    """
    model = known.lesson.simulation.model
    estimate = Estimate.by(estimator, known.test.readings, model)
    simulated = _simulated(estimator, known, estimate.value)
    return score(known.test, estimate, simulated, known.ranges)


def _simulated(
    estimator: ContextEstimator, known: CalibrationData, contexts: FloatArray
) -> FloatArray:
    """What an estimator takes readings for at contexts, float[n, sensors]."""
    if isinstance(estimator, Rival):
        return estimator.simulate(contexts)
    given = known.lesson.simulation
    corrected = SimulationModel(given.model, given.station, estimator.correction)
    return corrected.readings(np.full(len(contexts), known.lesson.clock), contexts)
