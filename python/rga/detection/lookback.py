"""Did the baseline itself change?"""

import numpy as np
from scipy.stats import kstwobign

from rga.detection.calibration import Calibration
from rga.detection.reference import Reference
from rga.detection.statistic import STATISTICS
from rga.model.parameter import FloatArray


def changed(reference: Reference, baseline: FloatArray, simulated: Calibration) -> float:
    """Probability that chance makes a baseline as changeable as this one.

    It is looked at twice: by the statistics, which find what comes suddenly, and by how far sums of
    scores, and of their squares, wander between its ends, which finds what changes slowly.

    Args:
        reference: that was learned from the baseline.
        baseline: float[rows, sensors], NaN where missing.
        simulated: what the statistics reach by chance.
    """
    never = np.full(len(STATISTICS), np.inf)
    statistics = reference.statistics(never, len(baseline))
    statistics.update_many(baseline)
    sudden = simulated.chance(np.asarray(statistics.take_peaks(), dtype=float), len(baseline))
    scores = statistics.recent().astype(float)
    slow = 2.0 * min(wandering(scores), wandering(scores**2))
    return min(1.0, 2.0 * min(sudden, slow))


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
    return float(min(1.0, values.shape[1] * kstwobign.sf(distance.max())))
