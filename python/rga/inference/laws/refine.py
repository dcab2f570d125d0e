"""The line of a context, brought to where the simulation fits the readings best."""

from collections.abc import Callable

import numpy as np
import scipy

from rga.arrays import FloatArray

#: the neighbourhood of a start that is scanned, to each side in shares of the range, and its steps
NEAR, SCANNED = 0.025, 11
#: rows with less than this share of the greatest change show no load
LOADED = 0.05
#: sensors that are at least taken to be left to disagree, beside two that set the line
FEWEST = 0.1
#: passes that measure anew how far each sensor is off, and steps of a pass
PASSES, STEPS = 3, 15


def polish_line(
    read: Callable[[FloatArray], FloatArray],
    seen: FloatArray,
    noise: FloatArray,
    time: FloatArray,
    line: FloatArray,
    span: tuple[float, float],
    rate: tuple[float, float],
) -> tuple[FloatArray, FloatArray]:
    """Level and slope of a line by robust least squares on the simulation.

    Wagons resemble each other, and the misfit has a valley for each: the neighbourhood of the start
    is scanned before the descent.

    What is wrong with a model stays wrong from row to row: rows are not independent. The
    covariance takes each sensor as one cluster (Liang and Zeger, Longitudinal data analysis using
    generalized linear models, Biometrika 73, 1986), so that the interval is what sensors disagree
    on.

    Args:
        read: values of the context on all rows, float[rows] -> readings, float[rows, sensors].
        seen: measured, float[rows, sensors], NaN where missing.
        noise: standard deviation of each sensor's noise, float[sensors]; NaN for one that is not
            looked at.
        time: of the rows [s], float[rows], rising; two rows or more.
        line: where to start, float[rows].
        span: range of the context.
        rate: range of the slope.

    Returns:
        Value at the mean time and slope, float[2], and their covariance, float[2, 2].

    >>> time = np.linspace(0.0, 10.0, 21)
    >>> influence = lambda place: np.stack([np.sin(place), np.cos(place)], axis=1)
    >>> seen = influence(0.3 + 0.2 * time)
    >>> start = 0.5 + 0.15 * time
    >>> found, _ = polish_line(influence, seen, np.full(2, 1e-3), time, start, (0, 3), (-1, 1))
    >>> found.round(4)
    array([1.3, 0.2])
    """
    half = (time[-1] - time[0]) / 2
    basis = np.column_stack([np.ones(len(time)), (time - time.mean()) / half])
    slopes = (rate[0] * half, rate[1] * half)
    width = np.array([span[1] - span[0], slopes[1] - slopes[0]])

    def off(level: FloatArray) -> FloatArray:
        return np.where(np.isfinite(noise), np.nan_to_num(read(basis @ level) - seen), 0.0)

    def misfit(level: FloatArray) -> float:
        """Minus the log likelihood when each sensor has errors of its own size."""
        return float(np.nansum(np.log(np.mean(off(level) ** 2, axis=0) + noise**2)))

    starts = _around(basis, seen, line, width[0])
    found = min((np.array([at, np.clip(rise, *slopes)]) for at, rise in starts), key=misfit)
    for _ in range(PASSES):
        scale = np.fmax(np.sqrt(np.mean(off(found) ** 2, axis=0)), noise)
        fit = scipy.optimize.least_squares(
            lambda level, scale=scale: (off(level) / scale).ravel(),
            found,
            loss="soft_l1",
            bounds=([-np.inf, slopes[0]], [np.inf, slopes[1]]),
            x_scale=width / 10,
            max_nfev=STEPS,
        )
        found = fit.x
    # least_squares gives derivatives as its loss weighs them, and residuals as they are.
    weighed = fit.fun * (1.0 + fit.fun**2) ** 0.25
    jacobian = fit.jac.reshape(*seen.shape, 2)
    pull = np.einsum("rsp,rs->sp", jacobian, weighed.reshape(seen.shape))
    normal = fit.jac.T @ fit.jac + np.diag(12.0 / width**2)
    inverse = np.linalg.inv(normal)
    # Sensors that hardly see the load yet do not count: what is left after two are used up.
    leverage = np.einsum("rsp,pq,rsq->s", jacobian, inverse, jacobian)
    seeing = leverage.sum() ** 2 / max((leverage**2).sum(), 1e-300)
    few = seeing / max(seeing - 2.0, FEWEST)
    covariance = inverse @ (few * pull.T @ pull + normal) @ inverse
    per_time = np.array([1.0, 1.0 / half])
    return found * per_time, covariance * np.outer(per_time, per_time)


def _around(
    basis: FloatArray, seen: FloatArray, line: FloatArray, width: float
) -> list[FloatArray]:
    """Lines near a line, moved at the first and at the last of the rows that show a load."""
    filled = np.nan_to_num(seen)
    change = np.where(np.isfinite(seen), np.abs(filled - np.median(filled, axis=0)), 0.0).max(
        axis=1
    )
    loaded = basis[np.flatnonzero(change > LOADED * change.max(initial=0.0)), 1]
    first, last = (loaded[0], loaded[-1]) if len(loaded) > 1 else (-1.0, 1.0)
    level = np.array([line.mean(), (line[-1] - line[0]) / 2])
    moves = width * np.linspace(-NEAR, NEAR, SCANNED)
    return [
        level + np.array([before * last - after * first, after - before]) / (last - first)
        for before in moves
        for after in moves
    ]
