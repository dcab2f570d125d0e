"""Curves: readings that go with a square, of a measured context or of what they should be.

A linear structure shows combinations of the courses of its loads, whatever its stiffnesses. What
the channels show along a square beyond such combinations was put there by no cause that acts in
proportion: the specification test of Ramsey (1969, J. Royal Statistical Society B 31, 350). The
square of a context is sought in all channels together, that of its own simulated reading in each
as well: a member that softens bends the reading of its gauge. A cause that follows the linear part
of such a response is none.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rga.arrays import FloatArray
from rga.diagnosis.residuals.slopes import STRAIGHT, linear_histories, squares, standardised
from rga.diagnosis.search.linearised import Calibration, Problem, load_basis
from rga.numerics.decompositions import thin_svd

#: share of the rows that the courses of the loads may take, and of a square that they must leave
MOST_COURSES, LEFT = 1 / 12, 1e-3


@dataclass(frozen=True)
class Curve:
    """What the channels go with the square of.

    Attributes:
        driver: name of a measured context, or `OWN_READING`.
        linear: the driver of each channel about its mean, in its standard deviations, float[rows,
            sensors].
        squared: the part of its square that no straight line has, float[rows, sensors].
        sizes: of that part in the readings, as far as scatter does not explain it, over the noise
            of the channel [-], float[sensors].
    """

    driver: str
    linear: FloatArray
    squared: FloatArray
    sizes: FloatArray


#: the driver of channels that each go with the square of their own simulated reading
OWN_READING = "what they should be"


def curves(problem: Problem) -> list[Curve]:
    """What the channels go with the square of, beyond chance."""
    data, rows = problem.data, problem.covariance.rows
    sensors = len(data.sensors)
    drivers = _drivers(problem)
    residual = problem.residual(problem.simulated)
    left = np.where(data.observed, residual - problem.explained_by_scatter(residual), 0.0)
    courses = _courses(load_basis(problem.simulator, data))
    known = courses.shape[1]
    sizes, squared, count = np.zeros((3, sensors, len(drivers)))
    for sensor in range(sensors):
        free = int(data.observed[:, sensor].sum()) - known - 1
        if free < known:
            continue
        curved = np.column_stack([square[:, sensor] for _, square in drivers.values()])
        columns = np.column_stack([courses, curved, left[:, sensor]]).T[:, None]
        white = rows.whiten(columns, np.full(len(columns), sensor)[:, None])[:, 0].T
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
    # One channel of its own curve is lost among many straight ones.
    alone = sensors * chi2.sf(squared[:, -1].max(initial=0.0), 1)
    chance[-1] = 2 * min(chance[-1], alone)
    contexts = len(drivers) - 1
    beyond = [problem.criteria.structure.curve_chance / contexts] * contexts
    beyond.append(problem.criteria.structure.curve_chance)
    return [
        Curve(driver, *drivers[driver], sizes[:, number])
        for number, driver in enumerate(drivers)
        if chance[number] < beyond[number]
    ]


def free_channels(problem: Problem, found: list[Curve]) -> list[Calibration]:
    """Random effects by which every channel may follow a driver and its square.

    Args:
        problem: in which there are curves.
        found: those.
    """
    free = []
    for curve in found:
        size = STRAIGHT * float(np.sqrt((curve.sizes**2).mean()))
        for sensor, one in enumerate(np.diag(problem.noise.sigma)):
            if problem.data.observed[:, sensor].any():
                both = (curve.linear[:, sensor], curve.squared[:, sensor])
                free += [(np.outer(along, one), size) for along in both]
    return free


def _drivers(problem: Problem) -> dict[str, tuple[FloatArray, FloatArray]]:
    """What a square is sought of with that square, float[rows, sensors] each: own readings last."""
    sensors = len(problem.data.sensors)
    linear = linear_histories(problem)
    drivers = {
        name: (np.tile(linear[name][:, None], sensors), np.tile(square[:, None], sensors))
        for name, square in squares(linear).items()
        if name not in problem.data.belief.latent
    }
    own = dict(enumerate(problem.simulated.T))
    straight = standardised(own)
    curved = squares(straight)
    nothing = np.zeros(len(problem.data.time))
    drivers[OWN_READING] = (
        np.column_stack([straight.get(sensor, nothing) for sensor in own]),
        np.column_stack([curved.get(sensor, nothing) for sensor in own]),
    )
    return drivers


def _courses(basis: FloatArray) -> FloatArray:
    """A level and the courses of the loads, orthonormal, float[rows, courses]."""
    together = np.column_stack([np.ones(len(basis)), basis])
    u, s, _ = thin_svd(together / np.linalg.norm(together, axis=0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, : max(1, int(MOST_COURSES * len(basis)))])
