"""How noisy the sensors are, with what memory, and how far off the measured contexts.

The noise is estimated on what no linear structure can explain: the part of each channel that is
not a combination of the load coefficients, nor a step at one moment, nor a drift from one on. So an
effect that is hidden in the record does not pass for noise, as long as it leaves the structure
linear; one that changes with time may pass for a little of it. Tails that are heavier than Gaussian
ones are drawn in, so that least squares treat the readings as their noise deserves.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.linalg import lstsq
from scipy.optimize import minimize_scalar
from scipy.special import gammaln

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance
from rga.numerics.decompositions import thin_svd

#: rounds of expectation and maximisation, which end a few percent off and in places a sixth; the
#: next estimate of the same record begins where they end
ITERATIONS = 12
#: correlation from row to row beyond which noise is as good as a random walk
LARGEST_MEMORY = 0.995
#: a step: a jump from one row to the next of so many robust deviations of such jumps, by which the
#: median of so many rows before and after differs too
JUMP, BESIDE = 6.0, 12
#: log likelihood by which a channel must grow from a row on rather than wander by a long memory:
#: 1 in 100 random walks of 120 readings reach it (E. Zivot and D. W. K. Andrews, J. Business &
#: Economic Statistics 10, 1992, table 4: t = -5.57)
GROWS = 14.0
#: moments from which on it may grow
MOMENTS = 30
#: share of its squares that a line must keep beside the loads, to be no sum of them
SEEN = 1e-10
#: in the place of nothing, to divide by
TINY = 1e-300
#: excess of the innovations' kurtosis, in standard deviations, beyond which tails are heavy
HEAVY = 3.7
#: degrees of freedom of heavy tails to begin with, and bounds of one over them
FREEDOM, INVERSE_FREEDOM = 5.0, (0.01, 0.5)
#: readings before and after each whose median may be its level
ABOUT = 12


def unexplainable(
    residual: FloatArray,
    observed: BoolArray,
    basis: FloatArray,
    context_error: FloatArray | float = 0.0,
) -> FloatArray:
    """The part of a residual that no linear structure under these loads has.

    Args:
        residual: float[rows, sensors].
        observed: bool[rows, sensors].
        basis: float[rows, patterns], the load coefficients.
        context_error: part of the residual that errors of contexts account for, float[rows,
            sensors]. Steps and drifts are looked for beside it: it is the same error in many
            channels, and may be larger from row to row than a step of one of them.

    Returns:
        float[rows, sensors], scaled for the degrees of freedom that the fit takes.
    """
    span = _orthonormal(basis, max(1, len(residual) // 12))
    own = residual - context_error
    left = _left(own, observed, span)
    moment = _step(left, observed, span)
    if moment is not None:
        # A step would else pass for noise with a long memory, the better the larger it is.
        step = (np.arange(len(residual)) >= moment).astype(float)
        span = np.column_stack([span, step])
        left = _left(own, observed, span)
    begun = _growth(left, observed, span)
    if begun is not None:
        clock = np.arange(len(residual)) / len(residual)
        later = np.maximum(clock - clock[begun], 0.0)
        span = np.column_stack([span, clock, later])
    return _left(residual, observed, span)


def _left(residual: FloatArray, observed: BoolArray, span: FloatArray) -> FloatArray:
    left = np.zeros_like(residual)
    for sensor in range(residual.shape[1]):
        seen = observed[:, sensor]
        if seen.sum() > 2 * span.shape[1]:
            weights = lstsq(span[seen], residual[seen, sensor])[0]
            rest = residual[seen, sensor] - span[seen] @ weights
            left[seen, sensor] = rest * np.sqrt(seen.sum() / (seen.sum() - span.shape[1]))
        else:
            left[seen, sensor] = residual[seen, sensor]
    return left


def _step(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
    """The row at which the channels jump most and stay, if any does.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    best: tuple[float, int] | None = None
    for sensor in range(left.shape[1]):
        rows = np.flatnonzero(observed[:, sensor])
        column, rest = _with_whole_step(left[rows, sensor], span[rows])
        jumps = np.abs(np.diff(column))
        scale = 1.4826 * float(np.median(np.abs(np.diff(rest)))) if len(jumps) else 0.0
        for place in np.flatnonzero(jumps > JUMP * scale) + 1 if scale > 0 else ():
            if not BESIDE <= place <= len(column) - BESIDE:
                continue
            before, after = column[place - BESIDE : place], column[place : place + BESIDE]
            shift = abs(float(np.median(after) - np.median(before))) / scale
            if shift > JUMP and (best is None or shift > best[0]):
                best = (shift, int(rows[place]))
    return None if best is None else best[1]


