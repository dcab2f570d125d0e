"""What a fit takes from noise with memory: of its size, and of its memory.

Noise that goes slowly looks much like courses that go slowly. Where such courses are fitted, what
is left is smaller than the degrees of freedom say, and forgets faster than the noise did. Both are
known for every memory: the residuals of a least squares fit are the noise times a projection.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray

#: correlation from one row to the next beyond which noise is as good as a random walk
LARGEST_MEMORY = 0.995
#: memories for which it is worked out: ever denser towards one, where little more forgets much less
MEMORIES = LARGEST_MEMORY * np.sin(np.linspace(0.0, np.pi / 2, 24))


@dataclass(frozen=True)
class FittedCourses:
    """What is left of noise beside courses that were fitted, for each of the `MEMORIES`.

    The residuals are those of the fit, times the square root of rows over degrees of freedom: their
    innovations are then as large as those of the noise.

    Attributes:
        memory: correlation of the residuals from one row to the next, never falling.
        variance: of the residuals, as a share of that of the noise; one without memory.
    """

    memory: FloatArray
    variance: FloatArray

    @classmethod
    def of(cls, span: FloatArray, time: FloatArray) -> "FittedCourses":
        """For courses float[rows, k] at moments float[rows] [s].

        >>> slow = np.cos(np.outer(np.arange(200), np.pi / 200 * np.arange(8)))
        >>> fitted = FittedCourses.of(slow, 600.0 * np.arange(200))
        >>> fitted.memory_of_noise(np.array([0.4])).round(2)
        array([0.46])
        """
        rows = len(time)
        q, _ = np.linalg.qr(span)
        step = np.diff(time)
        typical = float(np.median(step)) if rows > 1 else 1.0
        lag = MEMORIES[:, None] ** (step / max(typical, 1e-12))
        noisy = _times_covariance(lag, q)
        both = q.T @ noisy
        # Covariance of the residuals: S - q (S q)' - (S q) q' + q (q' S q) q', S that of the noise.
        inner = q @ both
        own = 1.0 - 2.0 * (noisy * q).sum(2) + (inner * q).sum(2)
        crossed = (q[:-1] * noisy[:, 1:]).sum(2) + (noisy[:, :-1] * q[1:]).sum(2)
        next_to = lag - crossed + (inner[:, :-1] * q[1:]).sum(2)
        scale = rows / max(rows - q.shape[1], 1)
        before, product = own[:, :-1].sum(1), next_to.sum(1)
        return cls(
            memory=np.maximum.accumulate(product / before),
            variance=scale * own.sum(1) / rows,
        )

    def memory_of_noise(self, residuals: FloatArray) -> FloatArray:
        """Memory of the noise, given that of the residuals, both float[channels]."""
        return np.interp(residuals, self.memory, MEMORIES)

    def share_left(self, memory: FloatArray) -> FloatArray:
        """Share of the variance that fitting leaves, given the noise's memory, float[channels]."""
        return np.interp(memory, MEMORIES, self.variance)


def _times_covariance(lag: FloatArray, columns: FloatArray) -> FloatArray:
    """Products of covariances of noise with columns, float[memories, rows, k].

    Args:
        lag: correlation of each row but the first with the one before, float[memories, rows - 1].
        columns: float[rows, k].
    """
    found = np.tile(columns, (len(lag), 1, 1))
    behind, ahead = np.zeros((2, len(lag), columns.shape[1]))
    for row in range(1, len(columns)):
        behind = lag[:, row - 1, None] * (behind + columns[row - 1])
        found[:, row] += behind
    for row in range(len(columns) - 2, -1, -1):
        ahead = lag[:, row, None] * (ahead + columns[row + 1])
        found[:, row] += ahead
    return found
