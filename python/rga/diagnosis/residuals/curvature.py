"""Curves: readings that go with the square of a measured context, in whatever pattern.

A linear structure shows combinations of the courses of its loads, whatever its stiffnesses. What
the channels show along the square of a context beyond such combinations was put there by no cause
that acts in proportion: the specification test of Ramsey (1969, J. Royal Statistical Society B 31,
350), all channels together. A cause that follows the linear part of such a response is none.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rga.arrays import FloatArray
from rga.diagnosis.residuals.slopes import STRAIGHT, linear_histories, squares
from rga.diagnosis.search.linearised import Calibration, Problem, load_basis
from rga.numerics.decompositions import thin_svd

#: share of the rows that the courses of the loads may take, and of a square that they must leave
MOST_COURSES, LEFT = 1 / 12, 1e-3


@dataclass(frozen=True)
class Curve:
    """A measured context with whose square the channels go.

    Attributes:
        context: its name.
        sizes: of that part, as far as scatter does not explain it, per squared standard deviation
            of the context and over the noise of the channel [-], float[sensors].
    """

    context: str
    sizes: FloatArray


def curves(problem: Problem) -> list[Curve]:
    """Measured contexts with whose square the channels go beyond chance."""
    data, rows = problem.data, problem.covariance.rows
    curved = squares(linear_histories(problem))
    names = [name for name in curved if name not in data.belief.latent]
    if not names:
        return []
    residual = problem.residual(problem.simulated)
    left = np.where(data.observed, residual - problem.explained_by_scatter(residual), 0.0)
    courses = _courses(load_basis(problem.simulator, data))
    known = courses.shape[1]
    together = np.column_stack([courses, *(curved[name] for name in names)])
    sensors = len(data.sensors)
    sizes, squared, count = np.zeros((3, sensors, len(names)))
    for sensor in range(sensors):
        free = int(data.observed[:, sensor].sum()) - known - 1
        if free < known:
            continue
        columns = np.column_stack([together, left[:, sensor]]).T[:, None]
        white = rows.whiten(columns, np.full((known + len(names) + 1, 1), sensor))[:, 0].T
        span, _ = np.linalg.qr(white[:, :known])
        rest = white[:, known:] - span @ (span.T @ white[:, known:])
        along, reading = rest[:, :-1], rest[:, -1]
        size = (along**2).sum(0)
        seen = size > LEFT * (white[:, known:-1] ** 2).sum(0)
        product = along[:, seen].T @ reading
        sizes[sensor, seen] = product / size[seen] / problem.noise.sigma[sensor]
        squared[sensor, seen] = product**2 / size[seen] / ((reading**2).sum() / free)
        count[sensor, seen] = 1
    chance = chi2.sf(squared.sum(0), np.maximum(count.sum(0), 1))
    beyond = problem.criteria.structure.curve_chance / len(names)
    return [
        Curve(name, sizes[:, number])
        for number, name in enumerate(names)
        if chance[number] < beyond
    ]


def free_channels(problem: Problem, found: list[Curve]) -> list[Calibration]:
    """Random effects by which every channel may follow a context and its square.

    Args:
        problem: in which there are curves.
        found: those.
    """
    linear = linear_histories(problem)
    curved = squares(linear)
    free = []
    for curve in found:
        size = STRAIGHT * float(np.sqrt((curve.sizes**2).mean()))
        for sensor, one in enumerate(np.diag(problem.noise.sigma)):
            if problem.data.observed[:, sensor].any():
                free += [(np.outer(along[curve.context], one), size) for along in (linear, curved)]
    return free


def _courses(basis: FloatArray) -> FloatArray:
    """A level and the courses of the loads, orthonormal, float[rows, courses]."""
    together = np.column_stack([np.ones(len(basis)), basis])
    u, s, _ = thin_svd(together / np.linalg.norm(together, axis=0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, : max(1, int(MOST_COURSES * len(basis)))])
