"""Conventional model updating: a few parameters of the model fitted to load tests, then MAP."""

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from rga.arrays import FloatArray
from rga.inference.joint.joint_stiffness_surrogate import with_bending
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.rows import Rows
from rga.model import Model
from rga.model.schema import ContextVariable
from rga.simulation import Simulator
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.posterior_modes import PosteriorModes, maximum_posterior
from rga_bench.contexts.methods.updated_parameters import UpdatedParameter, unknowns

#: parameters are looked at within this many standard deviations of their priors
FAR = 4.0
#: linearisations of a fit at most
MOST = 12


def updated_model(problem: LearningProblem) -> PosteriorModes:
    """Least squares with priors on the load tests, whose contexts were recorded (Friswell and
    Mottershead, Finite element model updating in structural dynamics, 1995).

    What the fit leaves beyond the noise widens the covariance of the readings by a common factor.
    Without load tests it is MAP with the model as it is.
    """
    plain = maximum_posterior(problem)
    if not len(problem.load_tests.contexts):
        return plain
    model = with_bending(problem.model)
    sought = {f"updated {number}": one for number, one in enumerate(unknowns(model))}
    z, factor = fit(problem, model, sought)
    effects = {name: one.at(k) for (name, one), k in zip(sought.items(), z, strict=True)}
    twin = TwinOnArrays(Simulator(model.extended(effects)))
    source = Rows(problem.source.contexts, twin.simulate(problem.source.contexts))
    guess = QuadraticGuess(source, problem.noise, twin.ranges, problem.seed)
    return replace(plain, twin=twin, guess=guess, covariance=factor * plain.covariance)


def fit(
    problem: LearningProblem, model: Model, sought: dict[str, UpdatedParameter]
) -> tuple[FloatArray, float]:
    """Parameters in standard deviations of their priors, float[unknowns], and what is left.

    The second is the mean square of what the fit leaves, in variances of the noise, not below 1.
    """
    decades = np.array([one.spread for one in sought.values()]) / np.log(10.0)
    driving = {
        name: ContextVariable(unit="-", range=(-FAR * per, FAR * per))
        for name, per in zip(sought, decades, strict=True)
    }
    model = model.model_copy(update={"context": {**model.context, **driving}})
    driven = {name: one.driven(name) for name, one in sought.items()}
    free = TwinOnArrays(Simulator(model.extended(driven)))
    tests = problem.load_tests
    seen = np.isfinite(tests.readings)
    measured = np.where(seen, tests.readings, 0.0)

    def contexts(z: FloatArray) -> FloatArray:
        return np.hstack([tests.contexts, np.broadcast_to(decades * z, (len(seen), len(z)))])

    def off(z: FloatArray) -> FloatArray:
        gap = np.where(seen, free.simulate(contexts(z)) - measured, 0.0) / problem.noise
        return np.concatenate([gap.ravel(), z])

    def slope(z: FloatArray) -> FloatArray:
        rates = free.jacobian(contexts(z))[:, :, -len(z) :] * decades / problem.noise[:, None]
        return np.vstack(
            [np.where(seen[:, :, None], rates, 0.0).reshape(-1, len(z)), np.eye(len(z))]
        )

    found = least_squares(off, np.zeros(len(decades)), slope, bounds=(-FAR, FAR), max_nfev=MOST)
    left = float((found.fun[: -len(decades)] ** 2).sum()) / max(seen.sum(), 1)
    return found.x, max(left, 1.0)
