"""Gauss-Newton steps of the contexts of all rows and the unknowns of the structure together."""

from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from rga.arrays import FloatArray, IntArray
from rga.inference.joint.derivatives import Derivatives, derivatives
from rga.inference.joint.joint_prior import GAIN, JointPrior, parameter_units
from rga.inference.joint.measured_contexts import MeasuredContexts
from rga.inference.joint.population import Population
from rga.inference.joint.sensor_errors import CorrectedTwin
from rga.inference.joint.sparse_changes import sparse_changes
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.joint.volume import Curvature
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.map.posterior_mode import CLOSE, REACH, mode_beyond, posterior_mode
from rga.inference.map.standard_units import EDGE, standard
from rga.inference.rows import Rows
from rga.simulation import Simulator

#: degrees of freedom of what sensors lie by: few of them do, and by far more than the others
TAILS = 3.0
#: shares of a step that are tried; gain in misfit below which a step is not worth another
SHARES, WORTH = (1.0, 0.5, 0.2, 0.05), 0.5
#: readings that a sensor's own noise is held against that of all by, and the first guess [spreads]
HELD_BY, GUESS = 30.0, 5.0
#: times the middle sensor's that a sensor counts at most in that of all: one that is broken says
#: nothing of the others
BROKEN = 10.0


class LinearisedRows(NamedTuple):
    """Rows as linear in contexts and parameters, each reading in units of its deviation.

    Attributes:
        off: what readings differ by from the twin, float[rows, sensors].
        slopes: by parameters in their units, float[rows, sensors, parameters].
        near: by contexts in theirs, float[rows, sensors, contexts].
    """

    off: FloatArray
    slopes: FloatArray
    near: FloatArray


