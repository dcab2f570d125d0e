"""The covariance of a record about its simulation, and inner products under its inverse.

Three things make a good simulation miss a record: sensor noise with memory, contexts that were
measured with errors (`row_covariance`), and members and gains that are not quite as built. The last
are random effects B, a dense system beside the rows: Woodbury's identity once more.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_solve, lapack

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.noise.row_covariance import RowCovariance

#: courses of as many sensors at a time are put on the contexts' errors
TOGETHER = 1024
#: shares that are gathered at a time for columns on a few channels
GATHERED = 2**22


@dataclass(frozen=True)
class RandomEffects:
    """Random effects on a record, each a sum of few courses over the rows.

    What a linear structure can do is a combination of the courses of its loads. So products with
    many effects cost little more than products with the courses.

    Attributes:
        courses: float[rows, courses].
        shares: of the courses in each effect, float[effects, sensors, courses].
    """

    courses: FloatArray
    shares: FloatArray

    def at(self, sizes: FloatArray) -> FloatArray:
        """The sum of the effects at sizes float[effects], float[rows, sensors]."""
        return np.asarray(self.courses @ np.tensordot(sizes, self.shares, 1).T)


@dataclass(frozen=True)
class Reduced:
    """Columns made ready for products.

    Attributes:
        white: whitened, float[k, channels, rows].
        context: on the contexts' errors, float[rows * contexts, k].
        score: on the random effects, float[effects, k].
        scattered: the same on the factor of their precision, float[effects, k].
    """

    white: FloatArray
    context: FloatArray
    score: FloatArray
    scattered: FloatArray


@dataclass(frozen=True)
class _Effects:
    """Shares of random effects, those apart that are of one sensor: most are.

    Attributes:
        count: how many there are.
        several: numbers of those of several sensors, int[a].
        shares: of these, float[a, sensors * courses].
        alone: numbers of those of each sensor, int[sensors, most]; `count` in the place of none.
        own: shares of these, float[sensors, most, courses].
    """

    count: int
    several: IntArray
    shares: FloatArray
    alone: IntArray
    own: FloatArray

    @classmethod
    def of(cls, shares: FloatArray) -> "_Effects":
        """Those of shares float[effects, sensors, courses]."""
        count, sensors, courses = shares.shape
        on = (shares != 0.0).any(2)
        single = on.sum(1) == 1
        of_sensors = [np.flatnonzero(single & column) for column in on.T]
        most = max(map(len, of_sensors), default=0)
        alone, own = np.full((sensors, most), count), np.zeros((sensors, most, courses))
        for sensor, numbers in enumerate(of_sensors):
            alone[sensor, : len(numbers)] = numbers
            own[sensor, : len(numbers)] = shares[numbers, sensor]
        several = np.flatnonzero(~single)
        of_several = shares[several].reshape(len(several), sensors * courses)
        return cls(count, several, of_several, alone, own)

    def on(self, sensors: IntArray) -> "_Effects":
        """The same with the shares that they have on some sensors, int[k]."""
        every, courses = self.own.shape[::2]
        of_sensors = self.shares.reshape(len(self.shares), every, courses)[:, sensors]
        shares = of_sensors.reshape(len(self.shares), len(sensors) * courses)
        return _Effects(self.count, self.several, shares, self.alone[sensors], self.own[sensors])

    def along(self, columns: FloatArray) -> FloatArray:
        """Products with columns on the courses, float[k, sensors, courses]: float[effects, k]."""
        found = np.zeros((self.count + 1, len(columns)))
        flat = columns.reshape(len(columns), self.shares.shape[1])
        found[self.several] = self.shares @ flat.T
        found[self.alone] = np.matmul(self.own, columns.transpose(1, 2, 0))
        return found[:-1]

    def along_few(self, columns: FloatArray, channels: IntArray) -> FloatArray:
        """The same of columns on a few channels each, float[k, few, courses] and int[k, few]."""
        count, few, courses = columns.shape
        found = np.zeros((self.count + 1, count))
        each = columns.reshape(count, 1, few * courses)
        step = max(1, GATHERED // max(1, few * courses * len(self.shares)))
        for first in range(0, count, step):
            part = slice(first, min(first + step, count))
            of_channels = self._by_sensor[channels[part]]
            shape = (len(of_channels), few * courses, len(self.shares))
            of_channels = of_channels.reshape(shape)
            found[self.several, part] = np.matmul(each[part], of_channels)[:, 0].T
        own = np.matmul(self.own[channels], columns[..., None])[..., 0]
        for place in range(few):
            found[self.alone[channels[:, place]], np.arange(count)[:, None]] += own[:, place]
        return found[:-1]

    @cached_property
    def _by_sensor(self) -> FloatArray:
        """Shares of those of several sensors, float[sensors, courses, a]."""
        sensors, _, courses = self.own.shape
        return np.ascontiguousarray(self.shares.T).reshape(sensors, courses, len(self.shares))


class Covariance:
    """The whole covariance: rows, and the scatter as random effects.

    Args:
        rows: noise and contexts' errors.
        scatter: the random effects.
        spread: standard deviation of each random effect, float[effects].
    """

    def __init__(self, rows: RowCovariance, scatter: RandomEffects, spread: FloatArray) -> None:
        self.rows = rows
        self.scatter = scatter
        self._effects = _Effects.of(scatter.shares)
        self._marginalise(*self._told_by_all, spread)

    @cached_property
    def _told_by_all(self) -> tuple[FloatArray, FloatArray]:
        return self._told_by(np.arange(self.rows.observed.shape[1]))

    def _told_by(self, sensors: IntArray) -> tuple[FloatArray, FloatArray]:
        """What some sensors tell of the random effects, were the contexts known.

        Returns:
            B' W' W B, float[effects, effects], and J' W' W B with the derivatives J by the
            contexts, float[rows * contexts, effects].
        """
        effects, courses = self._effects.on(sensors), self.scatter.courses.T
        of_sensors = np.tile(courses[:, None, :], (1, len(sensors), 1))
        white, back = self.rows.weighted(of_sensors, np.tile(sensors, (len(courses), 1)))
        grams = np.matmul(white.transpose(1, 0, 2), white.transpose(1, 2, 0))
        shares = self.scatter.shares[:, sensors].transpose(1, 0, 2)
        half = np.matmul(shares, grams).transpose(1, 0, 2)
        return effects.along(half), self._on_contexts(effects, back, sensors)

    def _on_contexts(self, effects: _Effects, back: FloatArray, sensors: IntArray) -> FloatArray:
        """Effects on some sensors against the contexts' derivatives.

        Args:
            effects: their shares on these sensors.
            back: W' W of the courses on each of them, float[courses, k, rows].
            sensors: their numbers, int[k].
        """
        jacobian = self.rows.context_jacobian[:, sensors]
        rows, _, contexts = jacobian.shape
        count = len(back)
        found = np.zeros((rows * contexts, effects.count + 1), order="F")
        if not contexts:
            return found[:, :-1]
        by_row = np.ascontiguousarray(back.transpose(2, 1, 0))
        step = max(1, TOGETHER // max(count, 1))
        for first in range(0, len(sensors), step):
            few = slice(first, min(first + step, len(sensors)))
            derivatives = jacobian[:, few].transpose(0, 2, 1)
            outer = np.multiply(derivatives[..., None], by_row[:, None, few], order="C")
            outer = outer.reshape(rows * contexts, few.stop - first, count)
            shares = effects.shares[:, first * count : few.stop * count]
            found[:, effects.several] += outer.reshape(len(outer), -1) @ shares.T
            own = np.matmul(outer.transpose(1, 0, 2), effects.own[few].transpose(0, 2, 1))
            found[:, effects.alone[few]] = own.transpose(1, 0, 2)
        return found[:, :-1]

    def _marginalise(
        self, information: FloatArray, on_contexts: FloatArray, spread: FloatArray
    ) -> None:
        """Take the contexts' errors off what sensors tell of the random effects (`_told_by`)."""
        self._context = self.rows.solve_contexts(on_contexts)
        own = information - self._context.T @ self._context
        self.information = np.asfortranarray(own)
        self._spread_as(spread)

    def without(self, hidden: IntArray) -> "Covariance":
        """The same with some sensors unseen, int[k]: what they told is taken off."""
        hidden = np.unique(hidden)
        other = self._copy("_constants", "_told_by_all")
        other.rows = self.rows.without(hidden)
        (information, on_contexts), (told, on_theirs) = self._told_by_all, self._told_by(hidden)
        information, on_contexts = information - told, on_contexts - on_theirs
        # Of what only they showed nothing is left, not even rounding.
        gone = np.setdiff1d(self._effects.alone[hidden], len(self.spread))
        information[gone] = information[:, gone] = on_contexts[:, gone] = 0.0
        other._marginalise(information, on_contexts, self.spread)
        return other

    def _spread_as(self, spread: FloatArray) -> None:
        self.spread = spread
        precision = self.information.copy(order="F")
        precision[np.diag_indices_from(precision)] += spread**-2.0
        self._factor, failed = lapack.dpotrf(precision, lower=1, clean=0, overwrite_a=1)
        if failed:
            raise np.linalg.LinAlgError("the precision of the scatter is not positive definite")

    def with_spread(self, spread: FloatArray) -> "Covariance":
        """The same with another scatter."""
        other = self._copy("_constants")
        other._spread_as(spread)
        return other

    def _copy(self, *stale: str) -> "Covariance":
        """A copy to be changed, without the cached properties that will not hold for it."""
        other = object.__new__(Covariance)
        known = self.__dict__.items()
        other.__dict__.update({name: value for name, value in known if name not in stale})
        return other

    def reduce(self, columns: FloatArray, channels: IntArray | None = None) -> Reduced:
        """Columns made ready for products.

        Args:
            columns: float[k, sensors, rows], or float[k, channels, rows].
            channels: those that each column touches, each once, int[k, channels]; None: all
                sensors.
        """
        white, back = self.rows.weighted(columns, channels)
        context = self.rows.solve_contexts(self.rows.on_contexts(back, channels))
        along, effects = back @ self.scatter.courses, self._effects
        score = effects.along(along) if channels is None else effects.along_few(along, channels)
        score -= self._context.T @ context
        scattered, _ = lapack.dtrtrs(self._factor, score, lower=1)
        return Reduced(white, context, score, scattered)

    def shifted(self, a: Reduced, by: FloatArray, channels: IntArray | None = None) -> Reduced:
        """Columns with a constant added on each channel, made ready for products.

        Args:
            a: the columns.
            by: the constants, float[k, channels].
            channels: as for `reduce`.
        """
        one, amounts = self._constants, by
        here: IntArray | slice = slice(None)
        if channels is not None:
            amounts, here = np.zeros((len(by), len(one.white))), channels
            amounts[np.arange(len(by))[:, None], channels] = by
        return Reduced(
            a.white + by[:, :, None] * one.white[:, 0][here],
            a.context + one.context @ amounts.T,
            a.score + one.score @ amounts.T,
            a.scattered + one.scattered @ amounts.T,
        )

    @cached_property
    def _constants(self) -> Reduced:
        """A constant of one on each sensor alone."""
        rows, sensors = self.rows.observed.shape
        return self.reduce(np.ones((sensors, 1, rows)), np.arange(sensors)[:, None])

    def product(self, a: Reduced, b: Reduced) -> FloatArray:
        """x' C^-1 y of all pairs of columns on the same channels."""
        own = a.white.reshape(len(a.white), -1) @ b.white.reshape(len(b.white), -1).T
        return np.asarray(own - a.context.T @ b.context - a.scattered.T @ b.scattered)

    def squares(self, a: Reduced) -> FloatArray:
        """x' C^-1 x of every column."""
        own = np.einsum("kct,kct->k", a.white, a.white) - (a.context**2).sum(0)
        return np.asarray(own - (a.scattered**2).sum(0))

    def scatter_estimate(self, residual: FloatArray) -> FloatArray:
        """Most likely random effects, float[effects], given a residual float[rows, sensors]."""
        return self._solved(self.reduce(residual.T[None]).score)[:, 0]

    def posterior(self, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Random effects given a residual float[rows, sensors].

        Returns:
            Their mean, float[effects], and their covariance, float[effects, effects].
        """
        inverse, _ = lapack.dpotri(self._factor, lower=1)
        lower = np.tril(inverse)
        return self.scatter_estimate(residual), lower + np.tril(lower, -1).T

    def inverse_times(self, residual: FloatArray) -> FloatArray:
        """C^-1 of a residual float[rows, sensors], float[sensors, rows]."""
        left = residual - self.scatter.at(self.scatter_estimate(residual))
        error = self.rows.context_error(left)
        left = left - np.einsum("tsi,ti->ts", self.rows.context_jacobian, error)
        return self.rows.unwhiten(self.rows.whiten(left.T))

    def log_likelihood(self, score: FloatArray) -> tuple[float, FloatArray]:
        """Log likelihood of the scatter up to a constant, and its derivatives.

        Args:
            score: B' R^-1 residual, float[effects].

        Returns:
            The likelihood, and its derivatives by the logarithms of the spreads, float[effects]:
            second moment of each effect over its prior variance, less one.
        """
        logdet = 2 * np.log(np.diag(self._factor)).sum() + 2 * np.log(self.spread).sum()
        mean = self._solved(score)
        half, _ = lapack.dtrtri(self._factor, lower=1)
        variances = np.square(np.tril(half), order="F").sum(0)
        moment = mean**2 + variances
        return float(0.5 * score @ mean - 0.5 * logdet), moment / self.spread**2 - 1.0

    def _solved(self, right: FloatArray) -> FloatArray:
        return np.asarray(cho_solve((self._factor, True), right, check_finite=False))
