"""Conventional model updating: a few parameters of the model fitted to load tests, then MAP."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from rga.benchmark.loi.method import Problem, Rows
from rga.benchmark.loi.methods.modes import Modes, maximum_posterior
from rga.inference.guess import QuadraticGuess
from rga.inference.twin_on_arrays import TwinOnArrays
from rga.model import Model
from rga.model.effect import Effect
from rga.model.effects.bearings import SupportFlexibility
from rga.model.effects.joints import JointRigidity
from rga.model.effects.stiffness import ElasticModulus, MemberStiffness
from rga.model.effects.thermal import ThermalExpansion
from rga.model.parameter import Driven, Factor, FloatArray, Positive
from rga.model.schema import ContextVariable
from rga.simulation import Simulator

#: parameters are looked at within this many standard deviations of their priors
FAR = 4.0


@dataclass(frozen=True)
class Unknown:
    """A parameter that is updated: log-normal beforehand.

    Attributes:
        effect: kind and place of the effect, with any value of the parameter.
        parameter: its name.
        median, spread: value of the middle, and standard deviation of its natural logarithm.
    """

    effect: Effect
    parameter: str
    median: float
    spread: float

    def driven(self, context: str) -> Effect:
        """The effect with its parameter as a power of ten of a context."""
        follows = Driven(context=context, times=self.median, log10=True)
        return self.effect.model_copy(update={self.parameter: follows})

    def at(self, z: float) -> Effect:
        """The effect with its parameter z standard deviations from the middle."""
        return self.effect.with_values(
            {self.parameter: self.median * float(np.exp(self.spread * z))}
        )


def unknowns(model: Model) -> Iterator[Unknown]:
    """What is updated.

    Elastic modulus and thermal expansion of materials, stiffness of the group that a member names
    first, upright flexibility of each support, and rigidity of all joints.
    """
    first = dict.fromkeys(member.groups[0] for member in model.members.values() if member.groups)
    places: list[tuple[type[Effect], dict[str, object]]] = [
        (kind, place) for kind in (ElasticModulus, ThermalExpansion) for place in kind.places(model)
    ]
    places += [(MemberStiffness, {"group": group}) for group in first]
    places += [
        (SupportFlexibility, place)
        for place in SupportFlexibility.places(model)
        if place["dof"] == "uz" and isinstance(place["support"], str)
    ]
    # The last place of joints is that of all groups together.
    places += [(JointRigidity, place) for place in list(JointRigidity.places(model))[-1:]]
    for kind, place in places:
        ((parameter, prior),) = kind.priors(model, place).items()
        if not isinstance(prior, Factor | Positive):
            raise TypeError(f"the prior of {parameter} is not log-normal")
        median = prior.value(0.0)
        effect = kind.model_validate({**place, parameter: median})
        yield Unknown(effect, parameter, median, prior.spread)


def updated_model(problem: Problem) -> Modes:
    """Least squares with priors on the load tests, whose contexts were recorded (Friswell and
    Mottershead, Finite element model updating in structural dynamics, 1995).

    What the fit leaves beyond the noise widens the covariance of the readings by a common factor.
    Without load tests it is MAP with the model as it is.
    """
    plain = maximum_posterior(problem)
    if not len(problem.load_tests.contexts):
        return plain
    sought = {f"updated {number}": one for number, one in enumerate(unknowns(problem.model))}
    z, factor = fit(problem, sought)
    effects = {name: one.at(k) for (name, one), k in zip(sought.items(), z, strict=True)}
    twin = TwinOnArrays(problem.simulator.extended(effects))
    source = Rows(problem.source.contexts, twin.simulate(problem.source.contexts))
    guess = QuadraticGuess(source, problem.noise, twin.ranges, problem.seed)
    return replace(plain, twin=twin, guess=guess, covariance=factor * plain.covariance)


def fit(problem: Problem, sought: dict[str, Unknown]) -> tuple[FloatArray, float]:
    """Parameters in standard deviations of their priors, float[unknowns], and what is left.

    The second is the mean square of what the fit leaves, in variances of the noise, not below 1.
    """
    decades = np.array([one.spread for one in sought.values()]) / np.log(10.0)
    driving = {
        name: ContextVariable(unit="-", range=(-FAR * per, FAR * per))
        for name, per in zip(sought, decades, strict=True)
    }
    model = problem.model.model_copy(update={"context": {**problem.model.context, **driving}})
    free = TwinOnArrays(
        Simulator(model.extended({name: one.driven(name) for name, one in sought.items()}))
    )
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

    found = least_squares(off, np.zeros(len(decades)), slope, bounds=(-FAR, FAR))
    left = float((found.fun[: -len(decades)] ** 2).sum()) / max(seen.sum(), 1)
    return found.x, max(left, 1.0)
