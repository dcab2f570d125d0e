"""How readings go with the ones before them."""

import numpy as np
import scipy
from scipy.special import ndtri

from rga.arrays import FloatArray

#: of an autoregression, at most
ORDER = 4
#: rows for each weight, at least
ROWS = 20
#: pairs of readings so many rows apart, at least
PAIRS = 30


def predictors(deviations: FloatArray) -> FloatArray:
    """Weights that predict a deviation from the ones before it, for each sensor its own.

    Yule and Walker's equations for the autocovariances of normal scores, which outliers do not
    disturb, solved order by order (Levinson); the order has the least BIC. Each lag is told by the
    pairs of readings so far apart, whatever is missing between them.

    Args:
        deviations: float[rows, sensors], NaN where missing.

    Returns:
        float[order, sensors], zeros beyond the order of a sensor.
    """
    rows, sensors = deviations.shape
    missing = ~np.isfinite(deviations)
    ranks = scipy.stats.rankdata(deviations, axis=0, nan_policy="omit")
    scores = ndtri((ranks - 0.5) / np.maximum(1, (~missing).sum(axis=0)), order="C")
    scores[missing] = 0.0
    there = (~missing).astype(float)
    most = min(ORDER, rows // ROWS)
    pairs = [
        np.maximum(1.0, (there[lag:] * there[: rows - lag]).sum(axis=0)) for lag in range(most + 1)
    ]
    covariance = [
        (scores[lag:] * scores[: rows - lag]).sum(axis=0) / pairs[lag] for lag in range(most + 1)
    ]
    best = np.zeros((most, sensors))
    weights = np.zeros((most, sensors))
    error = covariance[0].copy()
    criterion, least = np.zeros((2, sensors))
    for order in range(1, most + 1):
        left = covariance[order] - sum(
            (weights[lag] * covariance[order - 1 - lag] for lag in range(order - 1)),
            start=np.zeros(sensors),
        )
        reflection = np.clip(left / error, -0.999, 0.999)
        weights[: order - 1] -= reflection * weights[: order - 1][::-1]
        weights[order - 1] = reflection
        error = error * (1.0 - reflection**2)
        told = pairs[order] * (rows / (rows - order))
        criterion = criterion + told * np.log1p(-(reflection**2)) + np.log(told)
        better = (criterion < least) & (pairs[order] >= PAIRS)
        best[:, better] = weights[:, better]
        least = np.minimum(least, criterion)
    order = int((np.abs(best).sum(axis=1) > 0).nonzero()[0].max(initial=-1)) + 1
    return best[:order]
