"""How noisy the sensors are, with what memory, and how far off the measured contexts.

The noise is estimated on what no linear structure can explain. Tails that are heavier than Gaussian
ones are drawn in, so that least squares treat the readings as their noise deserves.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view
from scipy.special import gammaln

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance

#: rounds of expectation and maximisation, which end a few percent off and in places a sixth; the
#: next estimate of the same record begins where they end
ITERATIONS = 12
#: correlation from row to row beyond which noise is as good as a random walk
LARGEST_MEMORY = 0.995
#: excess of the innovations' kurtosis, in standard deviations, beyond which tails are heavy
HEAVY = 3.7
#: degrees of freedom of heavy tails to begin with, and bounds of one over them
FREEDOM, INVERSE_FREEDOM = 5.0, (0.01, 0.5)
#: readings before and after each whose median may be its level
ABOUT = 12


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
        weighted = jacobian * (rows.weight.T**2)[:, :, None]
        precise = np.matmul(weighted.transpose(0, 2, 1), jacobian)
        variance = np.linalg.inv(precise + np.diag(sigma**-2.0))
        rest = np.where(rows.observed, left - np.einsum("tsi,ti->ts", jacobian, error), 0.0)
        hidden = (np.matmul(jacobian, variance) * jacobian).sum(2)
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
        rest, observed = self.rest, self.rows.observed
        # Rows that were chosen of many may be far apart, and say nothing of their memory.
        pairs = observed[1:] & observed[:-1] & self.rows.near[1:, None]
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

    found = scipy.optimize.minimize_scalar(
        loss, bounds=INVERSE_FREEDOM, method="bounded", options={"xatol": 2e-3}
    )
    return float(1 / found.x)
