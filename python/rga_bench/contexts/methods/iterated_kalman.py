"""The iterated extended Kalman filter."""

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.standard_units import standard
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.linearised import Linearised
from rga_bench.contexts.methods.posterior_modes import PosteriorModes
from rga_bench.contexts.methods.stream import Filtered, filtered, recursion

#: linearisations of every row
PASSES = 5


def iterated_kalman(problem: LearningProblem) -> Filtered:
    """Readings are linearised where the filter itself puts each row (Bell and Cathey, IEEE Trans.
    Automatic Control 38, 1993). All rows are linearised anew together, pass after pass: a row
    still follows from itself and those before.
    """
    return filtered(problem, _filter)


def _filter(
    modes: PosteriorModes, readings: FloatArray, memory: FloatArray
) -> tuple[FloatArray, FloatArray]:
    twin, precision = modes.twin, 1.0 / np.diag(modes.covariance)
    middle, scale = standard(twin.ranges)
    mean = (modes.mode(readings).value - middle) / scale
    covariance = np.zeros((*mean.shape, mean.shape[1]))
    for _ in range(PASSES):
        rows = Linearised.at(twin, readings, middle + scale * mean)
        weighed = (rows.slope * precision[:, None]).transpose(0, 2, 1)
        pull = (weighed @ rows.off[:, :, None])[:, :, 0]
        found, covariance = recursion(weighed @ rows.slope, pull, memory)
        # Half of the way: where the simulation bends much, whole steps circle.
        mean = (mean + found) / 2.0
    return mean, np.diagonal(covariance, axis1=1, axis2=2)
