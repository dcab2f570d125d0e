"""A record about a simulation: the residual, its derivatives and its covariance."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Belief, Data
from rga.diagnosis.noise.covariance import Covariance
from rga.diagnosis.noise.random_effects import (
    MEDIANS,
    Scatter,
    lines,
    scatter_effects,
    scatter_levels,
)
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance
from rga.diagnosis.noise.sensor_noise import estimate_noise
from rga.diagnosis.noise.unexplainable import unexplainable
from rga.diagnosis.noise.zero_errors import slopes_at_zero, zero_errors
from rga.findings.criteria import Criteria
from rga.model.effect import Values
from rga.numerics.decompositions import thin_svd
from rga.simulation import Simulator

#: difference of a derivative by a context, in its range: above rounding, below curvature
STEP = 1e-3
#: share of what is left below which a step or a drift was found that errors of contexts had hidden
ALIKE = 1.0 - 1e-9
#: share of the noise that a sensor keeps beside a shared pattern, at least
LEAST_OWN_NOISE = 0.6
#: how well measured contexts are calibrated: offset in deviations of their noise, and gain [-]
OFFSET, GAIN = 0.3, 0.005
#: share of such a change that the courses of the loads may leave
FOLLOWED = 1e-6
#: a random effect, float[rows, sensors], with its prior spread
Calibration = tuple[FloatArray, float]


@dataclass(frozen=True, eq=False)
class Problem:
    """A record about a simulation.

    Attributes:
        data: the readings.
        simulator: the simulation, with the effects accepted so far.
        given: the simulation without them.
        simulated: float[rows, sensors].
        shift: what the contexts' prior adds to the simulation, float[rows, sensors].
        tails: what heavy tails of the noise add to the readings, float[rows, sensors].
        covariance: of the residual.
        noise: of sensors and contexts.
        zero_variance: what errors of the logger's zero add to every reading of a channel,
            float[sensors].
        scatter: random effects.
        levels: of the families of the scatter: members, gains, patterns [-].
        factors: patterns over the sensors that vary from row to row for reasons unknown,
            float[sensors, factors].
        at_nothing: r' C^-1 r without any cause, by the simulator without causes, once known.
        hiding: the same problem with some channels unseen, by their names, once known.
    """

    data: Data
    simulator: Simulator
    given: Simulator
    simulated: FloatArray
    shift: FloatArray
    tails: FloatArray
    covariance: Covariance
    noise: Noise
    zero_variance: FloatArray
    scatter: Scatter
    levels: FloatArray
    factors: FloatArray
    at_nothing: dict[Simulator, float] = field(default_factory=dict, init=False)
    hiding: dict[tuple[str, ...], "Problem"] = field(default_factory=dict, init=False, repr=False)

    @property
    def criteria(self) -> Criteria:
        """What decides a verdict."""
        return self.data.criteria

    def residual(self, simulated: FloatArray) -> FloatArray:
        """Readings, their tails drawn in, less a simulation, float[rows, sensors].

        Zero where missing.
        """
        return self.whole_residual(simulated) - self.tails

    def whole_residual(self, simulated: FloatArray) -> FloatArray:
        """The same with the tails."""
        return np.where(self.data.observed, self.data.readings - simulated - self.shift, 0.0)

    def with_contexts(self, simulated: FloatArray, by: "Problem | None" = None) -> FloatArray:
        """A simulation with latent contexts where the readings put them beside it.

        Args:
            simulated: about the belief, float[rows, sensors].
            by: the same with some channels unseen, whose readings put them there; None: this one.

        Returns:
            float[rows, sensors].
        """
        shifted, latent, moves = simulated + self.shift, self._latent, len(lines(self.data))
        if not latent and not moves:
            return shifted
        seen = by or self
        covariance = seen.covariance
        residual = seen.residual(simulated)
        estimate = covariance.scatter_estimate(residual)
        error = covariance.rows.context_error(residual - covariance.scatter.at(estimate))
        jacobian = self.covariance.rows.context_jacobian[:, :, latent]
        moved = np.einsum("tsi,ti->ts", jacobian, error[:, latent])
        of_lines = np.arange(len(estimate)) >= len(estimate) - moves
        moved += self.covariance.scatter.at(np.where(of_lines, estimate, 0.0))
        return np.asarray(shifted + moved)

    def unsure_contexts(self, by: "Problem") -> FloatArray:
        """Variance of a simulation by what other channels leave open of latent contexts.

        Args:
            by: the same with some channels unseen.

        Returns:
            float[rows, sensors].
        """
        latent = self._latent
        if not latent:
            return np.zeros(self.simulated.shape)
        left = by.covariance.rows.context_variance()[:, latent][:, :, latent]
        jacobian = self.covariance.rows.context_jacobian[:, :, latent]
        return np.asarray(((jacobian @ left) * jacobian).sum(axis=2))

    @property
    def _latent(self) -> list[int]:
        """Numbers of the uncertain contexts that nothing measures."""
        belief = self.data.belief
        return [number for number, name in enumerate(belief.spread) if name in belief.latent]

    def explained_by_scatter(self, residual: FloatArray) -> FloatArray:
        """The part of a residual that scatter and contexts take up, float[rows, sensors]."""
        scatter = self.covariance.scatter.at(self.covariance.scatter_estimate(residual))
        rows = self.covariance.rows
        error = rows.context_error(residual - scatter)
        return np.asarray(scatter + np.einsum("tsi,ti->ts", rows.context_jacobian, error))


def pose(
    simulator: Simulator,
    data: Data,
    before: Problem | None = None,
    factors: FloatArray | None = None,
    more: Sequence[Calibration] = (),
) -> Problem:
    """Linearise a record about a simulation, and estimate noise and scatter.

    Args:
        simulator: the simulation with its effects.
        data: the readings with the belief of the contexts.
        before: an earlier problem on the same data, to start the estimates from.
        factors: patterns over the sensors that vary for reasons unknown, float[sensors, factors].
        more: further random effects.
    """
    belief = data.belief
    simulated = data.read(simulator, data.about(simulator).response)
    slopes = context_jacobian(simulator, data, simulated)
    jacobian = np.where(data.observed[:, :, None], slopes, 0.0)
    shift = _shift(jacobian, belief)
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
    if factors.shape[1] and before is not None:
        # A pattern of unknown origin must not take all of a sensor's noise for itself.
        floor = np.maximum(floor, LEAST_OWN_NOISE * before.noise.sigma)
    start = Noise(
        sigma=np.maximum(scale, floor),
        phi=np.full(len(data.sensors), 0.3),
        context_sigma=np.array([*belief.spread.values(), *np.ones(factors.shape[1])]),
        deviation=np.maximum(scale, floor),
    )
    if before is not None and len(before.noise.context_sigma) == len(start.context_sigma):
        start = before.noise
    unknown_spread = [False] * factors.shape[1]
    known = np.array([n in belief.known for n in belief.spread] + unknown_spread, dtype=bool)
    noise, tails = estimate_noise(left, data.time, data.observed, jacobian, start, known, floor)
    if jacobian.shape[2]:
        error = RowCovariance(noise, data.time, data.observed, jacobian).context_error(left - tails)
        shared = np.einsum("tsi,ti->ts", jacobian, error)
        beside = unexplainable(residual, data.observed, basis, shared)
        size = noise.deviation
        if ((beside / size) ** 2).sum() < ALIKE * ((left / size) ** 2).sum():
            noise, tails = estimate_noise(
                beside, data.time, data.observed, jacobian, start, known, floor
            )
    residual -= tails
    rows = RowCovariance(noise, data.time, data.observed, jacobian)
    given = simulator if before is None else before.given
    # What a cause does is no pattern that every channel may show a little of.
    patterns = basis if given is simulator else load_basis(given, data)
    errors = zero_errors(simulator, data, noise)
    calibrations = [
        *_calibrations(simulator, data, slopes, noise, patterns),
        *errors.of_rows(len(data.time)),
        *more,
    ]
    scatter = scatter_effects(simulator, data, simulated, patterns, factors, calibrations)
    levels = before.levels if before is not None else MEDIANS
    covariance = Covariance(rows, scatter.effects, scatter.spread(levels))
    if data.scatter is None:
        levels = scatter_levels(covariance, scatter, residual, levels)
    else:
        levels = data.scatter
    covariance = covariance.with_spread(scatter.spread(levels))
    return Problem(
        data=data,
        simulator=simulator,
        given=given,
        simulated=simulated,
        shift=shift,
        tails=tails,
        covariance=covariance,
        noise=noise,
        zero_variance=errors.variance,
        scatter=scatter,
        levels=levels,
        factors=factors,
    )


def resimulated(problem: Problem, simulator: Simulator, data: Data) -> Problem:
    """The problem about another simulation or belief, its derivatives and covariance as they are.

    Args:
        problem: on the same readings.
        simulator: the other simulation.
        data: the same with another belief.
    """
    jacobian = problem.covariance.rows.context_jacobian[:, :, : len(data.belief.spread)]
    return replace(
        problem,
        data=data,
        simulator=simulator,
        simulated=data.predict(simulator),
        shift=_shift(jacobian, data.belief),
    )


def _shift(jacobian: FloatArray, belief: Belief) -> FloatArray:
    """What the prior of the contexts adds to a simulation, float[rows, sensors]."""
    if not belief.spread:
        return np.zeros(jacobian.shape[:2])
    offsets = np.stack([belief.centre[n] - belief.table[n] for n in belief.spread], axis=-1)
    return np.asarray(np.einsum("tsi,ti->ts", jacobian, offsets))


def _calibrations(
    simulator: Simulator, data: Data, jacobian: FloatArray, noise: Noise, basis: FloatArray
) -> list[Calibration]:
    """What measured contexts do that are off for the whole record, the rows of the zero included.

    Those that act along courses of the loads; what else a place that is off does is dear to follow,
    and small.
    """
    belief = data.belief
    courses, _ = np.linalg.qr(np.column_stack([np.ones(len(basis)), basis]))
    at_zero = slopes_at_zero(simulator, data)
    found: list[Calibration] = []
    for number, name in enumerate(belief.spread):
        if name in belief.latent:
            continue
        along, history = jacobian[:, :, number], belief.centre[name]
        offset, gain = along, along * history[:, None]
        if name in at_zero:
            slope, there = at_zero[name], data.tare.contexts[name]
            offset = offset - data.taken_off(slope)
            gain = gain - data.taken_off(slope * there[:, None])
        found.append((offset, OFFSET * float(noise.context_sigma[number])))
        found.append((gain, GAIN))
    return [
        (change, spread)
        for change, spread in found
        if ((change - courses @ (courses.T @ change)) ** 2).sum() <= FOLLOWED * (change**2).sum()
    ]


def context_jacobian(simulator: Simulator, data: Data, simulated: FloatArray) -> FloatArray:
    """Derivatives by the contexts that are uncertain row by row, float[rows, sensors, contexts].

    Of all channels, whether they were read or not.
    """
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
    return np.stack(columns, axis=2)


def load_basis(simulator: Simulator, data: Data) -> FloatArray:
    """Load coefficients in the order of their variance, float[rows, patterns], scaled to one."""
    coefficients = simulator.load_coefficients(data.belief.table)
    peak = np.abs(coefficients).max(0, initial=0.0)
    scaled = coefficients[:, peak > 0] / peak[peak > 0]
    if scaled.shape[1] == 0:
        return np.zeros((len(data.time), 0))
    u, s, _ = thin_svd(scaled)
    kept = s > 1e-6 * s[0]
    return np.asarray(u[:, kept] * np.sqrt(len(u)))


def relaxed(problem: Problem) -> Data:
    """The data with the contexts moved to where the residual puts them.

    Measured contexts too: what smooths the noise of their measurement is no physics.
    """
    data, belief = problem.data, problem.data.belief
    residual = problem.residual(problem.simulated)
    estimate = problem.covariance.scatter_estimate(residual)
    scatter = problem.covariance.scatter.at(estimate)
    changes: Values = {}
    moves = lines(data)
    for (name, direction, _), move in zip(
        moves, estimate[len(estimate) - len(moves) :], strict=True
    ):
        changes[name] = changes.get(name, belief.table[name]) + move * direction
    error = problem.covariance.rows.context_error(residual - scatter)
    for column, name in enumerate(belief.spread):
        changes[name] = belief.centre[name] + error[:, column]
    return replace(data, belief=belief.with_values(changes))
