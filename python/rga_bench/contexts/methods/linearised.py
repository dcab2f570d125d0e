"""Measured rows linearised in their contexts: what their readings show of an error of the twin."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.standard_units import standard


@dataclass(frozen=True)
class Linearised:
    """Rows y - S(c) + J z = J z + error, z being contexts in standard units around some point.

    Attributes:
        off: left-hand side, float[n, sensors]; 0 where a reading is missing.
        slope: J, float[n, sensors, contexts]; 0 where a reading is missing.
        seen: 1 where there is a reading, else 0, float[n, sensors].
    """

    off: FloatArray
    slope: FloatArray
    seen: FloatArray

    @classmethod
    def at(cls, twin: TwinOnArrays, readings: FloatArray, contexts: FloatArray) -> "Linearised":
        """Rows, float[n, sensors], around contexts, float[n, contexts]."""
        middle, scale = standard(twin.ranges)
        seen = np.isfinite(readings)
        slope = np.where(seen[:, :, None], twin.jacobian(contexts) * scale, 0.0)
        gap = np.where(seen, readings - twin.simulate(contexts), 0.0)
        off = gap + np.einsum("nsc,nc->ns", slope, (contexts - middle) / scale)
        return cls(off, slope, seen.astype(float))

    def log_likelihood(self, covariance: FloatArray) -> FloatArray:
        """Of each row, the contexts integrated over their normal prior, float[n].

        Args:
            covariance: of the error, noise included, float[sensors, sensors].
        """
        whole = self.slope @ self.slope.transpose(0, 2, 1) + covariance
        own = np.arange(self.seen.shape[1])
        whole = whole * self.seen[:, :, None] * self.seen[:, None, :]
        whole[:, own, own] += 1.0 - self.seen
        root = np.linalg.cholesky(whole)
        height = np.linalg.solve(root, self.off[:, :, None])[:, :, 0]
        size = np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
        many = self.seen.sum(axis=1)
        return np.asarray(-0.5 * (height**2).sum(axis=1) - size - 0.5 * many * np.log(2.0 * np.pi))

    def __getitem__(self, rows: slice) -> "Linearised":
        return Linearised(self.off[rows], self.slope[rows], self.seen[rows])
