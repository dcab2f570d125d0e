"""The evidence for hypotheses: fits on the real model, and Laplace's approximation.

For parameters theta(z) with z standard normal a priori, the log evidence against no effect is

    1/2 (r0' C^-1 r0 - r' C^-1 r - z' z - log det(I + S' C^-1 S)) + log prior

at the most likely z, with r the residual and S = d simulation / d z there (Laplace; MacKay 2003,
chapter 27). Kinds, places and onsets enter through the prior, so that many hypotheses do not make
one of them likely.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.noise.covariance import Reduced
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.linearised import Problem
from rga.errors import InputError
from rga.model.effect import Effect
from rga.simulation import Simulator

STEP = 1e-3
STEPS = 12
#: points at which a cheap simulation is put right at most, and how far a step there is shortened
CORRECTED = 3
#: bounds of z, of a step in z, of how often a step is shortened, and of the loss worth a step
FARTHEST, LONGEST, SHORTENED, ENOUGH = 8.0, 2.0, 6, 1e-3
#: numbers in the simulations of fits that are moved together
REFITTED = 1 << 18


@dataclass(frozen=True, eq=False)
class Fit:
    """Hypotheses fitted together.

    Attributes:
        problem: that they were fitted to.
        hypotheses: those fitted.
        z: standard normal coordinates of all parameters, in their order, float[parameters].
        simulated: float[rows, sensors].
        signatures: S, derivatives by z, float[parameters, sensors, rows].
        information: I + S' C^-1 S, float[parameters, parameters].
        log_evidence: against no effect at all.
        exact: False where the simulation leaves out what effects do to each other.
        without: fits of some of the hypotheses, once known, by problem, simulator and numbers of
            those left out.
        alternatives: what could stand in the place of each, once known, by problem, simulator,
            screening and number.
    """

    problem: Problem
    hypotheses: tuple[Hypothesis, ...]
    z: FloatArray
    simulated: FloatArray
    signatures: FloatArray
    information: FloatArray
    log_evidence: float
    exact: bool = True
    without: "dict[tuple[Problem, Simulator, tuple[int, ...]], Fit]" = field(
        default_factory=dict, init=False, repr=False
    )
    alternatives: "dict[tuple[Problem, Simulator, object, int], list[Alternative]]" = field(
        default_factory=dict, init=False, repr=False
    )
    _simulators: dict[Simulator, Simulator] = field(default_factory=dict, init=False, repr=False)

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


@dataclass(frozen=True)
class Alternative:
    """A hypothesis that could stand in the place of a cause, fitted beside the other causes.

    Attributes:
        hypothesis: itself.
        fit: the other causes and the hypothesis.
        behind: log-odds of the causes against it.
    """

    hypothesis: Hypothesis
    fit: Fit
    behind: float


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
    exactly: bool = True,
) -> Fit:
    """The most likely parameters of hypotheses together, by Gauss-Newton steps on the real model.

    Args:
        problem: gives residual and covariance.
        base: the simulator without the hypotheses.
        hypotheses: fitted together.
        start: coordinates to begin with.
        beside: a fit of hypotheses that stand first among these: they move along its signatures,
            which costs less than to simulate them anew.
        exactly: False where what `Vicinity.nearly` gives will do.

    Returns:
        The fit; its log evidence is minus infinity where the model cannot be simulated.
    """
    data = problem.data
    known = 0 if beside is None else len(beside.z)
    about = data.about(base if beside is None else beside.simulator(base))
    added = hypotheses if beside is None else hypotheses[len(beside.hypotheses) :]

    def effects(z: FloatArray) -> dict[str, Effect]:
        return effects_at(added, z[known:], len(hypotheses))

    def with_known(simulated: FloatArray, z: FloatArray) -> FloatArray:
        if beside is None or not known:
            return simulated
        return np.asarray(simulated + np.tensordot(z[:known] - beside.z, beside.signatures, 1).T)

    z = np.array(start, dtype=float)
    try:
        nearly, exact = data.nearly(about, effects(z))
        final = exact or not exactly
        there = nearly if final else data.tried(about, effects(z))
    except InputError:
        return _impossible(problem, hypotheses, z)
    # What the cheap simulation misses is put right at every point that it leads to.
    missed = there - nearly

    def simulate(z: FloatArray) -> FloatArray | None:
        try:
            return with_known(data.nearly(about, effects(z))[0] + missed, z)
        except InputError:
            return None

    def corrected(z: FloatArray) -> _Point | None:
        try:
            return _Point.of(problem, z, with_known(data.tried(about, effects(z)), z))
        except InputError:
            return None

    here = _Point.of(problem, z, with_known(there, z))
    signatures = None if beside is None else beside.signatures
    for _ in range(CORRECTED):
        reached = _descended(problem, simulate, here, signatures)
        if reached is None:
            return _impossible(problem, hypotheses, z)
        nearest, columns, information = reached
        if final:
            here = nearest
            break
        lower = _lower(here, np.asarray(nearest.z - here.z), corrected, CORRECTED)
        if lower is None:
            break
        nearly = with_known(data.nearly(about, effects(lower.z))[0], lower.z)
        missed, gained, here = lower.simulated - nearly, here.loss - lower.loss, lower
        if gained < ENOUGH:
            break
    known_exactly = exact or exactly
    fitted, simulated = tuple(hypotheses), here.simulated
    found = Fit(problem, fitted, here.z, simulated, columns, information, 0.0, known_exactly)
    return _weighed(base, found, here.loss)


@dataclass(frozen=True)
class _Point:
    """Coordinates, the simulation there, and its residual with what it costs."""

    z: FloatArray
    simulated: FloatArray
    residual: Reduced
    loss: float

    @classmethod
    def of(cls, problem: Problem, z: FloatArray, simulated: FloatArray) -> "_Point":
        residual = problem.covariance.reduce(problem.residual(simulated).T[None])
        loss = float(problem.covariance.squares(residual)[0] + z @ z)
        return cls(z, simulated, residual, loss)


def _descended(
    problem: Problem,
    simulate: Callable[[FloatArray], FloatArray | None],
    here: _Point,
    known: FloatArray | None,
) -> tuple[_Point, FloatArray, FloatArray] | None:
    """Gauss-Newton steps of a simulation: where they end, with signatures and information there.

    Args:
        problem: gives residual and covariance.
        simulate: by coordinates; None where it cannot be.
        here: to start from.
        known: signatures of the first coordinates; None: of none.

    Returns:
        None where there is no derivative.
    """
    covariance, count = problem.covariance, len(here.z)
    given = np.zeros((0, *here.simulated.T.shape)) if known is None else known
    if not count:
        return here, given, np.eye(0)

    def point(z: FloatArray) -> _Point | None:
        simulated = simulate(z)
        return None if simulated is None else _Point.of(problem, z, simulated)

    for step in range(STEPS + 1):
        columns = _signatures(simulate, here, len(given))
        if columns is None:
            return None
        signatures = np.concatenate([given, columns])
        reduced = covariance.reduce(signatures)
        information = covariance.product(reduced, reduced) + np.eye(count)
        if step == STEPS:
            break
        slope = covariance.product(reduced, here.residual)[:, 0] - here.z
        move = np.linalg.solve(information, slope)
        promised = float(move @ slope)
        if promised < ENOUGH:
            break
        length = min(1.0, LONGEST / max(np.abs(move).max(), 1e-12))
        lower = _lower(here, np.asarray(length * move), point, SHORTENED)
        if lower is None:
            break
        gained, here = here.loss - lower.loss, lower
        # A whole step that gains what it promised has met no curvature: it leads to the end.
        if gained < ENOUGH or (length == 1.0 and abs(gained - promised) < ENOUGH):
            break
    return here, signatures, information


def refit(problem: Problem, base: Simulator, fits: Sequence[Fit]) -> list[Fit]:
    """Fits moved to where another covariance of the same record puts them, along their signatures.

    Args:
        problem: the same data and simulation, channels or noise taken otherwise.
        base: the simulator without the hypotheses.
        fits: as they were fitted.
    """
    together = max(1, REFITTED // problem.data.readings.size)
    found: list[Fit] = []
    for first in range(0, len(fits), together):
        found += _refitted(problem, base, fits[first : first + together])
    return found


def _refitted(problem: Problem, base: Simulator, fits: Sequence[Fit]) -> list[Fit]:
    residuals = np.stack([problem.residual(one.simulated).T for one in fits])
    columns = np.concatenate([residuals, *(one.signatures for one in fits)])
    reduced = problem.covariance.reduce(columns)
    products = problem.covariance.product(reduced, reduced)
    found = []
    for number, (one, own) in enumerate(zip(fits, _places(fits), strict=True)):
        move, information, loss = _moved(products, number, own, one.z)
        simulated = one.simulated
        if len(move):
            simulated = simulated + np.tensordot(move, one.signatures, 1).T
        moved = replace(
            one, problem=problem, z=one.z + move, simulated=simulated, information=information
        )
        found.append(_weighed(base, moved, loss))
    return found


def evidence_without(problem: Problem, fits: Sequence[Fit], cells: IntArray) -> FloatArray:
    """Log evidences of fits where some readings are unseen, up to a constant of them all.

    A reading that is unseen has a free error: by Schur's complement it leaves the products.

    Args:
        problem: to which they were fitted.
        fits: as they were fitted; they move along their signatures.
        cells: row and sensor of each reading, none of them missing, int[k, 2].

    Returns:
        float[fits].
    """
    residuals = np.stack([problem.residual(one.simulated).T for one in fits])
    unseen = np.zeros((len(cells), *residuals.shape[1:]))
    unseen[np.arange(len(cells)), cells[:, 1], cells[:, 0]] = 1.0
    columns = np.concatenate([residuals, *(one.signatures for one in fits), unseen])
    reduced = problem.covariance.reduce(columns)
    products = problem.covariance.product(reduced, reduced)
    seen, gone = np.split(np.arange(len(products)), [len(products) - len(cells)])
    told = np.linalg.solve(products[np.ix_(gone, gone)], products[np.ix_(gone, seen)])
    products = products[np.ix_(seen, seen)] - products[np.ix_(seen, gone)] @ told
    found = []
    for number, (one, own) in enumerate(zip(fits, _places(fits), strict=True)):
        _, information, loss = _moved(products, number, own, one.z)
        priors = sum(each.log_prior for each in one.hypotheses)
        found.append(priors - 0.5 * (loss + float(np.linalg.slogdet(information)[1])))
    return np.array(found)


def _places(fits: Sequence[Fit]) -> list[slice]:
    """Where the signatures of each fit stand behind the residuals of all."""
    ends = len(fits) + np.cumsum([0, *(len(one.z) for one in fits)])
    return [slice(int(first), int(end)) for first, end in pairwise(ends)]


def _moved(
    products: FloatArray, number: int, own: slice, z: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    """The step to where products put a fit, the information there, and the loss."""
    along = products[own, number] - z
    information = products[own, own] + np.eye(len(z))
    move = np.linalg.solve(information, along)
    move *= min(1.0, LONGEST / max(np.abs(move).max(initial=0.0), 1e-12))
    loss = float(products[number, number] + z @ z)
    loss += float(move @ information @ move - 2 * move @ along)
    return np.asarray(move), information, loss


def _weighed(base: Simulator, one: Fit, loss: float) -> Fit:
    """The fit with its log evidence, its loss known."""
    problem = one.problem
    if base not in problem.at_nothing:
        nothing = problem.residual(problem.data.predict(base)).T[None]
        squares = problem.covariance.squares(problem.covariance.reduce(nothing))
        problem.at_nothing[base] = float(squares[0])
    freedom = float(np.linalg.slogdet(one.information)[1])
    log_evidence = 0.5 * (problem.at_nothing[base] - loss - freedom)
    log_evidence += sum(each.log_prior for each in one.hypotheses)
    return replace(one, log_evidence=log_evidence)


def _lower(
    here: _Point, move: FloatArray, point: Callable[[FloatArray], _Point | None], shortened: int
) -> _Point | None:
    """A point of less loss on the way of a move, or None where even a short one has more."""
    for _ in range(shortened):
        there = point(np.clip(here.z + move, -FARTHEST, FARTHEST))
        if there is not None and there.loss < here.loss:
            return there
        move = np.asarray(move / 3)
    return None


def _signatures(
    simulate: Callable[[FloatArray], FloatArray | None], here: _Point, known: int
) -> FloatArray | None:
    """Derivatives of a simulation by z behind those known, float[parameters, sensors, rows]."""
    columns = np.zeros((len(here.z) - known, *here.simulated.T.shape))
    for number, along in enumerate(np.eye(len(here.z))[known:]):
        ahead = simulate(here.z + STEP * along)
        if ahead is None:
            return None
        columns[number] = (ahead - here.simulated).T / STEP
    return columns


def _impossible(problem: Problem, hypotheses: Sequence[Hypothesis], z: FloatArray) -> Fit:
    signatures = np.zeros((len(z), *problem.simulated.T.shape))
    nowhere = problem.simulated
    return Fit(problem, tuple(hypotheses), z, nowhere, signatures, np.eye(len(z)), -np.inf)
