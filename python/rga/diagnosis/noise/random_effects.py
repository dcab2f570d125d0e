"""Scatter: members, gains and patterns that are not quite as modelled, as random effects."""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.noise.covariance import Covariance, RandomEffects
from rga.model.effects.members.member_stiffness import MemberStiffness
from rga.numerics.decompositions import thin_svd
from rga.simulation import Simulator

#: difference of a derivative, in the logarithm of a stiffness: above rounding, below curvature
STEP = 1e-3
#: most patterns of a channel, and of all channels together
PATTERNS, ALL_PATTERNS = 8, 320
#: levels of its family beyond which an effect stands out (three in a thousand do by chance), by how
#: much its own spread is then larger, which frees it, and rounds in which such effects are sought
OUTSTANDING, APART, ROUNDS = 3.0, 10.0, 3
#: prior spread of how a pattern of unknown origin follows time and loads [its own deviation]
FACTOR_MEAN = 3.0
#: slow courses that such a pattern may follow
WAVES = 8
#: share of an effect that may be left out of its courses
EXACT = 1e-7


@dataclass(frozen=True)
class Level:
    """The prior of the level of a family of random effects.

    Attributes:
        median, spread: of its log-normal prior [-].
        largest: level beyond which it is no scatter any more [-].
    """

    median: float
    spread: float
    largest: float


#: as-built scatter of EA; gains of the channels; what a linear structure may do otherwise: the
#: medians are a half to a third of what is plausible (`fit` of the criteria), the largest lie above
LEVELS = (Level(0.025, 0.4, 0.08), Level(0.01, 0.5, 0.04), Level(0.003, 1.0, 0.03))
#: the same as arrays; logarithms of the levels stay within bounds from a twentieth of the median on
MEDIANS = np.array([level.median for level in LEVELS])
SPREADS = np.array([level.spread for level in LEVELS])
BOUNDS = [(float(np.log(level.median / 20)), float(np.log(level.largest))) for level in LEVELS]


