"""What no method can do without, or better: the noise, the true context and the best one."""

import numpy as np
from scipy.spatial import KDTree

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.posterior_mode import posterior_mode
from rga_bench.contexts.data import CalibrationData
from rga_bench.contexts.drift import MeasuredRows
from rga_bench.contexts.score import Score, gap

#: rows of a table that are no methods; they have an RG and infer nothing
NOISE, TRUE_CONTEXT, BEST_CONTEXT = FLOORS = ("noise", "true context", "best context")
#: beside noise as small as this the prior says nothing [mm]
SHARP = 0.1


def floor(name: str, known: CalibrationData, measured: MeasuredRows) -> Score:
    """A floor of the RG of measured rows.

    Args:
        name: `noise`: what the sensors add; `true context`: what the model leaves at the contexts
            as they were; `best context`: the least that any contexts leave.
        problem: whose model it is.
        known: what is calibrated on: the model.
        measured: with the true contexts.
    """
    if name == NOISE:
        return Score(gap(measured.noise))
    contexts = measured.contexts
    if name == BEST_CONTEXT:
        contexts = best_contexts(known, measured)
    simulated = TwinOnArrays(known.lesson.simulation.simulator).simulate(contexts)
    return Score(gap(measured.readings - simulated))


def best_contexts(known: CalibrationData, measured: MeasuredRows) -> FloatArray:
    """Contexts whose simulation is nearest to the readings.

    The better of two modes of each row: from its true contexts on, and from those of the simulated
    row that is most like it. They are within their ranges, which are widened where true contexts
    lie beyond.

    Returns:
        float[n, contexts].
    """
    readings, source = measured.readings, known.lesson.data
    twin = TwinOnArrays(known.lesson.simulation.simulator)
    low = np.minimum(known.ranges[:, 0], measured.contexts.min(axis=0))
    high = np.maximum(known.ranges[:, 1], measured.contexts.max(axis=0))
    alike = KDTree(source.readings).query(readings)[1]
    modes = [
        posterior_mode(
            twin.simulate,
            twin.jacobian,
            readings,
            SHARP**2 * np.eye(readings.shape[1]),
            np.column_stack([low, high]),
            start,
        )
        for start in (measured.contexts, source.contexts[alike])
    ]
    better = np.argmin([one.misfit for one in modes], axis=0)
    values = np.stack([one.value for one in modes])
    return np.asarray(values[better, np.arange(len(readings))])
