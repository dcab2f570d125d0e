"""Several contexts that one row of readings may mean."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: candidates within so many spreads of each other belong to one peak
REACH = 3.0


@dataclass(frozen=True)
class Candidates:
    """What a network holds possible, row by row.

    Attributes:
        value: latent contexts in their units, float[n, modes, latent].
        spread: standard deviation within each candidate, float[n, modes, latent].
        share: probability of each candidate, float[n, modes].
        reversed: bool[modes], candidates that take a train to go backwards.
    """

    value: FloatArray
    spread: FloatArray
    share: FloatArray
    reversed: NDArray[np.bool_]

    def rows(self, chosen: slice) -> "Candidates":
        """Some of the rows."""
        return Candidates(
            self.value[chosen], self.spread[chosen], self.share[chosen], self.reversed
        )

    def mean(self) -> tuple[FloatArray, FloatArray]:
        """The values that are off least in the mean square, and their standard deviations.

        Returns:
            float[n, latent] each.

        >>> share = np.array([[0.75, 0.25]])
        >>> two = Candidates(np.array([[[0.0], [80.0]]]), np.ones((1, 2, 1)), share, share[0] < 0)
        >>> tuple(part.round(2).tolist() for part in two.mean())
        ([[20.0]], [[34.66]])
        """
        share = self.share[..., None]
        value = (share * self.value).sum(1)
        off = self.spread**2 + (self.value - value[:, None]) ** 2
        return value, np.sqrt((share * off).sum(1))

    def best(self) -> tuple[FloatArray, FloatArray]:
        """The most probable values, and how far the truth is expected from them.

        Returns:
            Values and root-mean-square distances, float[n, latent] each.

        >>> share = np.array([[0.75, 0.25]])
        >>> two = Candidates(np.array([[[0.0], [80.0]]]), np.ones((1, 2, 1)), share, share[0] < 0)
        >>> tuple(part.round(2).tolist() for part in two.best())
        ([[0.0]], [[40.01]])
        """
        # Neighbours that overlap stand for one peak: the candidate where they pile up is taken,
        # and the mean of what lies within its reach.
        reach = REACH * self.spread[:, None]
        distance = (self.value[:, :, None] - self.value[:, None]) / reach
        height = self.share[:, None] * np.exp(
            -0.5 * (distance**2).sum(-1) - np.log(self.spread).sum(-1)[:, None]
        )
        chosen = height.sum(2).argmax(1)
        near = height[np.arange(len(chosen)), chosen]
        near = near / near.sum(1, keepdims=True)
        value = (near[..., None] * self.value).sum(1)
        off = self.spread**2 + (self.value - value[:, None]) ** 2
        return value, np.sqrt((self.share[..., None] * off).sum(1))


def joined(parts: Sequence[Candidates]) -> Candidates:
    """Rows of the same network, one part after the other."""
    return Candidates(
        np.concatenate([part.value for part in parts]),
        np.concatenate([part.spread for part in parts]),
        np.concatenate([part.share for part in parts]),
        parts[0].reversed,
    )
