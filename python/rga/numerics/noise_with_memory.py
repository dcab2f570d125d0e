"""Noise of series that keep something of what they were, beside steps that come and stay."""

import numpy as np

from rga.arrays import FloatArray
from rga.numerics.robust_spread import robust_spread

#: most that one value says of the next
MOST_MEMORY = 0.95
#: lags that tell the memory, pairs of values that tell of one, and usual sizes beyond which a
#: difference is drawn in
LAGS, PAIRS, FAR_OUT = (1, 2, 3), 3, 3.0
MEMORIES = np.linspace(0.0, MOST_MEMORY, 96)


def noise_with_memory(series: FloatArray) -> tuple[FloatArray, float]:
    """Standard deviations of noise, and how much of it each value keeps of the one before.

    By differences over one, two and three rows: what comes and stays moves few of them. Of noise
    with memory m and variance s^2 the variance over k rows is 2 s^2 (1 - m^k).

    Args:
        series: float[rows, k], all of the same memory; NaN where nothing was measured.

    Returns:
        float[k], NaN where too little was measured; the memory.

    >>> draw = np.random.default_rng(0).normal(size=(400, 3))
    >>> draw[200:] += 5.0
    >>> spreads, memory = noise_with_memory(draw)
    >>> spreads.round(1).tolist(), round(memory, 1)
    ([1.0, 1.0, 1.0], 0.1)
    """
    variances = np.array([[_variance(own[lag:] - own[:-lag]) for own in series.T] for lag in LAGS])
    told = np.log(np.maximum(variances[:, np.isfinite(variances).all(axis=0)], 1e-300))
    memory = 0.0
    if told.size:
        expected = np.log1p(-(MEMORIES[:, None] ** np.array(LAGS)))
        memory = float(MEMORIES[np.argmin((told.mean(axis=1) - expected).std(axis=1))])
    return np.sqrt(variances[0] / (2.0 * (1.0 - memory))), memory


def _variance(differences: FloatArray) -> float:
    """Of differences about zero, the few that are far out drawn in."""
    known = differences[np.isfinite(differences)]
    if len(known) < PAIRS:
        return np.nan
    usual = robust_spread(known)
    return float((np.clip(known, -FAR_OUT * usual, FAR_OUT * usual) ** 2).mean())
