"""Which computed mode is which of those that are expected: by shape, never by number."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from rga.arrays import FloatArray, IntArray

#: what 1 - MAC of a mode and itself is, on average, where the model errs and sensors are noisy
SHAPE_ERROR = 0.05
#: pairings that are as good but for this are all carried: a factor of a hundred in probability
DOUBTFUL = 4.6
#: relative distance of frequencies below which shapes may be mixed at will
CLOSE = 1e-4
#: cost of a pair beside which any other is better
IMPOSSIBLE = 1e6


@dataclass(frozen=True)
class Expected:
    """What a mode looks like.

    Attributes:
        near: frequency about which it is expected [Hz].
        within: share of that by which it may well differ.
        at: numbers of the points of its shape, int[points].
        shape: its motion there, float[points]; empty: known by its frequency alone.
    """

    near: float
    within: float
    at: IntArray
    shape: FloatArray


@dataclass(frozen=True)
class Pairing:
    """Expected modes and the computed ones that they are.

    Attributes:
        computed: number of the computed mode of each, int[expected]; -1: none is left for it.
        mac: modal assurance criterion of all pairs, float[expected, computed]; NaN without shape.
        cost: of the pairs, as a negative logarithm of a probability.
        others: pairings that are nearly as probable, each with its cost.
    """

    computed: IntArray
    mac: FloatArray
    cost: float
    others: tuple[tuple[IntArray, float], ...]


def mac(one: FloatArray, other: FloatArray) -> float:
    """Modal assurance criterion of two shapes: 1 where they are alike but for their scale.

    Source: Allemang, The modal assurance criterion - twenty years of use and abuse, Sound and
    Vibration 37, 2003.

    >>> mac(np.array([1.0, 2.0]), np.array([-2.0, -4.0])), mac(np.eye(2)[0], np.eye(2)[1])
    (1.0, 0.0)
    """
    lengths = float((one @ one) * (other @ other))
    return float((one @ other) ** 2 / lengths) if lengths > 0 else 0.0


def paired(
    expected: Sequence[Expected],
    frequencies: FloatArray,
    shapes: FloatArray,
    unpaired: float = IMPOSSIBLE,
) -> Pairing:
    """The most probable pairing of all modes at once.

    Args:
        expected: modes.
        frequencies: of computed modes, or of those of a window [Hz], float[computed].
        shapes: of these at all points, float[computed, points]; NaN where one did not measure.
        unpaired: cost of a mode without a pair, as a negative logarithm of a probability.
    """
    table = np.array([[_mac(one, shape) for shape in shapes] for one in expected]).reshape(
        len(expected), len(shapes)
    )
    near = np.array([one.near for one in expected])[:, None]
    within = np.array([one.within for one in expected])[:, None]
    cost = 0.5 * (np.log(frequencies / near) / within) ** 2
    cost = np.minimum(cost + np.nan_to_num(1.0 - table) / SHAPE_ERROR, IMPOSSIBLE)
    best = _assigned(cost, unpaired)
    total = _cost(cost, best, unpaired)
    others: list[tuple[IntArray, float]] = []
    for number, chosen in enumerate(best):
        if chosen < 0:
            continue
        without = cost.copy()
        without[number, chosen] = IMPOSSIBLE
        other = _assigned(without, unpaired)
        dearer = _cost(cost, other, unpaired) - total
        if dearer < DOUBTFUL and not any(np.array_equal(other, one) for one, _ in others):
            others.append((other, total + dearer))
    return Pairing(best, table, total, tuple(sorted(others, key=lambda one: one[1])))


def turned(
    expected: Sequence[Expected], pairing: Pairing, frequencies: FloatArray, shapes: FloatArray
) -> FloatArray:
    """Shapes of the paired modes at all points, to the scale of what is expected.

    Modes of as good as equal frequency have shapes that may be mixed at will: theirs are the
    mixture that comes nearest (least squares), where there are points enough.

    Args:
        expected, frequencies, shapes: as for `paired`.
        pairing: of these.

    Returns:
        float[expected, points]; NaN where a mode has no pair.
    """
    found = np.full((len(expected), shapes.shape[1]), np.nan)
    for number, (one, chosen) in enumerate(zip(expected, pairing.computed, strict=True)):
        if chosen < 0:
            continue
        alike = np.abs(frequencies / frequencies[chosen] - 1.0) < CLOSE
        space = shapes[alike]
        if not len(one.shape):
            found[number] = shapes[chosen] / np.abs(shapes[chosen]).max(initial=1e-300)
            continue
        if len(one.at) <= len(space):
            space = shapes[[chosen]]
        mixture, *_ = np.linalg.lstsq(space[:, one.at].T, one.shape, rcond=None)
        found[number] = mixture @ space
    return found


def _mac(one: Expected, shape: FloatArray) -> float:
    seen = np.isfinite(shape[one.at])
    return mac(one.shape[seen], shape[one.at][seen]) if seen.any() else np.nan


def _assigned(cost: FloatArray, unpaired: float) -> IntArray:
    count, computed = cost.shape
    alone = np.full((count, count), unpaired)
    _, columns = scipy.optimize.linear_sum_assignment(np.hstack([cost, alone]))
    return np.where(columns < computed, columns, -1)


def _cost(cost: FloatArray, chosen: IntArray, unpaired: float) -> float:
    pairs = [(row, column) for row, column in enumerate(chosen) if column >= 0]
    lost = len(chosen) - len(pairs)
    return float(sum(cost[pair] for pair in pairs)) + lost * unpaired
