"""A record about a simulation: the residual, its derivatives and its covariance."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from rga.diagnosis.covariance import Covariance, Noise, RowCovariance
from rga.diagnosis.data import Data
from rga.diagnosis.noise import estimate_noise, unexplainable
from rga.model.effects.stiffness import MemberStiffness
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

STEP = 1e-3


@dataclass(frozen=True)
class ScatterLevel:
    """A family of random effects with a level that the record has to tell.

    Attributes:
        median, spread: log-normal prior of the level [-].
        largest: level beyond which it is no scatter any more [-].
    """

    median: float
    spread: float
    largest: float


#: as-built scatter of EA; gains of the channels; what a linear structure may do otherwise
LEVELS = (
    ScatterLevel(0.025, 0.4, 0.08),
    ScatterLevel(0.01, 0.5, 0.04),
    ScatterLevel(0.003, 1.0, 0.03),
)
PATTERNS = 8
OUTSTANDING = 3.0
APART = 10.0


@dataclass(frozen=True)
class Problem:
    """A record about a simulation.

    Attributes:
        data: the readings.
        simulator: the simulation, with the effects accepted so far.
        simulated: float[rows, sensors].
        shift: what the contexts' prior adds to the simulation, float[rows, sensors].
        covariance: of the residual.
        noise: of sensors and contexts.
        levels: of the scatter: members, gains, patterns.
        factors: patterns over the sensors that vary from row to row for reasons unknown,
            float[sensors, factors].
    """

    data: Data
    simulator: Simulator
    simulated: FloatArray
    shift: FloatArray
    covariance: Covariance
    noise: Noise
    levels: FloatArray
    factors: FloatArray

    def residual(self, simulated: FloatArray) -> FloatArray:
        """Readings less a simulation, zero where missing, float[rows, sensors]."""
        return np.where(self.data.observed, self.data.readings - simulated - self.shift, 0.0)

    def explained_by_scatter(self, residual: FloatArray) -> FloatArray:
        """The part of a residual that scatter and contexts take up, float[rows, sensors]."""
        scatter = self.covariance.scatter @ self.covariance.scatter_estimate(residual)
        rows = self.covariance.rows
        error = rows.context_error(residual - scatter)
        return np.asarray(scatter + np.einsum("tsi,ti->ts", rows.context_jacobian, error))


def pose(
    simulator: Simulator,
    data: Data,
    before: Problem | None = None,
    factors: FloatArray | None = None,
) -> Problem:
    """Linearise a record about a simulation, and estimate noise and scatter.

    Args:
        simulator: the simulation with its effects.
        data: the readings with the belief of the contexts.
        before: an earlier problem on the same data, to start the estimates from.
        factors: patterns over the sensors that vary for reasons unknown, float[sensors, factors].
    """
    belief = data.belief
    simulated = data.predict(simulator)
    jacobian = context_jacobian(simulator, data, simulated)
    offsets = (
        np.stack([belief.centre[n] - belief.table[n] for n in belief.spread], axis=-1)
        if (belief.spread)
        else np.zeros((len(data.time), 0))
    )
    shift = np.einsum("tsi,ti->ts", jacobian, offsets)
    if factors is None:
        factors = before.factors if before is not None else np.zeros((len(data.sensors), 0))
    unknown = np.where(data.observed[:, :, None], factors, 0.0)
    jacobian = np.concatenate([jacobian, unknown], axis=2)
    residual = np.where(data.observed, data.readings - simulated - shift, 0.0)

    basis = load_basis(simulator, data)
    left = unexplainable(residual, data.observed, basis)
    scale = np.sqrt((left**2).sum(0) / np.maximum(data.observed.sum(0), 1))
    stated = np.array([simulator.model.sensors[name].noise or 0.0 for name in data.sensors])
    floor = np.maximum(0.3 * stated, 1e-9 + 1e-4 * np.abs(simulated).max(0, initial=0.0))
    start = Noise(
        sigma=np.maximum(scale, floor),
        phi=np.full(len(data.sensors), 0.3),
        context_sigma=np.array([*belief.spread.values(), *np.ones(factors.shape[1])]),
    )
    if before is not None and len(before.noise.context_sigma) == len(start.context_sigma):
        start = before.noise
    unknown_spread = [False] * factors.shape[1]
    known = np.array([n in belief.known for n in belief.spread] + unknown_spread, dtype=bool)
    noise = estimate_noise(left, data.time, data.observed, jacobian, start, known, floor)
    rows = RowCovariance(noise, data.time, data.observed, jacobian)
    scatter, family, fixed = scatter_effects(simulator, data, simulated, basis)
    scatter = np.where(data.observed[:, :, None], scatter, 0.0)
    levels = before.levels if before is not None else np.array([level.median for level in LEVELS])
    covariance = Covariance(rows, scatter, np.where(family < 0, fixed, levels[family]))
    levels = scatter_levels(covariance, residual, family, fixed, levels)
    covariance = covariance.with_spread(np.where(family < 0, fixed, levels[family]))
    return Problem(data, simulator, simulated, shift, covariance, noise, levels, factors)


def context_jacobian(simulator: Simulator, data: Data, simulated: FloatArray) -> FloatArray:
    """Derivatives by the contexts that are uncertain row by row, float[rows, sensors, contexts]."""
    belief = data.belief
    columns = []
    for name in belief.spread:
        low, high = simulator.model.context[name].range
        step = STEP * (high - low)
        ahead = data.predict(simulator, {name: belief.table[name] + step})
        behind = data.predict(simulator, {name: belief.table[name] - step})
        columns.append((ahead - behind) / (2 * step))
    if not columns:
        return np.zeros((*simulated.shape, 0))
    return np.where(data.observed[:, :, None], np.stack(columns, axis=2), 0.0)


def load_basis(simulator: Simulator, data: Data) -> FloatArray:
    """Load coefficients in the order of their variance, float[rows, patterns], scaled to one."""
    coefficients = simulator.load_coefficients(data.belief.table)
    peak = np.abs(coefficients).max(0, initial=0.0)
    scaled = coefficients[:, peak > 0] / peak[peak > 0]
    if scaled.shape[1] == 0:
        return np.zeros((len(data.time), 0))
    u, s, _ = np.linalg.svd(scaled, full_matrices=False)
    kept = s > 1e-6 * s[0]
    return np.asarray(u[:, kept] * np.sqrt(len(u)))


def scatter_effects(
    simulator: Simulator, data: Data, simulated: FloatArray, basis: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Derivatives by all random effects, the family of each, and the spread of those without.

    Families: 0 members, 1 gains of channels, 2 patterns of channels; -1 lines of latent contexts.
    """
    rows, sensors = simulated.shape
    columns: list[FloatArray] = []
    family: list[int] = []
    fixed: list[float] = []
    for member in simulator.model.members:
        scatter = MemberStiffness(member=member, factor=float(np.exp(STEP)))
        changed = data.predict(simulator.extended({"scatter": scatter}))
        columns.append((changed - simulated) / STEP)
        family.append(0)
    size = np.sqrt((simulated**2).mean(0))
    patterns = basis[:, :PATTERNS]
    for sensor in range(sensors):
        gain = np.zeros((rows, sensors))
        gain[:, sensor] = simulated[:, sensor]
        columns.append(gain)
        family.append(1)
        for pattern in patterns.T:
            other = np.zeros((rows, sensors))
            other[:, sensor] = size[sensor] * pattern
            columns.append(other)
            family.append(2)
    fixed = [0.0] * len(columns)
    clock = data.time - data.belief.middle
    for name, (level, slope) in data.belief.lines.items():
        low, high = simulator.model.context[name].range
        for direction, spread in ((np.ones(rows), level), (clock, slope)):
            if spread > 0:
                step = STEP * (high - low) * 0.1 / np.abs(direction).max()
                value = data.belief.table[name]
                ahead = data.predict(simulator, {name: value + step * direction})
                behind = data.predict(simulator, {name: value - step * direction})
                columns.append((ahead - behind) / (2 * step))
                family.append(-1)
                fixed.append(spread)
    return np.stack(columns, axis=2), np.array(family), np.array(fixed)


