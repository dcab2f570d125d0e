"""The covariance of a record about its simulation, and inner products under its inverse.

Three things make a good simulation miss a record: sensor noise with memory, contexts that were
measured with errors, and members and gains that are not quite as built. With the noise whitened by
W, the contexts' errors marginalised row after row (J, a block tridiagonal system) and the scatter
as random effects (B, a dense system), the product x' C^-1 y needs no matrix of the size of the
record. The algebra is that of Woodbury's identity, applied twice.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cholesky_banded, solve_banded

from rga.model.parameter import FloatArray

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Noise:
    """Sensor noise with memory, and the errors of the measured contexts.

    Attributes:
        sigma: standard deviation of each sensor's noise, float[sensors] [its unit].
        phi: correlation from one row to the next at the typical interval, float[sensors].
        context_sigma: standard deviation of each context's error, float[contexts].
    """

    sigma: FloatArray
    phi: FloatArray
    context_sigma: FloatArray


@dataclass(frozen=True)
class Reduced:
    """Columns after whitening and after the projection on the contexts' errors."""

    white: FloatArray
    context: FloatArray

    def gram(self, other: "Reduced") -> FloatArray:
        """Inner products of all columns with all columns of another set."""
        return np.asarray(self.white.T @ other.white - self.context.T @ other.context)


class RowCovariance:
    """Noise with memory and errors of the contexts: all of the covariance but the scatter.

    Args:
        noise: the noise.
        time: float[rows] [s].
        observed: bool[rows, sensors], False where a reading is missing.
        context_jacobian: float[rows, sensors, contexts], derivatives by the uncertain contexts.
    """

    def __init__(
        self, noise: Noise, time: FloatArray, observed: BoolArray, context_jacobian: FloatArray
    ) -> None:
        self.noise = noise
        self.observed = observed
        self.context_jacobian = context_jacobian
        step = np.diff(time, prepend=time[0] - 1.0)
        typical = float(np.median(step[1:])) if len(step) > 1 else 1.0
        memory = noise.phi ** (step[:, None] / max(typical, 1e-12))
        memory[0] = 0.0
        # After a missing reading the memory starts anew: a little information is given up.
        memory[1:][~observed[:-1]] = 0.0
        self.memory = memory
        self.weight = np.where(observed, 1.0 / (noise.sigma * np.sqrt(1.0 - memory**2)), 0.0)
        self._factor, self._band = self._context_factor()

    def _context_factor(self) -> tuple[FloatArray, int]:
        rows, _, contexts = self.context_jacobian.shape
        if contexts == 0:
            return np.zeros((1, 0)), 0
        jacobian, weight, memory = self.context_jacobian, self.weight, self.memory
        own = np.einsum("ts,tsi,tsj->tij", weight**2, jacobian, jacobian)
        later = (weight[1:] * memory[1:]) ** 2
        own[:-1] += np.einsum("ts,tsi,tsj->tij", later, jacobian[:-1], jacobian[:-1])
        own += np.diag(self.noise.context_sigma**-2.0)
        cross = -np.einsum(
            "ts,tsi,tsj->tij", weight[1:] ** 2 * memory[1:], jacobian[:-1], jacobian[1:]
        )
        band = 2 * contexts - 1
        lower = np.zeros((band + 1, rows * contexts))
        for i in range(contexts):
            for j in range(contexts):
                if i >= j:
                    lower[i - j, j::contexts] = own[:, i, j]
                lower[contexts + i - j, j : (rows - 1) * contexts : contexts] = cross[:, j, i]
        return np.asarray(cholesky_banded(lower, lower=True)), band

    def reduce(self, columns: FloatArray) -> Reduced:
        """Whiten columns, float[rows, sensors, k], and project them on the contexts' errors."""
        rows, sensors, count = columns.shape
        white = columns.copy()
        white[1:] -= self.memory[1:, :, None] * columns[:-1]
        white *= self.weight[:, :, None]
        contexts = self.context_jacobian.shape[2]
        context = np.zeros((0, count))
        if contexts:
            weighted = white * self.weight[:, :, None]
            back = np.matmul(self.context_jacobian.transpose(0, 2, 1), weighted)
            passed = self.memory[1:, :, None] * weighted[1:]
            back[:-1] -= np.matmul(self.context_jacobian[:-1].transpose(0, 2, 1), passed)
            context = solve_banded(
                (self._band, 0),
                self._factor,
                back.reshape(rows * contexts, count),
                check_finite=False,
            )
        return Reduced(white.reshape(rows * sensors, count), context)

    def context_error(self, residual: FloatArray) -> FloatArray:
        """Most likely errors of the contexts, float[rows, contexts], given float[rows, sensors]."""
        rows, _, contexts = self.context_jacobian.shape
        if contexts == 0:
            return np.zeros((rows, 0))
        half = self.reduce(residual[:, :, None]).context
        upper = np.zeros_like(self._factor)
        for k in range(self._band + 1):
            upper[self._band - k, k:] = self._factor[k, : self._factor.shape[1] - k]
        solved = solve_banded((0, self._band), upper, half, check_finite=False)
        return np.asarray(solved).reshape(rows, contexts)

    def unwhiten(self, residual: FloatArray) -> FloatArray:
        """W' W of a residual, float[rows, sensors]."""
        white = residual.copy()
        white[1:] -= self.memory[1:] * residual[:-1]
        white *= self.weight**2
        passed = self.memory[1:] * white[1:]
        white[:-1] -= passed
        return white


