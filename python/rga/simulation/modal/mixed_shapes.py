"""Shapes of modes in which there may be parts of others, by what no model has."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.simulation.modal.expected import FEWEST, SHAPE_ERROR, Expected

#: square of the length below which a shape is rounding
LEAST_LENGTH = float(np.finfo(float).tiny)
#: share of the longest shape below which a shape is rounding: the mode moves none of the points
STILL = 1e-6
#: share by which what is not modelled couples modes: the nearer their frequencies, the more of one
#: is in the shape of the other; parts of another mode that are less than the second say nothing
COUPLING, LEAST_PART = 0.004, 0.05


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
) -> tuple[FloatArray, FloatArray]:
    """The same of all expected modes and all computed ones, and how free their shapes are.

    A mode that hardly moves the points looks there as what is in it of others: as it may look like
    anything, it is no better for looking like what was measured (`freedom_of_parts`).

    Args:
        expected: modes whose shapes were measured; of those that have none, or one of a single
            point, it is NaN.
        coupled: how much of each computed mode may be in the others, as `couplings` has it.
        shapes: of the computed modes for the same modal mass at all points,
            float[computed, points].

    Returns:
        1 - MAC, and negative logarithms of a probability, float[expected, computed] each.
    """
    table, freedom = np.full((2, len(expected), len(shapes)), np.nan)
    where: dict[bytes, list[int]] = {}
    for number, one in enumerate(expected):
        if one.shape.any() and len(one.shape) >= FEWEST:
            where.setdefault(one.at.tobytes(), []).append(number)
    for numbers in where.values():
        measured = np.array([expected[number].shape for number in numbers])
        at = expected[numbers[0]].at
        table[numbers], freedom[numbers] = _unlike(measured, coupled, shapes[:, at])
    return table, np.nan_to_num(freedom)


def _unlike(
    measured: FloatArray, coupled: FloatArray, shapes: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Of shapes that were measured at the same points float[k, points].

    Returns:
        1 - MAC, float[k, computed]; what freedom takes off, float[computed].
    """
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
    freedom = 0.5 * (np.linalg.slogdet(within)[1] - most * np.log(0.5 * SHAPE_ERROR))
    explained = (off * np.linalg.solve(within, off)).sum(1)
    explained += along**2 / squares[:, None]
    return 1.0 - explained.T / (measured**2).sum(1)[:, None], freedom


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
