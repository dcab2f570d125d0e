"""The unscented Kalman filter."""

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.standard_units import EDGE, standard
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.posterior_modes import PosteriorModes
from rga_bench.contexts.methods.stream import Filtered, filtered, recursion

#: least square of the arms, where they are clipped to the ranges
LEAST = 1e-9
#: linearisations of every row
PASSES = 4


def unscented_kalman(problem: LearningProblem) -> Filtered:
    """Sigma points (Julier and Uhlmann, Proc. IEEE 92, 2004), two to each context.

    The simulation bends within what is expected of a row without order, and so the points stand
    about what the filter found of the row, pass after pass (Garcia-Fernandez et al., Posterior
    linearization filter, IEEE Trans. Signal Process. 63, 2015).
    """
    return filtered(problem, _filter)


def _filter(
    modes: PosteriorModes, readings: FloatArray, memory: FloatArray
) -> tuple[FloatArray, FloatArray]:
    twin, (middle, scale) = modes.twin, standard(modes.twin.ranges)
    mode, seen = modes.mode(readings), np.isfinite(readings)
    mean, covariance = (mode.value - middle) / scale, mode.covariance
    for _ in range(PASSES):
        arms = np.sqrt(len(scale)) * np.linalg.cholesky(covariance).transpose(0, 2, 1)
        arms = np.concatenate([arms, -arms], axis=1)
        points = np.clip(mean[:, None] + arms, -EDGE, EDGE)
        shown = twin.simulate(middle + scale * points.reshape(-1, len(scale)))
        shown = np.where(seen[:, None], shown.reshape(*points.shape[:2], readings.shape[1]), 0.0)
        information, pull = _straight(
            points, shown, np.where(seen, readings, 0.0), modes.covariance
        )
        mean, covariance = recursion(information, pull, memory)
    return mean, np.diagonal(covariance, axis1=1, axis2=2)


def _straight(
    points: FloatArray, shown: FloatArray, measured: FloatArray, noise: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """H' R^-1 H and H' R^-1 y of lines through sigma points, R with their nonlinearity.

    Args:
        points: float[n, points, contexts].
        shown: readings at the points, float[n, points, sensors].
        measured: float[n, sensors].
        noise: covariance, float[sensors, sensors].
    """
    center, level = points.mean(axis=1), shown.mean(axis=1)
    moved, off = points - center[:, None], shown - level[:, None]
    turned = moved.transpose(0, 2, 1)
    own = turned @ moved + LEAST * np.eye(points.shape[2])
    slope = np.linalg.solve(own, turned @ off)
    bent = off - moved @ slope
    left = bent.transpose(0, 2, 1) @ bent / points.shape[1] + noise
    weighed = np.linalg.solve(left, slope.transpose(0, 2, 1)).transpose(0, 2, 1)
    toward = measured - level + (center[:, None] @ slope)[:, 0]
    return weighed @ slope.transpose(0, 2, 1), (weighed @ toward[:, :, None])[:, :, 0]