def _growth(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
    """The row from which on a channel drifts in another way than before, if any does.

    A reading is predicted by the one before, with a line that bends at a row or without: what only
    wanders needs no such line. The loads fit a large drift in part, so that they are fitted anew
    beside it.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    best: tuple[float, int] | None = None
    for sensor in range(left.shape[1]):
        rows = np.flatnonzero(observed[:, sensor])
        column, clock = left[rows, sensor], np.arange(len(rows) - 1) / len(rows)
        loads = span[rows]
        before = np.column_stack([np.ones(len(clock)), column[:-1], loads[1:], loads[:-1]])
        freedom = len(clock) - before.shape[1]
        if freedom <= 4 * BESIDE:
            continue
        places = np.linspace(BESIDE, len(rows) - BESIDE, MOMENTS).astype(int)
        bends = np.maximum(clock[:, None] - clock[places - 1], 0.0)
        # All moments at once: what neither the loads nor the reading before predicts of each line.
        known, strength, _ = thin_svd(before)
        known = known[:, strength > 1e-12 * strength[0]]
        together = np.column_stack([column[1:], clock, bends])
        rest = together - known @ (known.T @ together)
        unexplained, lines = rest[:, 0], rest[:, 1:]
        lines = np.where((lines**2).sum(0) > SEEN * (together[:, 1:] ** 2).sum(0), lines, 0.0)
        line, bends = lines[:, 0], lines[:, 1:]
        whole = np.maximum((bends**2).sum(0), TINY)
        bends = bends - np.outer(line, line @ bends) / max(float(line @ line), TINY)
        bends = np.where((bends**2).sum(0) > SEEN * whole, bends, 0.0)
        fitted = (line @ unexplained) ** 2 / max(float(line @ line), TINY)
        fitted = fitted + (bends.T @ unexplained) ** 2 / np.maximum((bends**2).sum(0), TINY)
        wandering = max(float(unexplained @ unexplained), TINY)
        gained = -freedom / 2 * np.log(np.maximum(1 - fitted / wandering, SEEN))
        place = int(np.argmax(gained))
        if gained[place] > GROWS and (best is None or gained[place] > best[0]):
            best = (float(gained[place]), int(rows[places[place]]))
    return None if best is None else best[1]


def _with_whole_step(left: FloatArray, span: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a fit leaves, given back what it took of the likeliest step; and less that step.

    The loads fit a large step in part, and what they put there hides it among jumps of their own.

    Args:
        left: float[readings].
        span: of the fit, float[readings, k].
    """
    readings = len(left)
    if readings <= max(2 * BESIDE, 2 * span.shape[1]):
        return left, left
    basis, _ = np.linalg.qr(span)
    later = np.cumsum(basis[::-1], axis=0)[::-1]
    along = np.cumsum(left[::-1])[::-1]
    own = np.arange(readings, 0, -1) - (later**2).sum(1)
    # A step that the loads fit whole says nothing.
    gained = np.where(own > 1.0, along**2 / np.maximum(own, 1.0), 0.0)
    place = BESIDE + int(np.argmax(gained[BESIDE : readings - BESIDE]))
    size = along[place] / max(own[place], 1.0)
    taken = basis @ later[place]
    step = (np.arange(readings) >= place).astype(float)
    return left + size * taken, left - size * (step - taken)


def estimate_noise(
    left: FloatArray,
    time: FloatArray,
    observed: BoolArray,
    context_jacobian: FloatArray,
    start: Noise,
    context_known: BoolArray,
    floor: FloatArray,
) -> tuple[Noise, FloatArray]:
    """Noise of the sensors and of the contexts by expectation and maximisation.

    Args:
        left: residual without what a model could explain, float[rows, sensors].
        time: float[rows] [s].
        observed: bool[rows, sensors].
        context_jacobian: float[rows, sensors, contexts].
        start: where to begin.
        context_known: bool[contexts], True where the model states the context's noise.
        floor: least standard deviation of each sensor, float[sensors].

    Returns:
        The noise, and what its tails add to the readings, float[rows, sensors]: zero where it is
        Gaussian.
    """
    noise, tails = start, np.zeros_like(left)

    def expected() -> _Expected:
        rows = RowCovariance(noise, time, observed, context_jacobian)
        return _Expected.of(rows, left, tails, context_known)

    for _ in range(ITERATIONS):
        noise = _gaussian(expected(), floor)
    gaussian = expected()
    middle, nearer = _levels(gaussian.rest, observed)
    if _excess(gaussian, middle) < HEAVY:
        return noise, tails
    noise = replace(noise, freedom=FREEDOM)
    for _ in range(ITERATIONS):
        noise, tails = _heavy_tailed(expected(), middle, nearer, floor)
    return noise, tails


@dataclass(frozen=True)
class _Expected:
    """What is expected of noise and contexts' errors under a covariance.

    Attributes:
        rows: the covariance.
        rest: noise of the readings, float[rows, sensors].
        hidden: its variance, by what is not known of the contexts' errors, float[rows, sensors].
        context_sigma: standard deviation of each context's error, float[contexts].
    """

    rows: RowCovariance
    rest: FloatArray
    hidden: FloatArray
    context_sigma: FloatArray

    @classmethod
    def of(
        cls, rows: RowCovariance, left: FloatArray, tails: FloatArray, context_known: BoolArray
    ) -> "_Expected":
        jacobian, sigma = rows.context_jacobian, rows.noise.context_sigma
        error = rows.context_error(left - tails)
        # The posterior variance of a context in its own row, neighbours left out.
        precise = np.einsum("ts,tsi,tsj->tij", rows.weight.T**2, jacobian, jacobian)
        variance = np.linalg.inv(precise + np.diag(sigma**-2.0))
        rest = np.where(rows.observed, left - np.einsum("tsi,ti->ts", jacobian, error), 0.0)
        hidden = np.einsum("tsi,tij,tsj->ts", jacobian, variance, jacobian)
        context = np.sqrt((error**2 + np.einsum("tii->ti", variance)).mean(0))
        return cls(
            rows,
            rest,
            np.where(rows.observed, hidden, 0.0),
            np.where(context_known, sigma, np.maximum(context, 1e-9)),
        )

    @property
    def deviation(self) -> FloatArray:
        """Root mean square of each sensor's noise, float[sensors]."""
        counts = np.maximum(self.rows.observed.sum(0), 1)
        return np.asarray(np.sqrt((self.rest**2 + self.hidden).sum(0) / counts))

    def innovations(self, level: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Whitened innovations of the noise about a level, and their expected squares.

        Both float[sensors, rows]; the level is float[rows, sensors].
        """
        white = self.rows.whiten((self.rest - level).T)
        return white, white**2 + self.rows.whitened_variance(self.hidden.T)

    @property
    def memory(self) -> FloatArray:
        """Correlation from one row to the next, float[sensors]."""
        rest, pairs = self.rest, self.rows.observed[1:] & self.rows.observed[:-1]
        product = (rest[1:] * rest[:-1] * pairs).sum(0)
        before = ((rest[:-1] ** 2 + self.hidden[:-1]) * pairs).sum(0)
        return np.asarray(np.clip(product / np.maximum(before, 1e-300), 0.0, LARGEST_MEMORY))


def _gaussian(expected: _Expected, floor: FloatArray) -> Noise:
    sigma = np.maximum(expected.deviation, floor)
    return Noise(sigma, expected.memory, expected.context_sigma, deviation=sigma)


def _levels(rest: FloatArray, observed: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Levels of the readings about each: the middle of before and after, and the nearer.

    Both float[rows, sensors]. What stays away for more than half of the readings before or after
    has moved, and is no tail of the noise.
    """
    middle, nearer = np.zeros_like(rest), np.zeros_like(rest)
    for sensor in range(rest.shape[1]):
        seen = observed[:, sensor]
        column = rest[seen, sensor]
        if len(column) <= 2 * ABOUT:
            continue
        windows = np.sort(sliding_window_view(column, ABOUT), axis=1)
        medians = (windows[:, (ABOUT - 1) // 2] + windows[:, ABOUT // 2]) / 2
        row = np.arange(len(column))
        before = medians[np.maximum(row - ABOUT, 0)]
        after = medians[np.minimum(row + 1, len(medians) - 1)]
        middle[seen, sensor] = (before + after) / 2
        close = np.abs(column - before) < np.abs(column - after)
        nearer[seen, sensor] = np.where(close, before, after)
    return middle, nearer


def _excess(expected: _Expected, level: FloatArray) -> float:
    """Excess kurtosis of the innovations in its standard deviations under Gaussian noise."""
    seen = expected.rows.observed.T
    _, squares = expected.innovations(level)
    squares = squares / np.maximum(squares.sum(1) / np.maximum(seen.sum(1), 1), 1e-300)[:, None]
    fourth = (squares**2 - 6 * squares + 3)[seen]
    return float(fourth.sum() / np.sqrt(24 * max(len(fourth), 1)))


def _heavy_tailed(
    expected: _Expected, middle: FloatArray, nearer: FloatArray, floor: FloatArray
) -> tuple[Noise, FloatArray]:
    """Innovations of Student's t: their scale and freedom, and what their tails add.

    A reading is drawn in to where one step of Fisher's scoring, from the level of its neighbours,
    puts it under Gaussian noise (Huber's pseudo-values). Estimates and evidence then are those of
    Student's t, to the first order.
    """
    rows, seen = expected.rows, expected.rows.observed.T
    widening = _widening(rows.noise.freedom)

    def weight(squares: FloatArray) -> FloatArray:
        return np.where(seen, (freedom + 1) / (freedom + widening * squares), 0.0)

    _, squares = expected.innovations(middle)
    freedom = _likeliest_freedom(widening * squares[seen])
    # Where the level itself moves, that is noise as well.
    _, whole = expected.innovations(np.zeros_like(middle))
    scale = (weight(squares) * whole).sum(1) / np.maximum(seen.sum(1), 1)
    noise = Noise(
        sigma=np.maximum(rows.noise.sigma * np.sqrt(scale * _widening(freedom)), floor),
        phi=rows.noise.phi,
        context_sigma=expected.context_sigma,
        deviation=np.maximum(expected.deviation, floor),
        freedom=freedom,
    )
    white, squares = expected.innovations(nearer)
    return noise, rows.coloured(white * (1 - _widening(freedom) * weight(squares))).T


def _widening(freedom: float) -> float:
    """Variance that Gaussian noise has where it informs as much as Student's t of scale one."""
    return (freedom + 3) / (freedom + 1)


def _likeliest_freedom(squares: FloatArray) -> float:
    """Degrees of freedom of Student's t of scale one, by squares of its values."""

    def loss(inverse: float) -> float:
        nu = 1 / inverse
        each = gammaln((nu + 1) / 2) - gammaln(nu / 2) - np.log(nu) / 2
        return float((nu + 1) / 2 * np.log1p(squares / nu).sum() - len(squares) * each)

    found = minimize_scalar(loss, bounds=INVERSE_FREEDOM, method="bounded", options={"xatol": 2e-3})
    return float(1 / found.x)


def _orthonormal(basis: FloatArray, most: int) -> FloatArray:
    with_constant = np.column_stack([np.ones(len(basis)), basis])
    scale = np.linalg.norm(with_constant, axis=0)
    u, s, _ = thin_svd(with_constant / np.where(scale > 0, scale, 1.0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, :most])
