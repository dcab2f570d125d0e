"""Where contexts that nothing measures lie in the rows at hand: found with the rest.

Rows of ordinary days fill a part of the ranges alone. Were they thought to fill all of it, a
structure that is too stiff would please its contexts, as these would then be as large as the ranges
say. So contexts are normal around a mean and with a deviation of their own (parametric empirical
Bayes: Morris, JASA 78, 1983), which cost a structure of another stiffness nothing.
"""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: the deviation that is thought of at first, and smallest and largest, in that of the range
USUAL, SMALLEST, LARGEST = 0.6, 0.01, 1.3
#: deviations from their mean within which contexts may be expected
EXPECTED = 2.0


class PopulationEquations(NamedTuple):
    """Second derivatives and slope of minus the log posterior, by means and logs of deviations.

    Attributes:
        cross: with contexts, float[rows, contexts, 2 contexts].
        own: float[2 contexts, 2 contexts].
        down: minus the slope, float[2 contexts].
    """

    cross: FloatArray
    own: FloatArray
    down: FloatArray


@dataclass(frozen=True)
class Population:
    """Contexts of the measured rows as a whole, in standard units.

    Attributes:
        mean: float[contexts].
        log_width: logs of the deviations, float[contexts].
    """

    mean: FloatArray
    log_width: FloatArray

    @classmethod
    def unknown(cls, contexts: int) -> Self:
        """That which is thought of before any row: all of the ranges."""
        return cls(np.zeros(contexts), np.zeros(contexts))

    @classmethod
    def of(cls, z: FloatArray, unsure: FloatArray) -> Self:
        """That of rows with their variances, float[rows, contexts] each."""
        width = np.sqrt(z.var(axis=0) + unsure.mean(axis=0))
        return cls(z.mean(axis=0), np.log(np.clip(width, SMALLEST, LARGEST)))

    @property
    def width(self) -> FloatArray:
        """Deviations, float[contexts]."""
        return np.asarray(np.exp(self.log_width))

    def fills(self, edge: float) -> NDArray[np.bool_]:
        """Whether contexts may be expected at the ends of their ranges, bool[contexts].

        Args:
            edge: an end, in standard units.

        >>> Population(np.zeros(2), np.log([0.4, 1.0])).fills(1.7).tolist()
        [False, True]
        """
        return np.asarray(np.abs(self.mean) + EXPECTED * self.width > edge)

    def moved(self, change: FloatArray) -> "Population":
        """The same with its means and logs of deviations changed, float[2 contexts]."""
        mean, log_width = np.split(change, 2)
        ends = np.log(SMALLEST), np.log(LARGEST)
        return Population(self.mean + mean, np.clip(self.log_width + log_width, *ends))

    def equations(
        self, z: FloatArray, inside: FloatArray, of_it: NDArray[np.bool_]
    ) -> PopulationEquations:
        """What the rows say of it.

        Args:
            z: contexts in standard units, float[rows, contexts].
            inside: variances of them, float[rows, contexts].
            of_it: those that nothing measured, bool[rows, contexts].
        """
        off = np.where(of_it, (z - self.mean) / self.width, 0.0)
        count = of_it.sum(axis=0)
        each = np.eye(len(self.mean))
        by_mean = -np.where(of_it, self.width**-2.0, 0.0)[:, :, None] * each
        # As of a sum of squares, so that no part of it is negative.
        by_width = -np.sqrt(2.0) * (off / self.width)[:, :, None] * each
        down = [
            off.sum(axis=0) / self.width - self.mean,
            (off**2).sum(axis=0) + self._volume(inside, of_it) - count - self._unusual,
        ]
        both = np.diag(np.sqrt(2.0) * off.sum(axis=0) / self.width)
        own = np.block(
            [
                [np.diag(count / self.width**2 + 1.0), both],
                [both, np.diag(2.0 * (off**2).sum(axis=0) + 1.0)],
            ]
        )
        cross = np.concatenate([by_mean, by_width], axis=2)
        return PopulationEquations(cross, own, np.concatenate(down))

    def cost(self, inside: FloatArray, of_it: NDArray[np.bool_], about: "Population") -> float:
        """Minus twice its log posterior beside that of the contexts, the volume linear about one.

        Args:
            inside, of_it: as above.
            about: that under which `inside` was found.
        """
        linear = of_it.sum(axis=0) - about._volume(inside, of_it)
        own = (self.mean**2 + self._unusual**2).sum()
        return float(2.0 * linear @ self.log_width + own)

    def _volume(self, inside: FloatArray, of_it: NDArray[np.bool_]) -> FloatArray:
        return np.asarray(np.where(of_it, inside, 0.0).sum(axis=0) / self.width**2)

    @property
    def _unusual(self) -> FloatArray:
        return np.asarray(self.log_width - np.log(USUAL))
