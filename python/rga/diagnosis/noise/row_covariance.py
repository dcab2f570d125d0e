"""The covariance of a record row by row: sensor noise with memory, and errors of the contexts.

With the noise whitened by W and the contexts' errors marginalised row after row (derivatives J, a
block tridiagonal system), the product x' R^-1 y needs no matrix of the size of the record:
Woodbury's identity. Columns are float[k, sensors, rows], or float[k, channels, rows] with the
channels that each of them touches, int[k, channels]: what changes one sensor costs no more.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky_banded, lapack

from rga.arrays import BoolArray, FloatArray, IntArray

#: typical steps beyond which one row says nothing of the next: longer than rows that are held out
APART = 20.0
#: numbers in the columns that are weighted at a time: with their products they stay in the cache
CACHED = 1 << 15


@dataclass(frozen=True)
class Noise:
    """Sensor noise with memory, and the errors of the measured contexts.

    Attributes:
        sigma: standard deviation of each sensor's noise, its tails drawn in, float[sensors]
            [its unit].
        phi: correlation from one row to the next at the typical interval, float[sensors].
        context_sigma: standard deviation of each context's error, float[contexts].
        deviation: root mean square of each sensor's noise with its tails, float[sensors].
        freedom: degrees of freedom of its innovations, Student's t; infinite: Gaussian.
    """

    sigma: FloatArray
    phi: FloatArray
    context_sigma: FloatArray
    deviation: FloatArray
    freedom: float = np.inf


class RowCovariance:
    """Noise with memory and errors of the contexts: all of the covariance but the scatter.

    Args:
        noise: the noise.
        time: float[rows] [s].
        observed: bool[rows, sensors], False where a reading is missing.
        context_jacobian: float[rows, sensors, contexts], derivatives by the uncertain contexts.

    Attributes:
        weight: of an innovation, float[sensors, rows]; 0 where a reading is missing.
        near: whether a row follows the one before at about the typical interval, bool[rows].
    """

    def __init__(
        self, noise: Noise, time: FloatArray, observed: BoolArray, context_jacobian: FloatArray
    ) -> None:
        self.noise = noise
        self.time = time
        self.observed = observed
        self.context_jacobian = context_jacobian
        step = np.diff(time, prepend=time[0] - 1.0)
        typical = float(np.median(step[1:])) if len(step) > 1 else 1.0
        steps = step / max(typical, 1e-12)
        self.near = steps <= APART
        memory = noise.phi[:, None] ** steps
        # After a missing reading the memory starts anew: a little information is given up.
        memory[:, 1:][~observed.T[:, :-1]] = 0.0
        memory[:, 0] = 0.0
        spread = noise.sigma[:, None] * np.sqrt(1.0 - memory**2)
        self.weight = np.where(observed.T, 1.0 / spread, 0.0)
        self._passing = self.weight * memory
        self._memory, self._spread = memory, spread
        self._by_context = np.ascontiguousarray(context_jacobian.transpose(2, 1, 0))
        self._factor = self._context_factor()

    def without(self, hidden: IntArray) -> "RowCovariance":
        """The same with some sensors unseen, int[k]."""
        observed = self.observed.copy()
        observed[:, hidden] = False
        jacobian = np.where(observed[:, :, None], self.context_jacobian, 0.0)
        return RowCovariance(self.noise, self.time, observed, jacobian)

    def context_variance(self) -> FloatArray:
        """Covariance of the contexts of each row, those of others known.

        Returns:
            float[rows, contexts, contexts].
        """
        own, _ = self._context_precision()
        return np.asarray(np.linalg.inv(own.transpose(2, 0, 1)))

    def _context_precision(self) -> tuple[FloatArray, FloatArray]:
        """Precision of a row's contexts, and with the next; float[contexts, contexts, rows]."""
        jacobian = self._by_context
        now = self.weight * jacobian
        later = self._passing[:, 1:] * jacobian[..., :-1]
        own = _over_sensors(now, now)
        own[..., :-1] += _over_sensors(later, later)
        own += np.diag(self.noise.context_sigma**-2.0)[..., None]
        return own, -_over_sensors(later, now[..., 1:])

    def _context_factor(self) -> FloatArray:
        """Cholesky factor of the contexts' precision, its lower band."""
        contexts, _, rows = self._by_context.shape
        if contexts == 0:
            return np.zeros((1, 0))
        own, cross = self._context_precision()
        lower = np.zeros((2 * contexts, rows * contexts))
        for i in range(contexts):
            for j in range(contexts):
                if i >= j:
                    lower[i - j, j::contexts] = own[i, j]
                lower[contexts + i - j, j : (rows - 1) * contexts : contexts] = cross[j, i]
        return np.asfortranarray(cholesky_banded(lower, lower=True))

    def whiten(self, columns: FloatArray, channels: IntArray | None = None) -> FloatArray:
        """W x of columns, of their shape."""
        here = slice(None) if channels is None else channels
        white = columns * self.weight[here]
        white[..., 1:] -= self._passing[here][..., 1:] * columns[..., :-1]
        return np.asarray(white)

    def unwhiten(self, white: FloatArray) -> FloatArray:
        """W' x of whitened columns, of their shape."""
        back = white * self.weight
        back[..., :-1] -= (white * self._passing)[..., 1:]
        return np.asarray(back)

    def weighted(
        self, columns: FloatArray, channels: IntArray | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """W x and W' W x of columns, of their shape."""
        white, back = np.empty(columns.shape), np.empty(columns.shape)
        weight, passing = self.weight, self._passing[:, 1:]
        step = max(1, CACHED // max(columns[:1].size, 1))
        for first in range(0, len(columns), step):
            few = slice(first, first + step)
            if channels is not None:
                weight, passing = self.weight[channels[few]], self._passing[channels[few], 1:]
            np.multiply(columns[few], weight, out=white[few])
            white[few, :, 1:] -= passing * columns[few, :, :-1]
            np.multiply(white[few], weight, out=back[few])
            back[few, :, :-1] -= passing * white[few, :, 1:]
        return white, back

    def whitened_variance(self, variance: FloatArray) -> FloatArray:
        """Variances of whitened readings of independent variances, float[sensors, rows]."""
        white = variance * self.weight**2
        white[:, 1:] += self._passing[:, 1:] ** 2 * variance[:, :-1]
        return np.asarray(white)

    def coloured(self, white: FloatArray) -> FloatArray:
        """W^-1 of innovations, zero where missing, float[sensors, rows]."""
        columns = white * self._spread
        for row in range(1, columns.shape[1]):
            columns[:, row] += self._memory[:, row] * columns[:, row - 1]
        return np.where(self.observed.T, columns, 0.0)

    def on_contexts(self, back: FloatArray, channels: IntArray | None = None) -> FloatArray:
        """Columns W' W x against the contexts' derivatives, float[rows * contexts, k]."""
        contexts, _, rows = self._by_context.shape
        if channels is None:
            found = np.einsum("kct,jct->kjt", back, self._by_context)
        else:
            found = np.einsum("kct,jkct->kjt", back, self._by_context[:, channels])
        return np.asarray(found.transpose(0, 2, 1).reshape(len(back), rows * contexts).T)

    def solve_contexts(self, right: FloatArray) -> FloatArray:
        """The contexts' factor solved for right sides, float[rows * contexts, k]."""
        return _solved(self._factor, right, b"N")

    def context_error(self, residual: FloatArray) -> FloatArray:
        """Most likely errors of the contexts, float[rows, contexts], given float[rows, sensors]."""
        rows, _, contexts = self.context_jacobian.shape
        half = self.solve_contexts(self.on_contexts(self.unwhiten(self.whiten(residual.T[None]))))
        return _solved(self._factor, half, b"T").reshape(rows, contexts)


def _over_sensors(one: FloatArray, other: FloatArray) -> FloatArray:
    """Inner products over the sensors, row by row, float[contexts, contexts, rows]."""
    return np.asarray(np.einsum("ist,jst->ijt", one, other))


def _solved(factor: FloatArray, right: FloatArray, trans: bytes) -> FloatArray:
    if not right.size:
        return right
    found, _ = lapack.dtbtrs(factor, right, uplo=b"L", trans=trans)
    return np.asarray(found)
