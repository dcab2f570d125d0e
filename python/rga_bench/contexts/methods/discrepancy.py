"""MAP with a model error that is smooth over the structure."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from rga.arrays import FloatArray
from rga.model import Model
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.linearised import Linearised
from rga_bench.contexts.methods.posterior_modes import PosteriorModes, maximum_posterior

#: amplitude [share of what a sensor varies by] and length [share of the structure] to start from,
#: and the rounds in which modes and both of them follow each other
AMPLITUDE, LENGTH, ROUNDS = 0.03, 0.2, 2
#: amplitudes and lengths looked at
BOUNDS = ((np.log(1e-4), np.log(1.0)), (np.log(0.02), np.log(2.0)))


def smooth_discrepancy(problem: LearningProblem) -> PosteriorModes:
    """The form of Kennedy and O'Hagan (J. R. Stat. Soc. B 63, 2001): y = S(c) + d + noise.

    The error d is a Gaussian process over places and directions of the sensors. Its amplitude and
    its length are those of the greatest marginal likelihood of the measured rows, whose contexts
    are unknown.
    """
    found = replace(maximum_posterior(problem), learn=smooth_discrepancy)
    if not len(problem.real):
        return found
    alike = sensor_kernel(problem.model)
    size = problem.source.readings.std(axis=0)
    noise = np.diag(problem.noise**2)

    def covariance(level: FloatArray) -> FloatArray:
        amplitude, length = np.exp(level)
        return np.asarray((amplitude**2 * np.outer(size, size)) * alike(length) + noise)

    level = np.log([AMPLITUDE, LENGTH])
    for _ in range(ROUNDS):
        found = replace(found, covariance=covariance(level))
        rows = Linearised.at(found.twin, problem.real, found.mode(problem.real).value)
        level = minimize(
            lambda at, rows=rows: -rows.log_likelihood(covariance(at)).sum(),
            level,
            method="Nelder-Mead",
            bounds=BOUNDS,
            options={"xatol": 0.05, "fatol": 0.5},
        ).x
    return replace(found, covariance=covariance(level))


def sensor_kernel(model: Model) -> Callable[[float], FloatArray]:
    """Correlation of the model error of sensors, float[sensors, sensors], by its length.

    Squared-exponential in the distance [share of the structure], times the cosine between the
    directions; sensors of different kinds are apart.
    """
    at, toward, kinds = [], [], []
    for sensor in model.sensors.values():
        if sensor.member is not None:
            ends = np.array([model.nodes[node] for node in model.members[sensor.member].nodes])
            place, way = ends.mean(axis=0), ends[1] - ends[0]
        else:
            place, way = np.array(model.nodes[sensor.node or ""]), np.zeros(3)
        if sensor.direction is not None:
            way = np.array(sensor.direction)
        at.append(place)
        toward.append(way / np.linalg.norm(way))
        kinds.append(sensor.kind)
    place, way, kind = np.array(at), np.array(toward), np.array(kinds)
    every = np.array(list(model.nodes.values()))
    apart = ((place[:, None] - place[None]) ** 2).sum(axis=2) / np.ptp(every, axis=0).max() ** 2
    related = (way @ way.T) * (kind[:, None] == kind[None])
    return lambda length: related * np.exp(-0.5 * apart / length**2)
