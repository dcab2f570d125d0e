"""Scatter: members, gains and patterns that are not quite as modelled, as random effects."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from rga.diagnosis.covariance import Covariance
from rga.diagnosis.data import Data
from rga.model.effects.stiffness import MemberStiffness
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

STEP = 1e-3
#: most patterns of a channel, and of all channels together
PATTERNS, ALL_PATTERNS = 8, 320
OUTSTANDING = 3.0
APART = 10.0
ROUNDS = 3
#: prior spread of the mean and of the trend of a pattern of unknown origin [its own deviation]
FACTOR_MEAN = 3.0


@dataclass(frozen=True)
class Level:
    """What is known beforehand of the level of a family of random effects.

    Attributes:
        median, spread: of its log-normal prior [-].
        largest: level beyond which it is no scatter any more [-].
    """

    median: float
    spread: float
    largest: float


#: as-built scatter of EA; gains of the channels; what a linear structure may do otherwise
LEVELS = (Level(0.025, 0.4, 0.08), Level(0.01, 0.5, 0.04), Level(0.003, 1.0, 0.03))
MEDIANS = np.array([level.median for level in LEVELS])
SPREADS = np.array([level.spread for level in LEVELS])
BOUNDS = [(float(np.log(level.median / 20)), float(np.log(level.largest))) for level in LEVELS]


@dataclass(frozen=True)
class Scatter:
    """Random effects.

    Attributes:
        columns: derivatives by each of them, float[rows, sensors, effects].
        family: of each: 0 members, 1 gains, 2 patterns; -1 those with a spread of their own.
        fixed: prior standard deviation of those of family -1.
    """

    columns: FloatArray
    family: NDArray[np.int64]
    fixed: FloatArray

    def spread(self, levels: FloatArray) -> FloatArray:
        """Standard deviation of each random effect at levels of the families."""
        return np.where(self.family < 0, self.fixed, levels[self.family])


def scatter_effects(
    simulator: Simulator,
    data: Data,
    simulated: FloatArray,
    basis: FloatArray,
    factors: FloatArray,
) -> Scatter:
    """Derivatives by all random effects about a simulation.

    Args:
        simulator: the simulation.
        data: the readings.
        simulated: float[rows, sensors].
        basis: load coefficients, float[rows, patterns].
        factors: patterns of unknown origin; their mean and their trend are random effects too.
    """
    rows, sensors = simulated.shape
    columns: list[FloatArray] = []
    family: list[int] = []
    for member in simulator.model.members:
        scatter = MemberStiffness(member=member, factor=float(np.exp(STEP)))
        changed = data.predict(simulator.extended({"scatter": scatter}))
        columns.append((changed - simulated) / STEP)
        family.append(0)
    size = np.sqrt((simulated**2).mean(0))
    patterns = basis[:, : min(PATTERNS, max(2, ALL_PATTERNS // sensors))]
    for sensor in range(sensors):
        shapes = [simulated[:, sensor], *(size[sensor] * patterns.T)]
        for number, shape in enumerate(shapes):
            alone = np.zeros((rows, sensors))
            alone[:, sensor] = shape
            columns.append(alone)
            family.append(min(number, 1) + 1)
    fixed = [0.0] * len(columns)
    clock = data.time - data.time.mean()
    for factor in factors.T:
        for course in (np.ones(rows), clock / max(float(clock.std()), 1e-12)):
            columns.append(course[:, None] * factor)
            family.append(-1)
            fixed.append(FACTOR_MEAN)
    for name, direction, spread in lines(data):
        low, high = simulator.model.context[name].range
        step = 0.1 * STEP * (high - low) / np.abs(direction).max()
        value = data.belief.table[name]
        ahead = data.predict(simulator, {name: value + step * direction})
        behind = data.predict(simulator, {name: value - step * direction})
        columns.append((ahead - behind) / (2 * step))
        family.append(-1)
        fixed.append(spread)
    seen = np.where(data.observed[:, :, None], np.stack(columns, axis=2), 0.0)
    return Scatter(seen, np.array(family), np.array(fixed))


def lines(data: Data) -> list[tuple[str, FloatArray, float]]:
    """Directions in which the lines of latent contexts may move, with their prior spread."""
    clock = data.time - data.belief.middle
    return [
        (name, direction, spread)
        for name, (level, slope) in data.belief.lines.items()
        for direction, spread in ((np.ones(len(clock)), level), (clock, slope))
        if spread > 0
    ]


def scatter_levels(
    covariance: Covariance, scatter: Scatter, residual: FloatArray, start: FloatArray
) -> FloatArray:
    """Levels of the families, at the maximum of their posterior.

    A random effect that stands out of its family is left out of the estimate: it may be the effect
    that is looked for, and must not raise the level that it has to stand out of.
    """
    score = covariance.reduce(residual[:, :, None])[1][:, 0]
    apart = np.zeros(len(scatter.family), dtype=bool)
    levels = start
    for _ in range(ROUNDS):
        levels = _most_likely(covariance, scatter, score, levels, apart)
        spread = scatter.spread(levels) * np.where(apart, APART, 1.0)
        estimate = covariance.with_spread(spread).scatter_estimate(residual)
        stands_out = np.abs(estimate) > OUTSTANDING * scatter.spread(levels)
        stands_out &= scatter.family >= 0
        if not (stands_out & ~apart).any():
            break
        apart |= stands_out
    return levels


def level_evidence(
    covariance: Covariance, scatter: Scatter, residual: FloatArray, start: FloatArray
) -> float:
    """Log likelihood of a residual with the levels that suit it best, up to a constant.

    An effect that is not in the simulation raises the scatter that a record seems to have. What it
    gains by lowering that again belongs to its evidence.
    """
    reduced = covariance.reduce(residual[:, :, None])
    score = reduced[1][:, 0]
    levels = _most_likely(covariance, scatter, score, start, np.zeros(len(score), dtype=bool))
    own = float((reduced[0].white ** 2).sum() - (reduced[0].context ** 2).sum())
    gained = covariance.with_spread(scatter.spread(levels)).log_likelihood(score)
    return gained - 0.5 * own - 0.5 * float(_surprise(levels))


def _most_likely(
    covariance: Covariance,
    scatter: Scatter,
    score: FloatArray,
    start: FloatArray,
    apart: NDArray[np.bool_],
) -> FloatArray:
    def loss(logs: FloatArray) -> float:
        levels = np.exp(logs)
        spread = scatter.spread(levels) * np.where(apart, APART, 1.0)
        return float(0.5 * _surprise(levels) - covariance.with_spread(spread).log_likelihood(score))

    inside = np.clip(np.log(start), *np.transpose(BOUNDS))
    options = {"xatol": 0.03, "fatol": 0.1}
    found = minimize(loss, inside, method="Nelder-Mead", bounds=BOUNDS, options=options)
    return np.asarray(np.exp(found.x))


def _surprise(levels: FloatArray) -> float:
    return float((((np.log(levels) - np.log(MEDIANS)) / SPREADS) ** 2).sum())
