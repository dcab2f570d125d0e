"""What of a measured shape no structure makes: errors of single points.

A structure that is not as it is modelled swings in other mixtures of much the same modes. What a
sensor does to one point is no such mixture, however wrong the model is.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.simulation.modal.pairing import STILL, Expected, freedom_of_parts, without_parts

#: share by which a stiffness may be off anywhere: a perturbation mixes modes by it over twice the
#: distance of their frequencies (Fox and Kapoor, AIAA Journal 6, 1968), and at most at will
WRONG, AT_WILL = 0.25, 1.0
#: how much of a mode may be in its own shape: its scale is free
FREE = 10.0
#: least spread of a point about such mixtures, the shape of length one, and how many times that of
#: the point in the middle it is. Measured: 0.003 on simulated bridges, 0.01 on a real footbridge,
#: whose worst point of 58 lies 2.6 times that off
LEAST, TIMES = 0.01, 1.5
#: sets of shapes of which the errors are kept
KEPT = 64


@dataclass(frozen=True)
class PointErrors:
    """How far points of measured shapes lie off any mixture of the model's modes.

    Attributes:
        looks: the measured modes.
        sizes: how much of each computed mode may be in each, over the length of the mode itself at
            the points, float[modes, computed].
        usual: the computed modes at the points, float[computed, points].
        spread: standard deviation of a point about such mixtures.
    """

    looks: Sequence[Expected]
    sizes: FloatArray
    usual: FloatArray
    spread: float
    _known: dict[bytes, list[tuple[FloatArray, float]]] = field(default_factory=dict)

    @classmethod
    def of(
        cls, looks: Sequence[Expected], log_f: FloatArray, shapes: FloatArray, number: IntArray
    ) -> "PointErrors":
        """Those of measured modes.

        Args:
            looks: the measured modes.
            log_f: of the modes of the model as given [ln Hz], float[computed].
            shapes: of these for the same modal mass at the points, float[computed, points].
            number: which of them each measured mode is, int[modes].
        """
        apart = np.abs(log_f - log_f[number][:, None])
        sizes = np.minimum(AT_WILL, 0.5 * WRONG / np.maximum(apart, 1e-12))
        sizes[np.arange(len(number)), number] = FREE
        lengths = np.array(
            [np.linalg.norm(shapes[one, look.at]) for one, look in zip(number, looks, strict=True)]
        )
        least = max(STILL * float(np.abs(shapes).max(initial=0.0)), 1e-300)
        sizes /= np.maximum(lengths, least)[:, None]
        errors = cls(looks, sizes, shapes, LEAST)
        return cls(looks, sizes, shapes, max(LEAST, TIMES * errors._in_the_middle()))

    def off(self, shapes: FloatArray) -> list[FloatArray]:
        """What is at single points of the measured shapes, whitened, float[points of it] each.

        Args:
            shapes: the modes of the model as sensors at the points record them,
                float[computed, points].
        """
        return [off for off, _ in self._told(shapes)]

    def freedom(self, shapes: FloatArray) -> FloatArray:
        """What such shapes leave possible: half the log determinant of each mode, float[modes]."""
        return np.array([freedom for _, freedom in self._told(shapes)])

    def _told(self, shapes: FloatArray) -> list[tuple[FloatArray, float]]:
        """Both, of each mode."""
        key = shapes.tobytes()
        if key not in self._known:
            parts = [self._parts(mode, shapes) for mode in range(len(self.looks))]
            self._known[key] = [
                (without_parts(look.shape, own, self.spread), freedom_of_parts(own, self.spread))
                for look, own in zip(self.looks, parts, strict=True)
            ]
            if len(self._known) > KEPT:
                # The first is that of sensors that are right, which is asked for most.
                del self._known[list(self._known)[1]]
        return self._known[key]

    def _parts(self, mode: int, shapes: FloatArray) -> FloatArray:
        return np.asarray(self.sizes[mode][:, None] * shapes[:, self.looks[mode].at])

    def _in_the_middle(self) -> float:
        """How far the point in the middle lies off what all others say of it."""
        squares, counts = np.zeros(self.usual.shape[1]), np.zeros(self.usual.shape[1])
        for mode, look in enumerate(self.looks):
            if not len(look.at):
                continue
            along, sizes, _ = np.linalg.svd(self._parts(mode, self.usual).T / self.spread, False)
            told = along * (sizes**2 / (1.0 + sizes**2))
            # One of normal variables lies off the others' word by its part of C^-1 x over C^-1's.
            left = look.shape - told @ (along.T @ look.shape)
            squares[look.at] += (left / (1.0 - (told * along).sum(1))) ** 2
            counts[look.at] += 1
        some = counts > 0
        return float(np.sqrt(np.median(squares[some] / counts[some]))) if some.any() else 0.0
