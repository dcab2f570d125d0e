"""The ensemble Kalman filter."""

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.standard_units import EDGE, standard
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.posterior_modes import PosteriorModes
from rga_bench.contexts.methods.stream import Filtered, filtered

#: members, and the parts in which a row is assimilated
MEMBERS, PARTS = 100, 4


def ensemble_kalman(problem: LearningProblem) -> Filtered:
    """Members with perturbed readings (Evensen, J. Geophys. Res. 99, 1994).

    A row is assimilated in parts, each with the variance of the noise times their number, as the
    simulation bends within the ensemble (Emerick and Reynolds, Computers & Geosciences 55, 2013).
    """
    return filtered(problem, _filter)


def _filter(
    modes: PosteriorModes, readings: FloatArray, memory: FloatArray
) -> tuple[FloatArray, FloatArray]:
    middle, scale = standard(modes.twin.ranges)
    noise, size = np.diag(modes.covariance), len(memory)
    rng = np.random.default_rng(modes.problem.seed)
    mean, variance = np.empty((len(readings), size)), np.empty((len(readings), size))
    members = rng.uniform(-EDGE, EDGE, (MEMBERS, size))
    for row, measured in enumerate(readings):
        new = rng.uniform(-EDGE, EDGE, members.shape)
        members = np.clip(memory * members + np.sqrt(1.0 - memory**2) * new, -EDGE, EDGE)
        seen = np.isfinite(measured)
        for _ in range(PARTS if seen.any() else 0):
            shown = modes.twin.simulate(middle + scale * members)[:, seen]
            off, moved = shown - shown.mean(axis=0), members - members.mean(axis=0)
            wide = PARTS * noise[seen]
            perturbed = measured[seen] + np.sqrt(wide) * rng.standard_normal(shown.shape)
            cross, own = moved.T @ off / (MEMBERS - 1), off.T @ off / (MEMBERS - 1)
            gain = np.linalg.solve(own + np.diag(wide), cross.T).T
            members = np.clip(members + (perturbed - shown) @ gain.T, -EDGE, EDGE)
        mean[row], variance[row] = members.mean(axis=0), members.var(axis=0, ddof=1)
    return mean, variance
