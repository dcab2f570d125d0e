"""What sensors have in common, taken out."""

import numpy as np

from rga.model.parameter import FloatArray

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
    whole = np.where(np.isfinite(scores), scores, 0.0)
    chance, correlation = drawn_in(whole)
    sensors = scores.shape[1]
    if chance > CHANCE:
        return np.eye(sensors)
    # Half the rows tell by how much the other half's matrix leaves their variance too large;
    # from all rows the excess is half of that.
    parts = whole[::2], whole[1::2]
    others = [inverse_root(drawn_in(part)[1]) for part in parts]
    variance = np.mean(
        [((part @ other) ** 2).mean() for part, other in zip(parts, others[::-1], strict=True)]
    )
    return np.asarray(inverse_root(correlation) / np.sqrt((1.0 + variance) / 2.0))


def drawn_in(scores: FloatArray) -> tuple[float, FloatArray]:
    """The part of the scatter of a correlation that is due to chance, and what is left of it."""
    rows, sensors = scores.shape
    scale = np.sqrt(np.maximum((scores**2).mean(axis=0), 1e-12))
    scaled = scores / scale
    correlation = scaled.T @ scaled / rows
    off = correlation - np.eye(sensors)
    spread = float((off**2).sum())
    # Variance of the products of the scores of two sensors, summed over pairs, over rows.
    squares = scaled**2
    noise = float((squares.T @ squares).sum() / rows - (correlation**2).sum())
    diagonal = float(((squares**2).mean(axis=0) - 1.0).sum())
    chance = min(1.0, (noise - diagonal) / rows / spread) if spread > 0 else 1.0
    return chance, np.eye(sensors) + (1.0 - chance) * off


def inverse_root(correlation: FloatArray) -> FloatArray:
    """The symmetric matrix whose square is the inverse."""
    values, vectors = np.linalg.eigh(correlation)
    return np.asarray((vectors / np.sqrt(np.maximum(values, 1e-6))) @ vectors.T)
