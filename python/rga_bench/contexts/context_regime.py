"""Contexts of measured rows: how they lie in the ranges of the model."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.special import ndtr

from rga.arrays import FloatArray
from rga.errors import InputError

#: that a method is calibrated under
MANNERS = ("same", "shifted", "held out", "smooth")
#: that rows of a stream have before a drift, and behind one
SEASONS = ("ordinary", "elsewhere", "beyond")
#: contexts of which a part of the range is special
MARKED = 2
#: that part, at the upper end
PART = 0.3
#: contexts lie so far beyond their ranges, in widths of these, at most
BEYOND = 0.25
#: parameters of the Beta distribution of contexts that are concentrated at one end
CONCENTRATED = (5.0, 2.0)
#: rows by which the correlation of a course falls to 1/e
MEMORY = 30.0


@dataclass(frozen=True)
class Contexts:
    """How contexts of measured rows are distributed.

    Of the manners, `same` is even over the ranges, `shifted` concentrated at the upper end of the
    marked contexts and the lower end of the others, `held out` even, where the source lacks the
    upper part of the marked contexts, and `smooth` even, as a course with memory. Of the seasons,
    `ordinary` is even without the corner in which all marked contexts are in their upper part,
    `elsewhere` even over this corner, and `beyond` even, with the marked contexts above their
    ranges.

    Attributes:
        manner: one of the manners or the seasons.
        ranges: smallest and largest of each context, float[contexts, 2].
        marked: bool[contexts].
    """

    manner: str
    ranges: FloatArray
    marked: NDArray[np.bool_]

    @classmethod
    def drawn(cls, manner: str, ranges: FloatArray, generator: np.random.Generator) -> "Contexts":
        """With marked contexts that are drawn.

        Raises:
            InputError: no such manner.
        """
        if manner not in (*MANNERS, *SEASONS):
            known = ", ".join((*MANNERS, *SEASONS))
            raise InputError(f"there is no manner {manner!r}", "contexts", f"give one of {known}")
        marked = np.zeros(len(ranges), dtype=bool)
        marked[generator.choice(len(ranges), min(MARKED, len(ranges)), replace=False)] = True
        return cls(manner, ranges, marked)

    @property
    def source(self) -> FloatArray:
        """Ranges that simulated rows cover, float[contexts, 2]."""
        low, high = self.ranges.T
        if self.manner != "held out":
            return self.ranges
        return np.column_stack([low, high - PART * self.marked * (high - low)])

    def draw(self, rows: int, generator: np.random.Generator) -> FloatArray:
        """Contexts of consecutive rows, float[rows, contexts]."""
        low, high = self.ranges.T
        return np.asarray(low + (high - low) * self._shares(rows, generator))

    def _shares(self, rows: int, generator: np.random.Generator) -> FloatArray:
        """The same as shares of the ranges."""
        shape = (rows, len(self.ranges))
        share = generator.random(shape)
        if self.manner == "shifted":
            beta = generator.beta(*CONCENTRATED, shape)
            return np.where(self.marked, beta, 1.0 - beta)
        if self.manner == "smooth":
            # An autoregression of order 1, whose normal distribution is made even.
            memory = np.exp(-1.0 / MEMORY)
            steps = generator.standard_normal(shape) * np.sqrt(1.0 - memory**2)
            steps[0] /= np.sqrt(1.0 - memory**2)
            return np.asarray(ndtr(lfilter([1.0], [1.0, -memory], steps, axis=0)))
        if self.manner == "ordinary":
            while (corner := (share[:, self.marked] > 1.0 - PART).all(axis=1)).any():
                share[corner] = generator.random((corner.sum(), shape[1]))
        if self.manner == "elsewhere":
            share[:, self.marked] = 1.0 - PART * share[:, self.marked]
        if self.manner == "beyond":
            share[:, self.marked] = 1.0 + BEYOND * share[:, self.marked]
        return share
