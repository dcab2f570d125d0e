"""Did the baseline itself change?"""

from dataclasses import replace

import numpy as np
from scipy.special import kolmogorov, ndtr

from rga.arrays import FloatArray
from rga.detection.baseline.baseline_model import Reference
from rga.detection.statistic import STATISTICS
from rga.detection.thresholds import TailModel

#: equal parts of a baseline that are held against each other
PARTS = 16


def changed(reference: Reference, baseline: FloatArray, simulated: TailModel) -> float:
    """Probability that chance makes a baseline as changeable as this one.

    It is looked at by the statistics, which find what comes suddenly; by how far sums of scores,
    and of their squares, wander between its ends, which finds what changes slowly; and by its
    parts, which find what changes so much that it was learned for memory.

    Args:
        reference: that was learned from the baseline.
        baseline: float[rows, sensors], NaN where missing.
        simulated: what the statistics reach by chance.
    """
    # What sensors have in common was learned from these rows: it leaves them a variance below 1.
    _, scores = watched(reference, baseline)
    size = np.sqrt(np.nanmean(scores**2))
    peaks, scores = watched(replace(reference, mixing=reference.mixing / size), baseline)
    sudden = simulated.chance(peaks, len(baseline))
    looks = sudden, wandering(scores), wandering(scores**2), alike_neighbours(baseline)
    return min(1.0, len(looks) * min(looks))


def watched(reference: Reference, rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The largest values of the statistics, float[statistics], and the scores, as rows."""
    never = np.full(len(STATISTICS), np.inf)
    statistics = reference.statistics(never, len(rows))
    statistics.update_many(rows)
    return np.asarray(statistics.take_peaks(), dtype=float), statistics.recent().astype(float)


def wandering(values: FloatArray) -> float:
    """Probability that sums of independent values wander as far in some sensor.

    Between their ends they are a Brownian bridge, whose largest distance from 0 has the
    distribution of Kolmogorov (Ploberger and Kraemer, Econometrica 60, 1992).

    Args:
        values: float[rows, sensors], NaN where missing.
    """
    known = np.isfinite(values)
    count = np.maximum(known.sum(axis=0), 1)
    less = np.where(known, values - np.nanmean(values, axis=0), 0.0)
    size = np.maximum(np.sqrt((less**2).sum(axis=0) / count), 1e-12)
    distance = np.abs(np.cumsum(less, axis=0)).max(axis=0) / size / np.sqrt(count)
    return float(min(1.0, values.shape[1] * kolmogorov(distance.max())))


def alike_neighbours(baseline: FloatArray) -> float:
    """Probability that neighbouring parts of a stationary sensor's readings are so much alike.

    The squared differences of the medians of neighbours, over those from the mean of all (von
    Neumann, Annals of Mathematical Statistics 12, 1941).

    Args:
        baseline: float[rows, sensors], NaN where missing.
    """
    rows = len(baseline) // PARTS * PARTS
    parts = baseline[:rows].reshape(PARTS, -1, baseline.shape[1])
    read = np.isfinite(parts).any(axis=1).all(axis=0)
    if not rows or not read.any():
        return 1.0
    medians = np.nanmedian(parts[:, :, read], axis=1)
    all_in_all = ((medians - medians.mean(axis=0)) ** 2).sum(axis=0)
    between = (np.diff(medians, axis=0) ** 2).sum(axis=0)
    ratio = np.divide(between, all_in_all, out=np.full_like(between, 2.0), where=all_in_all > 0)
    height = (1.0 - ratio / 2.0) * np.sqrt((PARTS**2 - 1) / (PARTS - 2))
    return float(min(1.0, len(height) * ndtr(-height.max())))
