"""What sensors have in common, taken out."""

import numpy as np

from rga.arrays import FloatArray
from rga.detection.baseline.incomplete import likeliest_covariance

#: variance of a sum of sensors below which they repeat each other, and their least part in it
REPEATED, PART = 0.02, 0.1
#: correlations that are for so large a part due to chance are taken for none
CHANCE = 0.8


def independence(scores: FloatArray) -> FloatArray:
    """The symmetric matrix that makes scores of sensors independent, and leaves each its sensor.

    The inverse square root of their correlation, which is first drawn to the identity as far as
    chance alone scatters it (Ledoit and Wolf, Journal of Multivariate Analysis 88, 2004). What it
    makes of rows that it was not learned from has a variance of 1.

    Args:
        scores: float[rows, sensors], NaN where missing.
    """
    correlation, chance = correlations(scores)
    if chance > CHANCE:
        return np.eye(len(correlation))
    # Half the rows show by how much the other half's matrix leaves their variance too large;
    # from all rows the excess is half of that.
    parts = [correlations(scores[first::2]) for first in (0, 1)]
    others = [inverse_root(drawn_in(*part)) for part in parts[::-1]]
    variance = np.mean(
        [np.diag(root @ part @ root) for root, (part, _) in zip(others, parts, strict=True)]
    )
    return np.asarray(inverse_root(drawn_in(correlation, chance)) / np.sqrt((1.0 + variance) / 2.0))


def correlations(scores: FloatArray) -> tuple[FloatArray, float]:
    """Of sensors, and the part of their scatter by chance.

    Where readings are missing, what chance leaves of them is the likeliest beside all that is
    there: rows need not be complete.

    Args:
        scores: float[rows, sensors], NaN where missing.
    """
    found, chance = pairwise(scores)
    if chance > CHANCE or np.isfinite(scores).all():
        return found, chance
    return as_correlation(likeliest_covariance(scores, found)), chance


def pairwise(scores: FloatArray) -> tuple[FloatArray, float]:
    """Of each two sensors over the rows that have both, and the part of their scatter by chance."""
    there = np.isfinite(scores).astype(float)
    whole = np.where(there > 0, scores, 0.0)
    squares = whole**2
    pairs = np.maximum(there.T @ there, 1.0)
    sizes = np.maximum(squares.T @ there, 1e-12)
    scale = np.sqrt(sizes * sizes.T) / pairs
    found = whole.T @ whole / pairs / scale
    others = ~np.eye(len(found), dtype=bool)
    # Variance of the products of the scores of two sensors, over rows.
    noise = (squares.T @ squares / pairs / scale**2 - found**2) / pairs
    spread = float((found[others] ** 2).sum())
    chance = min(1.0, float(noise[others].sum()) / spread) if spread > 0 else 1.0
    # Pairs from different rows may contradict each other.
    values, vectors = np.linalg.eigh(np.where(others, found, 1.0))
    return as_correlation((vectors * np.maximum(values, 0.0)) @ vectors.T), chance


def as_correlation(covariance: FloatArray) -> FloatArray:
    """The correlation of a covariance, float[sensors, sensors]."""
    own = np.sqrt(np.diag(covariance))
    return np.asarray(covariance / np.outer(own, own))


def drawn_in(correlation: FloatArray, chance: float) -> FloatArray:
    """A correlation without the part that is due to chance."""
    identity = np.eye(len(correlation))
    return np.asarray(identity + (1.0 - chance) * (correlation - identity))


def inverse_root(correlation: FloatArray) -> FloatArray:
    """The symmetric matrix whose square is the inverse."""
    values, vectors = np.linalg.eigh(correlation)
    return np.asarray((vectors / np.sqrt(np.maximum(values, 1e-6))) @ vectors.T)


def repeating(scores: FloatArray) -> list[int]:
    """Sensors that others nearly repeat: some sum of theirs hardly varies.

    Args:
        scores: float[rows, sensors], NaN where missing.
    """
    values, vectors = np.linalg.eigh(correlations(scores)[0])
    part = (vectors[:, values < REPEATED] ** 2).sum(axis=1)
    return [int(sensor) for sensor in np.flatnonzero(part > PART)]