class Covariance:
    """The whole covariance: rows, and the scatter as random effects.

    Args:
        rows: noise and contexts' errors.
        scatter: float[rows, sensors, effects], derivatives by each random effect.
        spread: standard deviation of each random effect, float[effects].
    """

    def __init__(self, rows: RowCovariance, scatter: FloatArray, spread: FloatArray) -> None:
        self.rows = rows
        self.scatter = scatter
        self.spread = spread
        self._reduced = rows.reduce(scatter)
        self.information = self._reduced.gram(self._reduced)
        self._solve = cho_factor(self.information + np.diag(spread**-2.0))

    def with_spread(self, spread: FloatArray) -> "Covariance":
        """The same with another scatter."""
        other = object.__new__(Covariance)
        other.rows, other.scatter, other.spread = self.rows, self.scatter, spread
        other._reduced, other.information = self._reduced, self.information
        other._solve = cho_factor(self.information + np.diag(spread**-2.0))
        return other

    def reduce(self, columns: FloatArray) -> tuple[Reduced, FloatArray]:
        """Columns float[rows, sensors, k] made ready for `product`."""
        reduced = self.rows.reduce(columns)
        return reduced, self._reduced.gram(reduced)

    def product(self, a: tuple[Reduced, FloatArray], b: tuple[Reduced, FloatArray]) -> FloatArray:
        """x' C^-1 y of all pairs of columns."""
        return np.asarray(a[0].gram(b[0]) - a[1].T @ cho_solve(self._solve, b[1]))

    def squares(self, a: tuple[Reduced, FloatArray]) -> FloatArray:
        """x' C^-1 x of every column."""
        own = (a[0].white ** 2).sum(0) - (a[0].context ** 2).sum(0)
        return np.asarray(own - (a[1] * cho_solve(self._solve, a[1])).sum(0))

    def scatter_estimate(self, residual: FloatArray) -> FloatArray:
        """Most likely random effects, float[effects], given a residual float[rows, sensors]."""
        return np.asarray(cho_solve(self._solve, self.reduce(residual[:, :, None])[1])[:, 0])

    def inverse_times(self, residual: FloatArray) -> FloatArray:
        """C^-1 of a residual, float[rows, sensors]: what scatter and contexts leave, weighted."""
        left = residual - self.scatter @ self.scatter_estimate(residual)
        error = self.rows.context_error(left)
        left = left - np.einsum("tsi,ti->ts", self.rows.context_jacobian, error)
        return self.rows.unwhiten(left)

    def log_likelihood(self, score: FloatArray) -> float:
        """Log likelihood of the scatter up to a constant; `score` is B' R^-1 residual."""
        factor = self._solve[0]
        logdet = 2 * np.log(np.diag(factor)).sum() + 2 * np.log(self.spread).sum()
        return float(0.5 * score @ cho_solve(self._solve, score) - 0.5 * logdet)