def scatter_levels(
    covariance: Covariance,
    residual: FloatArray,
    family: FloatArray,
    fixed: FloatArray,
    start: FloatArray,
) -> FloatArray:
    """Levels of the families of random effects, at the maximum of their posterior.

    A random effect that stands out of its family is left out of the estimate: it may be the effect
    that is looked for, and must not raise the level that it has to stand out of.
    """
    score = covariance.reduce(residual[:, :, None])[1][:, 0]
    medians = np.array([level.median for level in LEVELS])
    spreads = np.array([level.spread for level in LEVELS])
    bounds = [(np.log(level.median / 20), np.log(level.largest)) for level in LEVELS]
    apart = np.zeros(len(family), dtype=bool)
    levels = start

    def spread_at(levels: FloatArray) -> FloatArray:
        spread = np.where(family < 0, fixed, levels[family])
        return np.where(apart, APART * spread, spread)

    def loss(logs: FloatArray) -> float:
        prior = (((logs - np.log(medians)) / spreads) ** 2).sum()
        return float(
            0.5 * prior - covariance.with_spread(spread_at(np.exp(logs))).log_likelihood(score)
        )

    for _ in range(3):
        options = {"xatol": 0.03, "fatol": 0.1}
        inside = np.clip(np.log(levels), *np.transpose(bounds))
        levels = np.exp(
            minimize(loss, inside, method="Nelder-Mead", bounds=bounds, options=options).x
        )
        trial = covariance.with_spread(spread_at(levels))
        stands_out = np.abs(trial.scatter_estimate(residual)) / levels[family] > OUTSTANDING
        stands_out &= family >= 0
        if not (stands_out & ~apart).any():
            break
        apart |= stands_out
    return np.asarray(levels)


def relaxed(problem: Problem) -> Data:
    """The data with the latent contexts moved to where the residual puts them."""
    data, belief = problem.data, problem.data.belief
    if not belief.lines and not belief.latent:
        return data
    residual = problem.residual(problem.simulated)
    estimate = problem.covariance.scatter_estimate(residual)
    scatter = problem.covariance.scatter @ estimate
    changes = {}
    number = len(estimate) - sum((s > 0) for pair in belief.lines.values() for s in pair)
    clock = data.time - belief.middle
    for name, (level, slope) in belief.lines.items():
        moved = np.zeros(len(clock))
        for direction, spread in ((np.ones(len(clock)), level), (clock, slope)):
            if spread > 0:
                moved += estimate[number] * direction
                number += 1
        changes[name] = belief.table[name] + moved
    error = problem.covariance.rows.context_error(residual - scatter)
    for column, name in enumerate(belief.spread):
        if name in belief.latent:
            changes[name] = belief.centre[name] + error[:, column]
    return replace(data, belief=belief.with_values(changes))
