"""What gap a calibrated twin may have: noise, and a model that is off by a share of what it says.

As-built structures differ from their model by a few percent everywhere. The squared gap that this
makes grows with the response, so the gap under a heavy load must not be held against that of quiet
rows.
"""

import numpy as np
import scipy

from rga.arrays import FloatArray

#: largest share by which a calibrated model is taken to be off
LARGEST = 0.05
#: stretches that are drawn of calibrated rows
DRAWS = 1000
#: numbers of stretches that are looked at together
AT_ONCE = 1_000_000


def scatter_share(gaps: FloatArray, simulated: FloatArray, noise: FloatArray) -> float:
    """The share e by which the model is off, so that gaps are noise^2 + (e simulated)^2.

    Args:
        gaps: squared gaps of calibrated rows, float[rows, channels], NaN where missing.
        simulated: float[rows, channels].
        noise: standard deviation of each channel's noise, float[channels].

    >>> simulated = np.full((9, 2), 10.0)
    >>> round(scatter_share(np.full((9, 2), 1.25), simulated, np.ones(2)), 3)
    0.05
    """

    def excess(share: float) -> float:
        return against_expected(gaps, simulated, noise, share) - 1.0

    if not excess(0.0) > 0:
        return 0.0
    if excess(LARGEST) > 0:
        return LARGEST
    return float(scipy.optimize.brentq(excess, 0.0, LARGEST, xtol=1e-6))


def against_expected(
    gaps: FloatArray, simulated: FloatArray, noise: FloatArray, share: float
) -> float:
    """Gap over the gap to expect: the median over rows of the mean over sensors [-].

    Args:
        gaps, simulated: float[rows, channels], NaN where missing.
        noise: float[channels].
        share: by which the model is off [-]; 0: the gap over the variance of the noise.

    >>> against_expected(np.array([[4.0, np.nan], [1.0, 3.0]]), np.zeros((2, 2)), np.ones(2), 0.0)
    3.0
    """
    by_row = rows_against_expected(gaps, simulated, noise, share)
    known = np.isfinite(by_row)
    return float(np.median(by_row[known])) if known.any() else float("nan")


def rows_against_expected(
    gaps: FloatArray, simulated: FloatArray, noise: FloatArray, share: float
) -> FloatArray:
    """The same of each row, float[rows]; NaN where nothing is known of one [-].

    >>> rows_against_expected(np.array([[4.0, np.nan], [1.0, 3.0]]), np.zeros((2, 2)),
    ...                       np.ones(2), 0.0)
    array([4., 2.])
    """
    return of_rows(channels_against_expected(gaps, simulated, noise, share))


def channels_against_expected(
    gaps: FloatArray, simulated: FloatArray, noise: FloatArray, share: float
) -> FloatArray:
    """The same of each channel in each row, float[rows, channels] [-]."""
    return np.asarray(gaps / (noise**2 + (share * simulated) ** 2))


def of_rows(scaled: FloatArray) -> FloatArray:
    """Mean over channels of each row, float[rows], of float[rows, channels] with NaN."""
    known = np.isfinite(scaled).any(axis=1)
    by_row = np.full(len(scaled), np.nan)
    by_row[known] = np.nanmean(scaled[known], axis=1)
    return by_row


def usual_bound(by_row: FloatArray, rows: int, share: float, seed: int) -> float:
    """What the median over so many rows stays below, were they as the calibration's rows are [-].

    Args:
        by_row: gap over the gap to expect of the calibrated rows, float[n], NaN where not known.
        rows: how many rows the median is over.
        share: of such stretches that stay below.
        seed: of the draws.

    >>> calm = 1.0 + 0.1 * np.sin(np.arange(200.0))
    >>> 1.0 < usual_bound(calm, 40, 0.99, seed=0) < 1.1
    True
    """
    known = by_row[np.isfinite(by_row)]
    if not len(known) or not rows:
        return float("inf")
    return float(np.quantile(_medians_of_stretches(known, rows, seed), share))


def channel_medians(scaled: FloatArray) -> FloatArray:
    """Median over rows, float[channels], NaN where not known, of float[rows, channels]."""
    known = np.isfinite(scaled).any(axis=0)
    medians = np.full(scaled.shape[1], np.nan)
    medians[known] = np.nanmedian(scaled[:, known], axis=0)
    return medians


def channel_bound(scaled: FloatArray, rows: int, share: float, seed: int) -> float:
    """What no channel's median over so many rows exceeds, in multiples of that over all rows [-].

    Args:
        scaled: gap over the gap to expect, float[n, channels], NaN where not known.
        rows: how many rows the median is over.
        share: of such stretches in which all channels stay below.
        seed: of the draws.

    >>> calm = np.random.default_rng(0).chisquare(1, size=(200, 5))
    >>> 1.2 < channel_bound(calm, 40, 0.99, seed=0) < 5.0
    True
    """
    medians = channel_medians(scaled)
    known = scaled[np.isfinite(scaled).any(axis=1)][:, medians > 0]
    if not known.size or not rows:
        return float("inf")
    # A reading that is missing is taken as an ordinary one.
    times = np.nan_to_num(known / medians[medians > 0], nan=1.0)
    drawn = _medians_of_stretches(times, rows, seed)
    return float(np.quantile(drawn.max(axis=1), share))


def _medians_of_stretches(values: FloatArray, rows: int, seed: int) -> FloatArray:
    """Medians over stretches of so many rows, float[DRAWS, ...], of float[n, ...].

    Stretches are made of blocks of neighbours, which are alike: a moving-block bootstrap (Kuensch,
    Annals of Statistics 17, 1989).
    """
    known = len(values)
    length = max(1, min(round(np.sqrt(known)), rows))
    draw, ahead = np.random.default_rng(seed), np.arange(length)
    at_once = max(1, AT_ONCE * known // (rows * values.size))
    medians = []
    for first in range(0, DRAWS, at_once):
        size = min(at_once, DRAWS - first), -(-rows // length)
        starts = draw.integers(0, known - length + 1, size=size)
        chosen = (starts[:, :, None] + ahead).reshape(len(starts), -1)[:, :rows]
        medians.append(np.median(values[chosen], axis=1))
    return np.concatenate(medians)
