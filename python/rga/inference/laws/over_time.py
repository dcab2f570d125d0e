"""How a latent context moves: the estimates of single rows, combined over time."""

import numpy as np
import scipy
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference.laws.linear import fit_line
from rga.inference.laws.mixture import Candidates
from rga.model.schema import ContextVariable

#: rows whose data say less than this share of what the range says are passed over
LEAST_INFORMATION = 1e-3
#: drifts over the whole record that a smooth context is thought to make, in ranges
DRIFTS = (1e-5, 30.0)


def follow_law(
    time: FloatArray,
    estimates: FloatArray,
    spreads: FloatArray,
    variable: ContextVariable,
    shares: FloatArray | None = None,
    reversed_: NDArray[np.bool_] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Combine the estimates of single rows by the law of the variable.

    The result stands on all rows given; for a causal one, give the rows so far.

    Args:
        time: of the rows [s], float[n], not falling.
        estimates: of the context in its unit, float[n], or float[n, modes] where a row leaves
            several open; NaN where there is none.
        spreads: posterior standard deviation of each, of the same shape.
        variable: its law, range and rate.
        shares: probability of each, float[n, modes]; needed where there are several.
        reversed_: bool[modes], estimates that hold only where a line falls; the others then hold
            only where it rises. Left out, all hold for both.

    Returns:
        Estimates and spreads, float[n] each.

    >>> level = ContextVariable(unit="K", range=(-10, 10), law="constant")
    >>> rows = np.array([3.0, 3.0, 3.0, 9.0])
    >>> follow_law(np.arange(4.0), rows, np.full(4, 0.1), level)[0].round(1)
    array([3., 3., 3., 3.])
    """
    if shares is None:
        estimates, spreads = estimates[:, None], spreads[:, None]
        shares = np.ones_like(estimates)
    if len(time) == 0 or variable.law in ("independent", "smooth"):
        several = Candidates(
            estimates[..., None], spreads[..., None], shares, np.zeros(shares.shape[1], dtype=bool)
        )
        value, spread = (column[:, 0] for column in several.best())
        if len(time) == 0 or variable.law == "independent":
            return value, spread
        return _level(time, *without_prior(value, spread, variable), variable)
    value, information = without_prior(estimates, spreads, variable)
    rate = variable.rate if variable.law == "linear" else None
    return fit_line(time, value, information, shares, variable.range, rate, reversed_)


def without_prior(
    estimates: FloatArray, spreads: FloatArray, variable: ContextVariable
) -> tuple[FloatArray, FloatArray]:
    """What the rows alone say: an estimate holds the range as its prior, which must count once.

    Returns:
        Values, and their information (one over the variance), zero where a row says nothing;
        of the shape of the estimates.
    """
    low, high = variable.range
    prior = 12.0 / (high - low) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        whole = 1.0 / np.square(spreads)
        information = whole - prior
        value = (low + high) / 2 + (estimates - (low + high) / 2) * whole / information
    informative = np.isfinite(value) & np.isfinite(information)
    informative &= information > LEAST_INFORMATION * prior
    return np.where(informative, value, (low + high) / 2), np.where(informative, information, 0.0)


def _level(
    time: FloatArray, value: FloatArray, information: FloatArray, variable: ContextVariable
) -> tuple[FloatArray, FloatArray]:
    """Local-level model, its process variance by maximum likelihood (Durbin and Koopman, ch. 2)."""
    low, high = variable.range
    gaps = np.diff(time, prepend=time[0])
    span = max(float(time[-1] - time[0]), 1e-300)
    start = ((low + high) / 2, (high - low) ** 2 / 12)

    def variances(log_drift: float) -> FloatArray:
        return np.asarray(gaps / span * ((high - low) * np.exp(log_drift)) ** 2)

    def cost(log_drift: float) -> float:
        return _filter(value, information, variances(log_drift), start)[-1]

    grid = np.linspace(float(np.log(DRIFTS[0])), float(np.log(DRIFTS[1])), 25)
    best = int(np.argmin([cost(float(one)) for one in grid]))
    bounds = (grid[max(0, best - 1)], grid[min(len(grid) - 1, best + 1)])
    drift = variances(
        float(scipy.optimize.minimize_scalar(cost, bounds=bounds, method="bounded").x)
    )
    mean, variance, ahead, _ = _filter(value, information, drift, start)
    for row in range(len(time) - 2, -1, -1):
        share = variance[row] / ahead[row + 1]
        mean[row] += share * (mean[row + 1] - mean[row])
        variance[row] += share**2 * (variance[row + 1] - ahead[row + 1])
    return mean, np.sqrt(variance)


def _filter(
    value: FloatArray, information: FloatArray, drift: FloatArray, start: tuple[float, float]
) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    """Filtered means and variances, predicted variances, and minus the log likelihood."""
    mean, variance, ahead = (np.empty(len(value)) for _ in range(3))
    level, own = start
    cost = 0.0
    for row, (seen, informative) in enumerate(zip(value, information, strict=True)):
        own += drift[row]
        ahead[row] = own
        if informative > 0:
            off, total = seen - level, own + 1.0 / informative
            cost += 0.5 * (off * off / total + np.log(total))
            level += own / total * off
            own /= 1.0 + own * informative
        mean[row], variance[row] = level, own
    return mean, variance, ahead, float(cost)
