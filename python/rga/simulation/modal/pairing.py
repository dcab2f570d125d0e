"""Which computed mode is which of those that are expected: by shape, never by number."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from rga.arrays import FloatArray, IntArray
from rga.simulation.modal.expected import FEWEST, SHAPE_ERROR, Expected
from rga.simulation.modal.mixed_shapes import COUPLING

#: pairings that are as good but for this are all carried: a factor of a hundred in probability
DOUBTFUL = 4.6
#: relative distance of frequencies below which shapes may be mixed at will
CLOSE = 1e-4
#: cost of a pair beside which any other is better
IMPOSSIBLE = 1e6


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


def paired(
    expected: Sequence[Expected],
    frequencies: FloatArray,
    shapes: FloatArray,
    unpaired: float = IMPOSSIBLE,
    unlike: FloatArray | None = None,
    freedom: FloatArray | float = 0.0,
) -> Pairing:
    """The most probable pairing of all modes at once.

    Pairings that differ by modes of as good as the same frequency are one.

    Args:
        expected: modes.
        frequencies: of computed modes, or of those of a window [Hz], float[computed].
        shapes: of these at all points, float[computed, points]; NaN where one did not measure.
        unpaired: cost of a mode without a pair, as a negative logarithm of a probability.
        unlike: 1 - MAC of all pairs where close modes may be mixed, as `unlike_mixed` has it,
            float[expected, computed]; None: as they are.
        freedom: what that takes off the probability of each pair, as `unlike_computed` has it,
            float[expected, computed].
    """
    table = np.array([_macs(one, shapes) for one in expected]).reshape(len(expected), len(shapes))
    near = np.array([one.near for one in expected])[:, None]
    within = np.array([one.within for one in expected])[:, None]
    cost = 0.5 * (np.log(frequencies / near) / within) ** 2
    apart = 1.0 - table if unlike is None else unlike
    cost = np.minimum(cost + np.nan_to_num(apart) / SHAPE_ERROR + freedom, IMPOSSIBLE)
    best = _assigned(cost, unpaired)
    if unlike is not None:
        best = _in_order(best, cost, near[:, 0], frequencies)
    total = _cost(cost, best, unpaired)
    others: list[tuple[IntArray, float]] = []
    for number, chosen in enumerate(best):
        if chosen < 0:
            continue
        without = cost.copy()
        without[number, chosen] = IMPOSSIBLE
        other = _assigned(without, unpaired)
        dearer = _cost(cost, other, unpaired) - total
        known = (best >= 0) & (other >= 0)
        moved = np.abs(np.log(frequencies[other[known]] / frequencies[best[known]]))
        if unlike is not None and known.all() and moved.max() < COUPLING:
            continue
        if unlike is not None and _reordered(best, other, near[:, 0]):
            continue
        if dearer < DOUBTFUL and not any(np.array_equal(other, one) for one, _ in others):
            others.append((other, total + dearer))
    return Pairing(best, table, total, tuple(sorted(others, key=lambda one: one[1])))


def mixture(
    expected: Sequence[Expected], computed: IntArray, log_f: FloatArray, shapes: FloatArray
) -> FloatArray:
    """The rotation of close modes by which they come nearest to what is expected.

    Of modes whose frequencies are nearer than what is not modelled couples, none has a shape of its
    own: a model that is changed a little turns them by any angle. A mode without a pair that is as
    good as of the same frequency turns with them. Source: orthogonal Procrustes problem,
    Schoenemann, Psychometrika 31, 1966.

    Args:
        expected: modes, each with a pair.
        computed: number of the computed mode of each, int[expected].
        log_f: of the computed modes [ln Hz], float[computed].
        shapes: of these for the same modal mass at all points, float[computed, points].

    Returns:
        Orthogonal, float[computed, computed]: by it, shapes of the computed modes become those that
        are nearest.
    """
    rotation = np.eye(len(log_f))
    alone = np.setdiff1d(np.arange(len(log_f)), computed)
    for close in close_modes(np.arange(len(computed)), log_f[computed]):
        apart = np.abs(log_f[alone][:, None] - log_f[computed[close]])
        every = np.concatenate([computed[close], alone[(apart < CLOSE).any(axis=1)]])
        if len(every) == 1:
            continue
        own = shapes[every]
        alike = np.array([own[:, expected[one].at] @ expected[one].shape for one in close])
        left, _, right = np.linalg.svd(alike)
        right[: len(close)] = left @ right[: len(close)]
        rotation[np.ix_(every, every)] = right
    return rotation


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


def _macs(one: Expected, shapes: FloatArray) -> FloatArray:
    """Of a mode and shapes, float[computed]; NaN where these say nothing of each other."""
    there = shapes[:, one.at]
    seen = np.isfinite(there)
    own = np.where(seen, there, 0.0)
    lengths = (own**2).sum(1) * (seen @ one.shape**2)
    along = (own @ one.shape) ** 2
    alike = np.divide(along, lengths, out=np.zeros(len(shapes)), where=lengths > 0)
    told = (seen.sum(axis=1) >= FEWEST) & one.shape.any()
    return np.where(told, alike, np.nan)


def _in_order(
    best: IntArray, cost: FloatArray, near: FloatArray, frequencies: FloatArray
) -> IntArray:
    """A pairing in which close modes, where shapes do not decide, keep the order of frequencies."""
    order = np.argsort(near, kind="stable")
    for low, high in pairwise(order):
        pair, chosen = np.array([low, high]), best[[low, high]]
        if (chosen < 0).any() or np.log(near[high] / near[low]) > COUPLING:
            continue
        if frequencies[chosen[0]] <= frequencies[chosen[1]]:
            continue
        if cost[pair, chosen[::-1]].sum() < cost[pair, chosen].sum() + DOUBTFUL:
            best = best.copy()
            best[pair] = chosen[::-1]
    return best


def _reordered(best: IntArray, other: IntArray, near: FloatArray) -> bool:
    """Whether a pairing differs by the order of modes that are expected close to each other."""
    return all(
        (best[close] >= 0).all() and set(best[close]) == set(other[close])
        for close in close_modes(np.flatnonzero(best != other), np.log(near))
    )


def close_modes(numbers: IntArray, log_f: FloatArray) -> list[IntArray]:
    """Modes part by part, each of modes whose frequencies are close to each other.

    Args:
        numbers: of modes, int[k].
        log_f: of all modes [ln Hz], float[modes].

    >>> [part.tolist() for part in close_modes(np.arange(3), np.log([4.0, 9.0, 4.01]))]
    [[0, 2], [1]]
    """
    order = numbers[np.argsort(log_f[numbers], kind="stable")]
    return np.split(order, np.flatnonzero(np.diff(log_f[order]) > COUPLING) + 1)


def _assigned(cost: FloatArray, unpaired: float) -> IntArray:
    count, computed = cost.shape
    alone = np.full((count, count), unpaired)
    _, columns = scipy.optimize.linear_sum_assignment(np.hstack([cost, alone]))
    return np.where(columns < computed, columns, -1)


def _cost(cost: FloatArray, chosen: IntArray, unpaired: float) -> float:
    pairs = [(row, column) for row, column in enumerate(chosen) if column >= 0]
    lost = len(chosen) - len(pairs)
    return float(sum(cost[pair] for pair in pairs)) + lost * unpaired
