"""What of a measured shape no structure makes: errors of single points.

A structure that is not as it is modelled swings in other mixtures of much the same modes. What a
sensor does to one point is no such mixture, however wrong the model is.
"""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.simulation.modal.expected import Expected
from rga.simulation.modal.mixed_shapes import STILL

#: share by which a stiffness may be off anywhere, at least and at most, and as a multiple of what
#: frequencies are off together
WRONG, FOLLOWING = (0.08, 0.25), 8.0
#: a perturbation mixes modes by that share over twice the distance of their frequencies (Fox and
#: Kapoor, AIAA Journal 6, 1968), and at most at will
AT_WILL = 1.0
#: how much of a mode may be in its own shape: its scale is free
FREE = 10.0
#: least spread of a point about such mixtures, the shape of length one, and how many times that of
#: the point in the middle it is. Measured: 0.003 on simulated bridges, 0.01 on a real footbridge,
#: whose worst point of 58 lies 2.6 times that off
LEAST, TIMES = 0.01, 1.5
#: share of the points that may be wrong, and by how much the spread must shrink without one of them
WRONG_POINTS, SMALLER = 0.1, 0.5
#: sets of shapes of which the errors are kept, and share of a square that is rounding
KEPT, ROUNDING = 64, 1e-13


def stiffness_off(off: FloatArray) -> float:
    """By how much a stiffness may be off, where frequencies are by so much [ln], float[modes].

    What is wrong of a structure, and mixes its modes, moves frequencies as well.
    """
    return float(np.clip(FOLLOWING * np.sqrt(np.mean(off**2)), *WRONG))


def mixing(
    looks: Sequence[Expected],
    log_f: FloatArray,
    shapes: FloatArray,
    number: IntArray,
    wrong: float,
) -> FloatArray:
    """How much of each computed mode may be in each measured shape, float[modes, computed].

    Over the length of the mode itself at the points.

    Args:
        looks: the measured modes.
        log_f: of all computed modes [ln Hz], float[computed].
        shapes: of these for the same modal mass at the points, float[computed, points].
        number: which of them each measured mode is, int[modes].
        wrong: share by which a stiffness may be off anywhere.
    """
    apart = np.abs(log_f - log_f[number][:, None])
    sizes = np.minimum(AT_WILL, 0.5 * wrong / np.maximum(apart, 1e-12))
    sizes[np.arange(len(number)), number] = FREE
    lengths = np.array(
        [np.linalg.norm(shapes[one, look.at]) for one, look in zip(number, looks, strict=True)]
    )
    least = max(STILL * float(np.abs(shapes).max(initial=0.0)), 1e-300)
    return np.asarray(sizes / np.maximum(lengths, least)[:, None])


class PointErrors:
    """How far points of measured shapes lie off any mixture of modes.

    Args:
        looks: the measured modes.
        shapes: all modes of the model as given at the points, float[computed, points].
        sizes: how much of each may be in each measured one, as `mixing` has it,
            float[modes, computed].

    Attributes:
        spread: standard deviation of a point about such mixtures.
    """

    def __init__(self, looks: Sequence[Expected], shapes: FloatArray, sizes: FloatArray) -> None:
        self._looks = looks
        self.spread = max(LEAST, TIMES * self._in_the_middle(shapes, sizes))
        self._known: dict[bytes, list[tuple[FloatArray, float]]] = {}

    def off(self, shapes: FloatArray, sizes: FloatArray) -> list[FloatArray]:
        """What is at single points of the measured shapes, whitened, float[points of it] each.

        Args:
            shapes: all modes of a structure as sensors at the points record them,
                float[computed, points].
            sizes: how much of each may be in each measured one, float[modes, computed].
        """
        return [off for off, _ in self._told(shapes, sizes)]

    def freedom(self, shapes: FloatArray, sizes: FloatArray) -> FloatArray:
        """What such shapes leave possible: half the log determinant of each mode, float[modes]."""
        return np.array([freedom for _, freedom in self._told(shapes, sizes)])

    def _told(self, shapes: FloatArray, sizes: FloatArray) -> list[tuple[FloatArray, float]]:
        """Both, of each mode."""
        key = shapes.tobytes() + sizes.tobytes()
        if key not in self._known:
            self._known[key] = [
                self._of(look.shape, one[:, None] * shapes[:, look.at])
                for look, one in zip(self._looks, sizes, strict=True)
            ]
            if len(self._known) > KEPT:
                # The first is that of no cause, which is asked for most.
                del self._known[list(self._known)[1]]
        return self._known[key]

    def _of(self, shape: FloatArray, parts: FloatArray) -> tuple[FloatArray, float]:
        """What mixtures of parts of random size leave of a shape, and half the log determinant."""
        # Of many modes at few points the points are the smaller side.
        many = len(parts) > len(shape)
        side = (parts.T if many else parts) / self.spread
        squares, within = np.linalg.eigh(side @ side.T)
        some = squares > ROUNDING * squares[-1:]
        squares, within = squares[some], within[:, some]
        if not many:
            within = side.T @ (within / np.sqrt(squares))
        shrunk = 1.0 - 1.0 / np.sqrt(1.0 + squares)
        white = (shape - within @ (shrunk * (within.T @ shape))) / self.spread
        return white, 0.5 * float(np.log1p(squares).sum())

    def _in_the_middle(self, shapes: FloatArray, sizes: FloatArray) -> float:
        """How far the point in the middle lies off what all others say of it.

        A point that is wrong says wrong things of all: without it, and without no other, they
        agree much better.
        """
        kept = np.unique(np.concatenate([look.at for look in self._looks]))
        least = self._middle_of(kept, shapes, sizes)
        for _ in range(int(WRONG_POINTS * len(kept))):
            without = [kept[kept != one] for one in kept]
            spreads = [self._middle_of(some, shapes, sizes) for some in without]
            best, second = np.argsort(spreads)[:2]
            if spreads[best] > SMALLER * min(least, spreads[second]):
                break
            least, kept = spreads[best], without[best]
        return least

    def _middle_of(self, points: IntArray, shapes: FloatArray, sizes: FloatArray) -> float:
        """The same of some points alone."""
        off, counts = np.zeros(shapes.shape[1]), np.zeros(shapes.shape[1])
        for look, one in zip(self._looks, sizes, strict=True):
            some = np.isin(look.at, points)
            at = look.at[some]
            if not len(at):
                continue
            parts = one[:, None] * shapes[:, at]
            along, size, _ = np.linalg.svd(parts.T / LEAST, full_matrices=False)
            told = along * (size**2 / (1.0 + size**2))
            # One of normal variables lies off the others' word by its part of C^-1 x over C^-1's.
            left = look.shape[some] - told @ (along.T @ look.shape[some])
            off[at] += (left / (1.0 - (told * along).sum(1))) ** 2
            counts[at] += 1
        seen = counts > 0
        return float(np.sqrt(np.median(off[seen] / counts[seen]))) if seen.any() else 0.0