class Search:
    """Where the search for the joint mode stands.

    Parameters are the unknowns, then the gains, then the offsets of the sensors.

    Args:
        unknowns: of the structure.
        readings: measured rows, float[n, sensors], NaN where missing.
        noise: standard deviation of each sensor's noise, float[sensors].
        load_tests: measured rows whose contexts are known.
        prior: of the parameters.
        measured: contexts that instruments read at the measured rows.

    Attributes:
        contexts: of measured rows, then of load tests, float[rows, contexts].
        value: of the parameters, float[parameters].
        variance: of what readings differ by from the twin, float[sensors].
        slopes: of readings by parameters in their units, at the last solution.
        covariance: of parameters in their units, were the rows of a sensor independent.
        pulled: what the model's error at each sensor pulls them by, float[sensors or more,
            parameters].
    """

    def __init__(
        self,
        unknowns: Unknowns,
        readings: FloatArray,
        noise: FloatArray,
        load_tests: Rows | None,
        prior: JointPrior,
        measured: MeasuredContexts,
    ) -> None:
        self.unknowns, self.noise, self.many = unknowns, noise, len(readings)
        self.measured = measured
        ranges = measured.within(np.array([one.range for one in unknowns.model.context.values()]))
        self.ranges = ranges
        self.middle, self.scale = standard(ranges)
        known = load_tests or Rows(np.zeros((0, len(ranges))), np.zeros((0, len(noise))))
        self.readings = np.vstack([readings, known.readings])
        self.seen = np.isfinite(self.readings)
        self.read = np.isfinite(np.vstack([measured.values, np.full_like(known.contexts, np.nan)]))
        begin = np.where(np.isfinite(measured.values), measured.values, self.middle)
        self.contexts = np.vstack([begin, known.contexts])
        self.told = (self.contexts - self.middle) / self.scale, measured.noise / self.scale
        self.free = (np.arange(len(self.contexts)) < self.many)[:, None]
        self.count = len(unknowns.centre)
        self.kinds = np.repeat([0, 1, 2], [self.count, len(noise), len(noise)])
        self.unit = parameter_units(unknowns, noise)
        self.prior, self.centre, self.tails = prior, prior.mean, TAILS
        self._suppose(prior.change**2)
        self.value, self.variance = self.centre.copy(), (GUESS * noise) ** 2
        none: Derivatives | None = None
        self._known = self.contexts, self.value, none
        self.reach = self._reached()
        self.population = Population.unknown(len(ranges))
        self.volume = np.zeros(len(self.unit))

    def begin(self, value: FloatArray, variance: FloatArray) -> None:
        """Where to begin: parameters, and what readings differ by, float[sensors].

        Sensors are then thought to be about as they were for most of the rows.
        """
        self.value, self.variance, self.tails = value.copy(), variance, np.inf

    def split(self, value: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Unknowns, gains and offsets of parameters."""
        unknowns, gains, offsets = np.split(value, [self.count, self.count + len(self.noise)])
        return unknowns, gains, offsets

    @property
    def twin(self) -> CorrectedTwin:
        return self._twin(self.value)

    def _twin(self, value: FloatArray) -> CorrectedTwin:
        unknowns, gains, offsets = self.split(value)
        simulator = Simulator(self.unknowns.at(unknowns))
        return CorrectedTwin(simulator, gains, offsets, time=self.unknowns.time)

    def place(self, source: FloatArray, near: bool) -> None:
        """Contexts of the measured rows anew, from two starts, the unknowns as they stand.

        Args:
            source: contexts to start from, float[m, contexts].
            near: the unknowns are about right. Far from them the contexts that they give say
                nothing of where these lie, and all of the ranges is thought possible.
        """
        self.near = near
        twin = self.measured.beside(self.twin)
        simulated = Rows(source, twin.simulate(source))
        read = self.measured.behind(self.readings[: self.many])
        deviation = self.measured.behind_noise(np.sqrt(self.variance))
        guess = QuadraticGuess(simulated, deviation, self.ranges, seed=0)
        known = twin.simulate, twin.jacobian, read, np.diag(deviation**2)
        # That contexts lie in their ranges says how stiff a structure is that is not known yet.
        if self.prior.earlier:
            infer = partial(mode_beyond, *known, self.measured.behind_noise(self.noise))
        else:
            infer = partial(posterior_mode, *known)
        mode, kept = (infer(self.ranges, one) for one in (guess(read), self.contexts[: self.many]))
        better = (mode.misfit < kept.misfit)[:, None]
        placed = np.where(better, mode.value, kept.value)
        self.contexts = np.vstack([placed, self.contexts[self.many :]])
        self.reach = self._reached()
        if near:
            inside = np.where(better[:, None], mode.covariance, kept.covariance)
            z = (self.contexts[: self.many] - self.middle) / self.scale
            self.population = Population.of(z, np.diagonal(inside, axis1=1, axis2=2))
        self._weigh(self._residual(self.value, self.contexts), 0.0)
        self.volume = self._volume_slope()

    def _reached(self) -> FloatArray:
        """Half widths of its range that each row's context may reach, float[rows, contexts].

        Were a row that stands at an end held there, it would say that its context is known.
        """
        at_end = np.abs(self.contexts - self.middle) > EDGE * self.scale * CLOSE
        return np.where(at_end & self.prior.earlier, REACH, 1.0)

    def _volume_slope(self) -> FloatArray:
        bent = self._curvature
        weight = np.where(self.seen[bent.rows], 1.0 / np.sqrt(self.variance), 0.0)
        weight = weight[:, :, None] * self.scale
        follow, width = self._follow()[bent.rows], self._before()[1][bent.rows]
        return self.many * bent.volume_slope(weight, width, follow, GAIN)

    @cached_property
    def _curvature(self) -> Curvature:
        return Curvature.of(self.unknowns, self.contexts[: self.many], self.scale)

    def _follow(self) -> FloatArray:
        """What contexts lose by a parameter, in their units, float[rows, contexts, parameters]."""
        _, slopes, near = self._linear()
        turned = near.transpose(0, 2, 1)
        own = turned @ near + np.eye(near.shape[2]) / self._before()[1][:, :, None] ** 2
        return np.asarray(np.linalg.solve(own, turned @ slopes))

    def step(self) -> bool:
        """A step of contexts and parameters together; False where no more is to be gained."""
        change, moved, of_population = self.solve()
        here = self._misfit(self.value, self.contexts, self.population)
        low, high = self._bounds()
        for share in SHARES:
            value = np.clip(self.value + share * self.unit * change, low, high)
            contexts = self.contexts + share * self.scale * moved
            farthest = EDGE * self.reach * self.scale
            contexts = np.clip(contexts, self.middle - farthest, self.middle + farthest)
            contexts = np.where(self.free, contexts, self.contexts)
            population = self.population.moved(share * self.near * of_population)
            there = self._misfit(value, contexts, population)
            if there < here:
                self.value, self.contexts, self.population = value, contexts, population
                self._weigh(self._residual(value, contexts), self.freedom)
                return self._trust() or here - there > WORTH
        return self.prior.earlier and self._trust()

    def solve(self, *, last: bool = False) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Change of the parameters, of the contexts and of their population, in their units.

        The normal equations of parameters and population are left by eliminating the contexts of
        each row.

        Args:
            last: it is asked how sure parameters are. A context that is held at the end of its
                range counts as known there, and so tells how stiff a structure is, only where
                contexts fill their range: else all that is known is that it lies no farther.
        """
        off, slopes, near = self._linear()
        z = (self.contexts - self.middle) / self.scale
        middle, width = self._before()
        turned = near.transpose(0, 2, 1)
        pull = (turned @ off[:, :, None])[:, :, 0] - (z - middle) / width**2
        pull = np.where(self.free, pull, 0.0)
        # A context at an end of its range that would leave stays there.
        held = (np.abs(z) > EDGE * self.reach * CLOSE) & (pull * z > 0)
        if last:
            held &= self.population.fills(EDGE)
        near, pull = np.where(held[:, None], 0.0, near), np.where(held, 0.0, pull)
        turned = near.transpose(0, 2, 1)
        own = turned @ near + np.eye(z.shape[1]) / width[:, :, None] ** 2
        inside = np.asarray(np.linalg.inv(own))
        self.inside = np.diagonal(inside, axis1=1, axis2=2)
        population = self.population.equations(z, self.inside, self._of_population)
        beside = np.where(held[:, :, None], 0.0, population.cross)
        cross = np.concatenate([turned @ slopes, beside], axis=2)
        through, alone = inside @ cross, (inside @ pull[:, :, None])[:, :, 0]

        count = slopes.shape[2]
        table, flat = (part.reshape(-1, part.shape[2]) for part in (slopes, cross))
        whole = block_diag(table.T @ table + self.precision, population.own)
        whole -= flat.T @ through.reshape(flat.shape)
        down = table.T @ off.ravel() - self.precision @ self._standard(self.value) - self.volume
        right = np.concatenate([down, population.down]) - flat.T @ alone.ravel()
        covariance = np.linalg.inv(whole)
        self.covariance = covariance[:count, :count]
        change = covariance @ right

        self._see_freedom(width)
        if self.prior.earlier:
            self._look_for_changes(change[:count])
        self.slopes = slopes * np.sqrt(self.variance)[:, None]
        # What is wrong with a model stays wrong from row to row, and from those of the prior on:
        # each sensor is one cluster of rows (Liang and Zeger, Biometrika 73, 1986).
        pulls = self.prior.pulled @ self.precision
        pulls[: len(self.noise)] += np.einsum(
            "nsp,ns->sp", slopes - near @ through[:, :, :count], off
        )
        self.pulled = pulls @ self.covariance
        return change[:count], alone - through @ change, change[count:]

    @property
    def _of_population(self) -> NDArray[np.bool_]:
        """Contexts by which the population is found, bool[rows, contexts]."""
        return np.asarray(self.free & ~self.read)

    def _linear(self) -> LinearisedRows:
        at = self._derivatives()
        weight = np.where(self.seen, 1.0 / np.sqrt(self.variance), 0.0)
        off = np.where(self.seen, self.readings - at.readings, 0.0)
        near = np.where(self.free[:, :, None], at.by_contexts, 0.0)
        heavy = weight[:, :, None]
        slopes = at.by_parameters * self.unit * heavy
        return LinearisedRows(off * weight, slopes, near * self.scale * heavy)

    def _derivatives(self) -> Derivatives:
        """Those at contexts and parameters as they stand; neither is ever changed in place."""
        contexts, value, known = self._known
        if known is None or contexts is not self.contexts or value is not self.value:
            known = derivatives(self.unknowns, self.contexts, self.split(self.value))
            self._known = self.contexts, self.value, known
        return known

    def _see_freedom(self, width: FloatArray) -> None:
        """Of how many readings contexts, of these prior deviations, and parameters take freedom."""
        # Of as many readings the parameters take the freedom that the priors do not.
        taken = (1.0 - self.inside / width**2)[: self.many].sum()
        left = np.sum(self.precision * self.covariance)
        self.freedom = float(taken + len(self.unit) - left)

    def _residual(self, value: FloatArray, contexts: FloatArray) -> FloatArray:
        simulated = self._twin(value).simulate(contexts)
        return np.where(self.seen, self.readings - simulated, 0.0)

    def _misfit(self, value: FloatArray, contexts: FloatArray, population: Population) -> float:
        off = self._residual(value, contexts)
        middle, width = self._before(population)
        z = np.where(self.free, ((contexts - self.middle) / self.scale - middle) / width, 0.0)
        at = self._standard(value)
        prior = (z**2).sum() + at @ self.precision @ at + 2.0 * self.volume @ at
        prior += population.cost(self.inside, self._of_population, self.population)
        return float((off**2 / self.variance).sum() + prior)

    def _before(self, population: Population | None = None) -> tuple[FloatArray, FloatArray]:
        """Prior means and deviations of contexts in their units, float[rows, contexts]."""
        of = population or self.population
        pairs = zip(self.told, (of.mean, of.width), strict=True)
        middle, width = (np.where(self.read, read, others) for read, others in pairs)
        return middle, width

    def _standard(self, value: FloatArray) -> FloatArray:
        """What parameters differ by from their prior means, in their units."""
        return np.asarray((value - self.centre) / self.unit)

    def _weigh(self, off: FloatArray, freedom: float) -> None:
        """What noise and model error are left, sensor by sensor, never below the stated noise."""
        counts = self.seen.sum(axis=0)
        if not self.near:
            # What is always the same may be an offset yet to be found, and is no noise.
            off = np.where(self.seen, off - off.sum(axis=0) / np.maximum(counts, 1), 0.0)
        left = max(1.0 - freedom / max(counts.sum(), 1), 0.2)
        own = (off**2).sum(axis=0) / self.noise**2 / left
        ratio = (own + HELD_BY * _usual(own, counts)) / (counts + HELD_BY)
        self.variance = self.noise**2 * np.maximum(ratio, 1.0)

    def _look_for_changes(self, change: FloatArray) -> None:
        """Which parameters have changed since they were found earlier, at the solution at hand."""
        whole = np.linalg.inv(self.covariance)
        information, at = whole - self.precision, self._standard(self.value)
        # What was found earlier is off by the model's error as well.
        left_open = self.prior.covariance + self.prior.pulled.T @ self.prior.pulled
        self.evident = sparse_changes(information, whole @ (at + change), left_open, self.kinds)

    def _trust(self) -> bool:
        """Which parameters are off, as far as is seen now; whether others are than before."""
        before = self.changed > 0
        if self.prior.earlier:
            self._suppose(self.evident)
        elif np.isfinite(self.tails):
            self._suppose(self._sensor_errors())
        return bool(np.any(before != (self.changed > 0)))

    def _sensor_errors(self) -> FloatArray:
        """What sensors lie by, by Student's distribution: variances in units of their priors.

        Expectation and maximisation (Dempster, Laird and Rubin, J. R. Stat. Soc. B 39, 1977).
        """
        scale, own = self.prior.change, np.diag(self.prior.covariance)
        share = self.changed / np.where(self.changed > 0, self.changed + own, 1.0)
        moved = self._standard(self.value) ** 2 + np.diag(self.covariance)
        square = share**2 * moved + share * own
        return np.asarray((self.tails * scale**2 + square) / (self.tails + 1.0))

    def _suppose(self, changed: FloatArray) -> None:
        """That parameters have changed by so much: variances in units of their priors."""
        self.changed = changed
        self.precision = np.linalg.inv(self.prior.covariance + np.diag(changed))

    def _bounds(self) -> tuple[FloatArray, FloatArray]:
        wide = np.full(2 * len(self.noise), np.inf)
        low = np.concatenate([self.unknowns.low, -wide])
        return low, np.concatenate([self.unknowns.high, wide])


def _usual(squares: FloatArray, counts: IntArray) -> float:
    """Mean square of a reading of all sensors, of their sums of squares, float[sensors]."""
    known = counts > 0
    if not known.any():
        return 0.0
    most = BROKEN * np.median(squares[known] / counts[known])
    return float(np.minimum(squares, most * counts).sum() / counts.sum())
