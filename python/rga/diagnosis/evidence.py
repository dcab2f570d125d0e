"""The evidence for hypotheses: fits on the real model, and Laplace's approximation.

For parameters theta(z) with z standard normal beforehand, the log evidence against no effect is

    1/2 (r0' C^-1 r0 - r' C^-1 r - z' z - log det(I + S' C^-1 S)) + log prior

at the most likely z, with r the residual and S = d simulation / d z there (Laplace; MacKay 2003,
chapter 27). Kinds, places and onsets enter through the prior, so that many hypotheses do not make
one of them likely.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from rga.diagnosis.covariance import Reduced
from rga.diagnosis.hypothesis import Hypothesis
from rga.diagnosis.problem import Problem
from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

STEP = 1e-3
STEPS = 12
#: bounds of z, of a step in z, of how often a step is shortened, and of the loss worth a step
FARTHEST, LONGEST, SHORTENED, ENOUGH = 8.0, 2.0, 6, 1e-3


@dataclass(frozen=True)
class Fit:
    """Hypotheses fitted together.

    Attributes:
        hypotheses: those fitted.
        z: standard normal coordinates of all parameters, in their order, float[parameters].
        simulated: float[rows, sensors].
        signatures: S, derivatives by z, float[parameters, sensors, rows].
        information: I + S' C^-1 S, float[parameters, parameters].
        log_evidence: against no effect at all.
    """

    hypotheses: tuple[Hypothesis, ...]
    z: FloatArray
    simulated: FloatArray
    signatures: FloatArray
    information: FloatArray
    log_evidence: float
    _simulators: dict[Simulator, Simulator] = field(
        default_factory=dict, init=False, compare=False, repr=False
    )

    def slices(self) -> list[slice]:
        """The parameters of each hypothesis in z."""
        ends = np.cumsum([0, *(len(one.priors) for one in self.hypotheses)])
        return [slice(int(a), int(b)) for a, b in pairwise(ends)]

    def simulator(self, base: Simulator) -> Simulator:
        """The base with the effects as fitted."""
        if base not in self._simulators:
            self._simulators[base] = extended(base, self.hypotheses, self.z)
        return self._simulators[base]

    def spreads(self) -> FloatArray:
        """Posterior standard deviation of each coordinate z."""
        return (
            np.asarray(np.sqrt(np.diag(np.linalg.inv(self.information)))) if len(self.z) else self.z
        )


def effects_at(
    hypotheses: Sequence[Hypothesis], z: FloatArray, last: int | None = None
) -> dict[str, Effect]:
    """The effects of hypotheses at coordinates z, named by number; the last number may be given."""
    effects = {}
    first = 0
    before = 0 if last is None else last - len(hypotheses)
    for number, one in enumerate(hypotheses, before + 1):
        count = len(one.priors)
        effects[f"cause {number}"] = one.effect(z[first : first + count])
        first += count
    return effects


def extended(base: Simulator, hypotheses: Sequence[Hypothesis], z: FloatArray) -> Simulator:
    """A simulator with the effects of hypotheses at coordinates z."""
    return base.extended(effects_at(hypotheses, z))


def fit(
    problem: Problem,
    base: Simulator,
    hypotheses: Sequence[Hypothesis],
    start: Sequence[float] | FloatArray,
    beside: Fit | None = None,
) -> Fit:
    """The most likely parameters of hypotheses together, by Gauss-Newton steps on the real model.

    Args:
        problem: gives residual and covariance.
        base: the simulator without the hypotheses.
        hypotheses: fitted together.
        start: coordinates to begin with.
        beside: a fit of hypotheses that stand first among these: they move along its signatures,
            which costs less than to simulate them anew.

    Returns:
        The fit; its log evidence is minus infinity where the model cannot be simulated.
    """
    covariance, data = problem.covariance, problem.data
    known = 0 if beside is None else len(beside.z)
    about = data.about(base if beside is None else beside.simulator(base))
    added = hypotheses if beside is None else hypotheses[len(beside.hypotheses) :]

    def simulate(z: FloatArray) -> FloatArray | None:
        try:
            simulated = data.tried(about, effects_at(added, z[known:], len(hypotheses)))
        except InputError:
            return None
        if beside is None or not known:
            return simulated
        return np.asarray(simulated + np.tensordot(z[:known] - beside.z, beside.signatures, 1).T)

    def misfit(simulated: FloatArray, z: FloatArray) -> tuple[float, Reduced]:
        residual = covariance.reduce(problem.residual(simulated).T[None])
        return float(covariance.squares(residual)[0] + z @ z), residual

    z = np.array(start, dtype=float)
    simulated = simulate(z)
    if simulated is None:
        return _impossible(problem, hypotheses, z)
    loss, residual = misfit(simulated, z)
    information = np.eye(len(z))
    signatures = np.zeros((0, *simulated.T.shape))
    for step in range(STEPS + 1 if len(z) else 0):
        here = _signatures(simulate, simulated, z, known)
        if here is None:
            return _impossible(problem, hypotheses, z)
        signatures = here if beside is None else np.concatenate([beside.signatures, here])
        reduced = covariance.reduce(signatures)
        information = covariance.product(reduced, reduced) + np.eye(len(z))
        if step == STEPS:
            break
        move = np.linalg.solve(information, covariance.product(reduced, residual)[:, 0] - z)
        move *= min(1.0, LONGEST / max(np.abs(move).max(), 1e-12))
        lower = None
        for _ in range(SHORTENED):
            trial = np.clip(z + move, -FARTHEST, FARTHEST)
            there = simulate(trial)
            if there is not None and (found := misfit(there, trial))[0] < loss:
                lower = found
                break
            move = move / 3
        if lower is None or there is None:
            break
        gained, z, simulated, (loss, residual) = loss - lower[0], trial, there, lower
        if gained < ENOUGH:
            break
    return _weighed(
        problem, base, Fit(tuple(hypotheses), z, simulated, signatures, information, 0.0), loss
    )


def refit(problem: Problem, base: Simulator, one: Fit) -> Fit:
    """A fit moved to where another covariance of the same record puts it, along its signatures.

    Args:
        problem: the same data and simulation, channels or noise taken otherwise.
        base: the simulator without the hypotheses.
        one: as it was fitted.
    """
    covariance = problem.covariance
    residual = covariance.reduce(problem.residual(one.simulated).T[None])
    if not len(one.z):
        return _weighed(problem, base, one, float(covariance.squares(residual)[0]))
    reduced = covariance.reduce(one.signatures)
    information = covariance.product(reduced, reduced) + np.eye(len(one.z))
    along = covariance.product(reduced, residual)[:, 0]
    move = np.linalg.solve(information, along - one.z)
    move *= min(1.0, LONGEST / max(np.abs(move).max(initial=0.0), 1e-12))
    z = one.z + move
    loss = float(covariance.squares(residual)[0] + z @ z - 2 * move @ along)
    loss += float(move @ (information - np.eye(len(z))) @ move)
    simulated = one.simulated + np.tensordot(move, one.signatures, 1).T
    moved = replace(one, z=z, simulated=simulated, information=information)
    return _weighed(problem, base, moved, loss)


def _weighed(problem: Problem, base: Simulator, one: Fit, loss: float) -> Fit:
    """The fit with its log evidence, its loss known."""
    if base not in problem.at_nothing:
        nothing = problem.residual(problem.data.predict(base)).T[None]
        squares = problem.covariance.squares(problem.covariance.reduce(nothing))
        problem.at_nothing[base] = float(squares[0])
    freedom = float(np.linalg.slogdet(one.information)[1])
    log_evidence = 0.5 * (problem.at_nothing[base] - loss - freedom)
    log_evidence += sum(each.log_prior for each in one.hypotheses)
    return replace(one, log_evidence=log_evidence)


def _signatures(
    simulate: Callable[[FloatArray], FloatArray | None],
    simulated: FloatArray,
    z: FloatArray,
    known: int,
) -> FloatArray | None:
    """Derivatives of the simulation by z behind those known, float[parameters, sensors, rows]."""
    columns = np.zeros((len(z) - known, *simulated.T.shape))
    for number, along in enumerate(np.eye(len(z))[known:]):
        ahead = simulate(z + STEP * along)
        if ahead is None:
            return None
        columns[number] = (ahead - simulated).T / STEP
    return columns


def _impossible(problem: Problem, hypotheses: Sequence[Hypothesis], z: FloatArray) -> Fit:
    signatures = np.zeros((len(z), *problem.simulated.T.shape))
    return Fit(tuple(hypotheses), z, problem.simulated, signatures, np.eye(len(z)), -np.inf)
