"""Gauss-Newton steps of the contexts of all rows and the unknowns of the structure together."""

import numpy as np

from rga.inference.box_step import EDGE
from rga.inference.corrected import CorrectedTwin
from rga.inference.guess import QuadraticGuess
from rga.inference.posterior_mode import posterior_mode, standard
from rga.inference.rows import Rows
from rga.inference.unknowns import Unknowns
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

#: prior spread of the gain of a sensor [-]
GAIN = 0.01
#: variance that the contexts of the measured rows may have, in that of their ranges
POPULATION = (0.05, 1.5)
#: shares of a step that are tried; share of the misfit below which a step is not worth another
SHARES, WORTH = (1.0, 0.5, 0.2, 0.05), 1e-3
#: readings that a sensor's own noise is held against that of all by, and the first guess [spreads]
HELD_BY, GUESS = 30.0, 5.0


class Search:
    """Where the search for the joint mode stands.

    Args:
        unknowns: of the structure.
        readings: measured rows, float[n, sensors], NaN where missing.
        noise: standard deviation of each sensor's noise, float[sensors].
        load_tests: measured rows whose contexts are known.
        begun: unknowns and gains, and the variance of each sensor, where to start.

    Attributes:
        contexts: of measured rows, then of load tests, float[rows, contexts].
        value: unknowns, then gains, float[unknowns + sensors].
        variance: of what readings differ by from the twin, float[sensors].
        slopes: of readings by unknowns and gains in units of their priors, at the last solution.
        covariance: of unknowns and gains in these units, were the rows of a sensor independent.
        pull: what the sensors disagree on about them.
    """

    def __init__(
        self,
        unknowns: Unknowns,
        readings: FloatArray,
        noise: FloatArray,
        load_tests: Rows | None,
        begun: tuple[FloatArray, FloatArray] | None,
    ) -> None:
        self.unknowns, self.noise, self.many = unknowns, noise, len(readings)
        ranges = np.array([one.range for one in unknowns.model.context.values()])
        self.ranges = ranges
        self.middle, self.scale = standard(ranges)
        known = load_tests or Rows(np.zeros((0, len(ranges))), np.zeros((0, len(noise))))
        self.readings = np.vstack([readings, known.readings])
        self.seen = np.isfinite(self.readings)
        self.contexts = np.vstack([np.tile(self.middle, (self.many, 1)), known.contexts])
        self.free = (np.arange(len(self.contexts)) < self.many)[:, None]
        sensors, count = len(noise), len(unknowns.centre)
        self.count = count
        self.unit = np.concatenate([unknowns.spread, np.full(sensors, GAIN)])
        self.centre = np.concatenate([unknowns.centre, np.ones(sensors)])
        self.value: FloatArray
        self.variance: FloatArray
        self.value, self.variance = begun or (self.centre.copy(), (GUESS * noise) ** 2)
        contexts = len(ranges)
        self.population = np.zeros(contexts), np.ones(contexts)
        self.seen_population = self.population
        self.volume = np.zeros(len(self.unit))

    @property
    def twin(self) -> CorrectedTwin:
        return self._twin(self.value)

    def _twin(self, value: FloatArray) -> CorrectedTwin:
        values, gains = np.split(value, [self.count])
        return CorrectedTwin(Simulator(self.unknowns.at(values)), gains)

    def place(self, source: FloatArray) -> None:
        """Contexts of the measured rows anew, from two starts, the unknowns as they stand."""
        twin = self.twin
        self.population = self.seen_population
        simulated = Rows(source, twin.simulate(source))
        measured = self.readings[: self.many]
        guess = QuadraticGuess(simulated, np.sqrt(self.variance), self.ranges, seed=0)
        mode, kept = (
            posterior_mode(
                twin.simulate, twin.jacobian, measured, np.diag(self.variance), self.ranges, start
            )
            for start in (guess(measured), self.contexts[: self.many])
        )
        better = (mode.misfit < kept.misfit)[:, None]
        self.contexts[: self.many] = np.where(better, mode.value, kept.value)
        self._weigh(self._residual(self.value, self.contexts), 0.0)
        self.volume = self._volume_slope()

    def _volume_slope(self) -> FloatArray:
        """Half the slope of the log determinant of the rows' precision along the unknowns.

        The mode over contexts and unknowns is off: contexts that vary less please their prior, so
        that a structure that is too soft would be found (Neyman and Scott, Econometrica 16, 1948).
        The likelihood of the unknowns alone has the determinant beside it (Laplace).
        """
        here, bent = self.unknowns.sample
        root = self.scale / np.sqrt(self.variance)[:, None]
        here, bent = here * root, bent * root
        turned = here.transpose(0, 2, 1)
        spread = np.linalg.inv(turned @ here + np.diag(1.0 / self.population[1] ** 2))
        back = here @ spread
        of_unknowns = np.einsum("nsc,knsc->k", back, bent, optimize=True)
        of_gains = GAIN * np.einsum("nsc,nsc->s", back, here)
        slope = np.concatenate([of_unknowns, of_gains])
        return np.asarray(slope * self.many / len(here))

    def step(self) -> bool:
        """A step of contexts and unknowns together; False where no more is to be gained."""
        change, moved = self.solve()
        here = self._misfit(self.value, self.contexts)
        low, high = self._bounds()
        for share in SHARES:
            value = np.clip(self.value + share * self.unit * change, low, high)
            contexts = self.contexts + share * self.scale * moved
            contexts = np.clip(contexts, *self.ranges.T)
            contexts = np.where(self.free, contexts, self.contexts)
            there = self._misfit(value, contexts)
            if there < here:
                self.value, self.contexts = value, contexts
                self._weigh(self._residual(value, contexts), self.freedom)
                return here - there > WORTH * here
        return False

    def solve(self) -> tuple[FloatArray, FloatArray]:
        """Change of the unknowns and of the contexts, in units of their priors."""
        values, gains = np.split(self.value, [self.count])
        plain, by_contexts, by_unknowns = self.unknowns.linearise(self.contexts, values)
        own_gains = plain[:, :, None] * np.eye(plain.shape[1])
        slopes = np.concatenate([by_unknowns * gains[:, None], own_gains], axis=2)
        off = np.where(self.seen, self.readings - gains * plain, 0.0)
        weight = np.where(self.seen, 1.0 / np.sqrt(self.variance), 0.0)
        off = off * weight
        slopes = slopes * self.unit * weight[:, :, None]
        near = by_contexts * gains[:, None] * self.scale * weight[:, :, None]
        near = np.where(self.free[:, :, None], near, 0.0)
        z = (self.contexts - self.middle) / self.scale
        middle, width = self.population
        pull = np.where(
            self.free,
            (near.transpose(0, 2, 1) @ off[:, :, None])[:, :, 0] - (z - middle) / width**2,
            0.0,
        )
        # A context at an end of its range that would leave stays there.
        held = (np.abs(z) > EDGE * (1.0 - 1e-9)) & (pull * z > 0)
        near, pull = np.where(held[:, None], 0.0, near), np.where(held, 0.0, pull)
        own = near.transpose(0, 2, 1) @ near + np.diag(1.0 / width**2)
        cross = near.transpose(0, 2, 1) @ slopes
        table = slopes.reshape(-1, slopes.shape[2])
        solved = np.linalg.solve(own, np.concatenate([cross, pull[:, :, None]], axis=2))
        through, alone = solved[:, :, :-1], solved[:, :, -1]
        flat = cross.reshape(-1, cross.shape[2])
        whole = table.T @ table + np.eye(len(self.unit)) - flat.T @ through.reshape(flat.shape)
        right = (
            table.T @ off.ravel()
            - self._standard(self.value)
            - self.volume
            - flat.T @ alone.ravel()
        )
        self.covariance = np.linalg.inv(whole)
        change = self.covariance @ right
        inside = np.linalg.inv(own)
        spread = inside + through @ self.covariance @ through.transpose(0, 2, 1)
        own_rows = slice(0, self.many)
        mean = z[own_rows].mean(axis=0)
        variance = z[own_rows].var(axis=0) + np.diagonal(spread[own_rows], axis1=1, axis2=2).mean(
            axis=0
        )
        self.seen_population = mean, np.sqrt(np.clip(variance, *POPULATION))
        # Of as many readings the parameters take the freedom that the priors do not.
        taken = (z.shape[1] - np.trace(inside, axis1=1, axis2=2))[: self.many].sum()
        self.freedom = float(taken + len(self.unit) - np.trace(self.covariance))
        self.slopes = slopes * np.sqrt(self.variance)[:, None]
        # What is wrong with a model stays wrong from row to row: each sensor is one cluster of rows
        # (Liang and Zeger, Biometrika 73, 1986).
        pulls = np.einsum("nsp,ns->sp", slopes - near @ through, off)
        self.pull = pulls.T @ pulls
        return change, alone - (through @ change)

    def _residual(self, value: FloatArray, contexts: FloatArray) -> FloatArray:
        simulated = self._twin(value).simulate(contexts)
        return np.where(self.seen, self.readings - simulated, 0.0)

    def _misfit(self, value: FloatArray, contexts: FloatArray) -> float:
        off = self._residual(value, contexts)
        middle, width = self.population
        z = np.where(self.free, ((contexts - self.middle) / self.scale - middle) / width, 0.0)
        at = self._standard(value)
        prior = (z**2).sum() + (at**2).sum() + 2.0 * self.volume @ at
        return float((off**2 / self.variance).sum() + prior)

    def _standard(self, value: FloatArray) -> FloatArray:
        """Unknowns and gains in units of their priors."""
        return np.asarray((value - self.centre) / self.unit)

    def _weigh(self, off: FloatArray, freedom: float) -> None:
        """What noise and model error are left, sensor by sensor, never below the stated noise."""
        counts = self.seen.sum(axis=0)
        left = max(1.0 - freedom / max(counts.sum(), 1), 0.2)
        own = (off**2).sum(axis=0) / self.noise**2 / left
        all_ = own.sum() / max(counts.sum(), 1)
        ratio = (own + HELD_BY * all_) / (counts + HELD_BY)
        self.variance = self.noise**2 * np.maximum(ratio, 1.0)

    def _bounds(self) -> tuple[FloatArray, FloatArray]:
        wide = np.full(len(self.noise), np.inf)
        low = np.concatenate([self.unknowns.low, -wide])
        return low, np.concatenate([self.unknowns.high, wide])