@dataclass(frozen=True)
class Scatter:
    """Random effects.

    Attributes:
        effects: derivatives by each of them.
        family: of each: 0 members, 1 gains, 2 patterns; -1 those with a spread of their own.
        channel: number of the channel that gains and patterns are of, int[effects]; -1: of none.
        fixed: prior standard deviation of those of family -1.
    """

    effects: RandomEffects
    family: NDArray[np.int64]
    channel: NDArray[np.int64]
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
    calibrations: list[tuple[FloatArray, float]],
) -> Scatter:
    """Derivatives by all random effects about a simulation.

    Args:
        simulator: the simulation.
        data: the readings.
        simulated: float[rows, sensors].
        basis: load coefficients, float[rows, patterns].
        factors: patterns of unknown origin; that they follow the loads, or change slowly, are
            random effects too.
        calibrations: further random effects, float[rows, sensors], with their prior spread.
    """
    sensors = simulated.shape[1]
    size = np.sqrt((simulated**2).mean(0))
    patterns = basis[:, : min(PATTERNS, max(2, ALL_PATTERNS // sensors))]
    clock = data.time - data.time.mean()
    waves = np.cos(np.pi * np.arange(1, WAVES + 1) * (clock - clock[0])[:, None] / np.ptp(clock))
    drift = np.column_stack([np.ones(len(clock)), waves, patterns])
    members = _by_members(simulator, data, simulated)
    moved = _by_lines(simulator, data)
    # What the zero is off stays as it is over all rows.
    constant = np.ones((len(clock), 1 if len(data.tare) else 0))
    known = [basis, constant, *([drift] if factors.size else [])]
    of_contexts = [change for change, _ in calibrations]
    own_spread = [*calibrations, *zip(moved, (spread for *_, spread in lines(data)), strict=True)]
    # Each as large as it may be: units differ by many powers of ten.
    sizes = [MEDIANS[0] * change for change in members] + [s * change for change, s in own_spread]
    courses = _courses(np.hstack(known), [simulated, *sizes])

    def share(history: FloatArray) -> FloatArray:
        return np.asarray(courses.T @ history)

    own = np.zeros((sensors, 1 + patterns.shape[1], sensors, courses.shape[1]))
    every = np.arange(sensors)
    own[every, 0, every] = share(simulated).T
    own[every, 1:, every] = size[:, None, None] * share(patterns).T
    shares = [
        *(share(change).T for change in members),
        *own.reshape(sensors * own.shape[1], *own.shape[2:]),
        *(share(change).T for change in of_contexts),
        *(np.outer(factor, share(history)) for factor in factors.T for history in drift.T),
        *(share(change).T for change in moved),
    ]
    of_channel = [1, *[2] * patterns.shape[1]]
    family = [0] * len(members) + of_channel * sensors
    fixed = [spread for _, spread in calibrations]
    fixed += [FACTOR_MEAN] * (drift.shape[1] * factors.shape[1])
    fixed += [spread for *_, spread in lines(data)]
    return Scatter(
        RandomEffects(courses, np.stack(shares)),
        np.array(family + [-1] * len(fixed)),
        np.array(
            [-1] * len(members)
            + [number for number in range(sensors) for _ in of_channel]
            + [-1] * len(fixed)
        ),
        np.array([0.0] * len(family) + fixed),
    )


def _by_members(simulator: Simulator, data: Data, simulated: FloatArray) -> list[FloatArray]:
    """Derivatives by the stiffness of every member, float[rows, sensors] each."""
    about = data.about(simulator)
    rates = about.stiffness_rates()
    found = []
    for number, member in enumerate(simulator.model.members):
        if number in rates:
            moved = about.response.quantities + STEP * rates[number]
            changed = data.read(simulator, replace(about.response, quantities=moved))
        else:
            scatter = MemberStiffness(member=member, factor=float(np.exp(STEP)))
            changed, _ = data.nearly(about, {"scatter": scatter})
        found.append((changed - simulated) / STEP)
    return found


def _by_lines(simulator: Simulator, data: Data) -> list[FloatArray]:
    """Derivatives along the `lines`, float[rows, sensors] each."""
    found = []
    for name, direction, _ in lines(data):
        low, high = simulator.model.context[name].range
        step = 0.1 * STEP * (high - low) / np.abs(direction).max()
        value = data.belief.table[name]
        ahead = data.predict(simulator, {name: value + step * direction})
        behind = data.predict(simulator, {name: value - step * direction})
        found.append((ahead - behind) / (2 * step))
    return found


def _courses(known: FloatArray, changes: list[FloatArray]) -> FloatArray:
    """Orthonormal courses over the rows that all changes are sums of, float[rows, courses].

    Args:
        known: courses that are expected, float[rows, k]: those of the loads.
        changes: float[rows, sensors] each.
    """
    squares = np.mean([(change**2).mean(0) for change in changes], axis=0)
    scale = np.where(squares > 0, np.sqrt(squares), 1.0)
    together = np.hstack([change / scale for change in changes])
    courses = _orthonormal(known)
    rest = together - courses @ (courses.T @ together)
    if _largest(rest) > EXACT * _largest(together):
        rest -= courses @ (courses.T @ rest)
        values, vectors = np.linalg.eigh(rest @ rest.T)
        further = vectors[:, values > EXACT**2 * (together**2).sum()]
        courses = _orthonormal(np.hstack([courses, further]))
    return courses


def _largest(values: FloatArray) -> float:
    return max(float(values.max()), -float(values.min()))


def _orthonormal(columns: FloatArray) -> FloatArray:
    u, s, _ = thin_svd(columns)
    return np.asarray(u[:, s > 1e-12 * s.max(initial=0.0)])


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
    score = covariance.reduce(residual.T[None]).score[:, 0]
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
    reduced = covariance.reduce(residual.T[None])
    score = reduced.score[:, 0]
    levels = _most_likely(covariance, scatter, score, start, np.zeros(len(score), dtype=bool))
    own = float((reduced.white**2).sum() - (reduced.context**2).sum())
    gained, _ = covariance.with_spread(scatter.spread(levels)).log_likelihood(score)
    return gained - 0.5 * own - 0.5 * float(_surprise(levels))


def _most_likely(
    covariance: Covariance,
    scatter: Scatter,
    score: FloatArray,
    start: FloatArray,
    apart: NDArray[np.bool_],
) -> FloatArray:
    members = np.array([scatter.family == number for number in range(len(LEVELS))])

    def loss(logs: FloatArray) -> tuple[float, FloatArray]:
        levels = np.exp(logs)
        spread = scatter.spread(levels) * np.where(apart, APART, 1.0)
        likelihood, slopes = covariance.with_spread(spread).log_likelihood(score)
        pull = (logs - np.log(MEDIANS)) / SPREADS**2
        return 0.5 * _surprise(levels) - likelihood, pull - members @ slopes

    inside = np.clip(np.log(start), *np.transpose(BOUNDS))
    options = {"ftol": 1e-5, "gtol": 0.05, "maxiter": 20}
    found = scipy.optimize.minimize(
        loss, inside, jac=True, method="L-BFGS-B", bounds=BOUNDS, options=options
    )
    return np.asarray(np.exp(found.x))


def _surprise(levels: FloatArray) -> float:
    return float((((np.log(levels) - np.log(MEDIANS)) / SPREADS) ** 2).sum())
