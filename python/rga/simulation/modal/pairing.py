"""Which computed mode is which of those that are expected: by shape, never by number."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from rga.arrays import FloatArray, IntArray

#: square of the length below which a shape is rounding
LEAST_LENGTH = float(np.finfo(float).tiny)
#: share of the longest shape below which a shape is rounding: the mode moves none of the points
STILL = 1e-12
#: points that say anything of a shape: at a single one all are alike
FEWEST = 2
#: what 1 - MAC of a mode and itself is, on average, where the model errs and sensors are noisy
SHAPE_ERROR = 0.05
#: pairings that are as good but for this are all carried: a factor of a hundred in probability
DOUBTFUL = 4.6
#: share by which what is not modelled couples modes: the nearer their frequencies, the more of one
#: is in the shape of the other; parts of another mode that are less than the second say nothing
COUPLING, LEAST_PART = 0.004, 0.05
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
        shape: its motion there, float[points]; empty, or zero all over: known by its frequency
            alone.
    """

    near: float
    within: float
    at: IntArray
    shape: FloatArray

    @property
    def unseen(self) -> bool:
        """Whether all points of its shape stand still in it, and so see nothing of it."""
        return len(self.shape) > 0 and not self.shape.any()


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
    unlike: FloatArray | None = None,
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
    """
    table = np.array([_macs(one, shapes) for one in expected]).reshape(len(expected), len(shapes))
    near = np.array([one.near for one in expected])[:, None]
    within = np.array([one.within for one in expected])[:, None]
    cost = 0.5 * (np.log(frequencies / near) / within) ** 2
    apart = 1.0 - table if unlike is None else unlike
    cost = np.minimum(cost + np.nan_to_num(apart) / SHAPE_ERROR, IMPOSSIBLE)
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


def couplings(log_f: FloatArray) -> FloatArray:
    """How much of each mode may be in the others, float[modes, modes]; none in itself.

    A perturbation of the stiffness mixes modes by its share over the distance of their eigenvalues
    (Fox and Kapoor, AIAA Journal 6, 1968); modes of the same frequency are any mixture.

    Args:
        log_f: of all modes [ln Hz], float[modes].
    """
    size = COUPLING / np.maximum(np.abs(log_f[:, None] - log_f), COUPLING)
    np.fill_diagonal(size, 0.0)
    return np.where(size > LEAST_PART, size, 0.0)


def parts_of_others(log_f: FloatArray, shapes: FloatArray, number: int) -> FloatArray:
    """What of other modes may be in the shape of one, by what no model has (`couplings`).

    Args:
        log_f: of all modes [ln Hz], float[modes].
        shapes: of these for the same modal mass, float[modes, points].
        number: of the one.

    Returns:
        float[k, points], over the length of its own shape.
    """
    lengths = np.linalg.norm(shapes, axis=1)
    length = max(float(lengths[number]), STILL * float(lengths.max()), 1e-300)
    size = couplings(log_f)[number]
    some = size > 0.0
    return np.asarray(size[some, None] * shapes[some] / length)


def unlike_mixed(shape: FloatArray, own: FloatArray, parts: FloatArray) -> float:
    """1 - MAC of a measured and a computed shape in which there may be parts of other modes.

    Args:
        shape: measured, float[points]; NaN where a point did not.
        own: computed, float[points].
        parts: as `parts_of_others`, float[k, points].

    >>> turned = np.array([0.6, 0.8])
    >>> alone, beside = np.zeros((0, 2)), np.array([[0.0, 1.0]])
    >>> round(unlike_mixed(turned, np.eye(2)[0], alone), 3)
    0.64
    >>> round(unlike_mixed(turned, np.eye(2)[0], beside), 3)
    0.016
    """
    seen = np.isfinite(shape) & np.isfinite(own)
    whole = float(shape[seen] @ shape[seen])
    if whole == 0.0 or seen.sum() < FEWEST:
        return np.nan
    off, within = apart(shape[seen], own[seen], parts[:, seen])
    spread = np.sqrt(0.5 * SHAPE_ERROR * whole)
    white = without_parts(off, within, spread)
    return float(white @ white) * 0.5 * SHAPE_ERROR


def unlike_computed(
    expected: Sequence[Expected], coupled: FloatArray, shapes: FloatArray
) -> FloatArray:
    """The same of all expected modes and all computed ones, float[expected, computed].

    Args:
        expected: modes whose shapes were measured; of those that have none, or one of a single
            point, it is NaN.
        coupled: how much of each computed mode may be in the others, as `couplings` has it.
        shapes: of the computed modes for the same modal mass at all points,
            float[computed, points].
    """
    table = np.full((len(expected), len(shapes)), np.nan)
    where: dict[bytes, list[int]] = {}
    for number, one in enumerate(expected):
        if one.shape.any() and len(one.shape) >= FEWEST:
            where.setdefault(one.at.tobytes(), []).append(number)
    for numbers in where.values():
        measured = np.array([expected[number].shape for number in numbers])
        table[numbers] = _unlike(measured, coupled, shapes[:, expected[numbers[0]].at])
    return table


def _unlike(measured: FloatArray, coupled: FloatArray, shapes: FloatArray) -> FloatArray:
    """Of shapes that were measured at the same points float[k, points], float[k, computed]."""
    # All by products of shapes, as `apart` and `without_parts` for each of them, with the modes
    # that are coupled to each alone.
    products, along = shapes @ shapes.T, shapes @ measured.T
    squares = np.diag(products)
    squares = np.maximum(squares, max(STILL**2 * float(squares.max()), 1e-300))
    most = int((coupled > 0.0).sum(1).max(initial=0))
    near = np.argsort(-coupled, axis=1, kind="stable")[:, :most]
    sizes = np.take_along_axis(coupled, near, 1) / np.sqrt(squares)[:, None]
    crossed = np.take_along_axis(products, near, 1)
    off = along[near] - crossed[:, :, None] * (along / squares[:, None])[:, None, :]
    off *= sizes[:, :, None]
    own = crossed[:, :, None] * crossed[:, None, :] / squares[:, None, None]
    within = products[near[:, :, None], near[:, None, :]] - own
    within *= sizes[:, :, None] * sizes[:, None, :]
    within += 0.5 * SHAPE_ERROR * np.eye(most)
    explained = (off * np.linalg.solve(within, off)).sum(1)
    explained += along**2 / squares[:, None]
    return np.asarray(1.0 - explained.T / (measured**2).sum(1)[:, None])


def apart(shape: FloatArray, own: FloatArray, parts: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What of a shape, and of parts of others, is not along its own.

    Args:
        shape, own: float[points].
        parts: for a shape of length one, float[k, points].

    Returns:
        float[points], and float[k, points] for the length of this shape.
    """
    length = float(own @ own)
    if length < LEAST_LENGTH:
        return shape, parts
    size = float(np.linalg.norm(shape))
    off = shape - own * (float(own @ shape) / length)
    return off, size * (parts - np.outer(parts @ own / length, own))


def freedom_of_parts(parts: FloatArray, spread: float) -> float:
    """Half the logarithm of the determinant that parts of random size add to deviations."""
    sizes = np.linalg.svd(parts / spread, compute_uv=False) if len(parts) else np.zeros(0)
    return 0.5 * float(np.log1p(sizes**2).sum())


def without_parts(off: FloatArray, parts: FloatArray, spread: float) -> FloatArray:
    """Deviations over their spread, where parts of random size are among them: whitened."""
    if not len(parts):
        return np.asarray(off / spread)
    along, sizes, _ = np.linalg.svd(parts.T / spread, full_matrices=False)
    shrunk = 1.0 - 1.0 / np.sqrt(1.0 + sizes**2)
    white = off / spread
    return np.asarray(white - along @ (shrunk * (along.T @ white)))


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
