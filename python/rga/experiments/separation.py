"""How far measurements separate two explanations.

With D the difference of what they predict and C the covariance of a measurement about its
prediction (noise, gains, scatter of the members, and what the unknowns of either explanation may
still be), the separation is d_perp = sqrt(D' C^-1 D): what is left of the difference once the rival
has imitated all that it can. The log-odds of the true explanation are then about normal with mean
d_perp^2 / 2 and variance d_perp^2.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import erf, sqrt

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular

from rga.arrays import FloatArray
from rga.experiments.explanation import CandidateModel
from rga.experiments.measurement_model import Errors
from rga.experiments.site import Site


@dataclass(frozen=True)
class Pair:
    """Two explanations that are to be separated.

    Attributes:
        cause, rival: the two.
        predicted: by each of them, float[2, measurements, sensors].
        unknown: derivatives by the unknowns of both in standard deviations,
            float[unknowns, measurements, sensors].
    """

    cause: CandidateModel
    rival: CandidateModel
    predicted: FloatArray
    unknown: FloatArray

    @property
    def loose(self) -> FloatArray:
        """`unknown`, as far as a fit may move the unknowns."""
        spread = np.concatenate([self.cause.spread, self.rival.spread])
        return np.asarray(self.unknown * spread[:, None, None])

    @property
    def difference(self) -> FloatArray:
        """float[measurements, sensors]."""
        return np.asarray(self.predicted[0] - self.predicted[1])


def paired(site: Site, cause: CandidateModel, rival: CandidateModel) -> Pair:
    """What two explanations say of everything that could be measured on a site.

    Raises:
        InputError: one of them cannot be simulated.
    """
    both = (cause, rival)
    predicted = [site.measurements(one.effects) for one in both]
    unknown = [site.derivatives(one, np.zeros(len(one.unknowns))) for one in both]
    return Pair(cause, rival, np.array(predicted), np.concatenate(unknown))


@dataclass(frozen=True)
class Whitened:
    """Measurements freed of what is each sensor's own: noise and gain.

    Attributes:
        shared: errors that sensors share, float[sensors, measurements, errors].
        unknown: of each pair, float[sensors, measurements, unknowns].
        difference: of each pair, float[sensors, measurements].
    """

    shared: FloatArray
    unknown: list[FloatArray]
    difference: list[FloatArray]


def whitened(
    errors: Errors, pairs: Sequence[Pair], rows: Sequence[int], sensors: Sequence[int]
) -> Whitened:
    """Some measurements of some sensors, in units of their own errors."""
    here = np.ix_(list(rows), list(sensors))
    noise, gain = errors.noise[here].T, errors.gain[here].T
    own = gain[:, :, None] * gain[:, None, :]
    every = np.arange(len(rows))
    own[:, every, every] += np.maximum(noise, 1e-12) ** 2
    stacked = [
        errors.shared[:, here[0], here[1]],
        *(pair.loose[:, here[0], here[1]] for pair in pairs),
        *(pair.difference[here][None] for pair in pairs),
    ]
    columns = np.concatenate(stacked).transpose(2, 1, 0)
    white = np.linalg.solve(np.linalg.cholesky(own), columns)
    ends = np.cumsum([len(part) for part in stacked])
    parts = np.split(white, ends[:-1], axis=2)
    count = len(pairs)
    return Whitened(parts[0], parts[1 : 1 + count], [one[:, :, 0] for one in parts[1 + count :]])


def whitened_apart(
    errors: Errors, pair: Pair, rows: Sequence[int], sensors: Sequence[int]
) -> Whitened:
    """Each of some measurements by itself, its sensors taken together.

    Returns:
        Arrays with the measurements first, then the sensors.
    """
    here = np.ix_(list(rows), list(sensors))
    own = np.maximum(np.hypot(errors.noise[here], errors.gain[here]), 1e-12)
    shared, unknown = (
        (part[:, here[0], here[1]] / own).transpose(1, 2, 0) for part in (errors.shared, pair.loose)
    )
    return Whitened(shared, [unknown], [pair.difference[here] / own])


@dataclass(frozen=True)
class Known:
    """What measurements say of one pair.

    Attributes:
        square: d_perp squared.
        precision: factor of the precision of the shared errors and the unknowns.
        estimate: of these, from the difference, float[errors + unknowns].
    """

    square: float
    precision: tuple[FloatArray, bool]
    estimate: FloatArray


def known(measured: Sequence[Whitened], number: int) -> Known:
    """What measurements together say of the pair of a number."""
    columns = [np.concatenate([one.shared, one.unknown[number]], axis=2) for one in measured]
    width = columns[0].shape[2]
    design = np.concatenate([one.reshape(-1, width) for one in columns])
    difference = np.concatenate([one.difference[number].ravel() for one in measured])
    precision = cho_factor(design.T @ design + np.eye(width), lower=True)
    estimate = cho_solve(precision, design.T @ difference)
    square = float(difference @ difference - difference @ (design @ estimate))
    return Known(max(square, 0.0), precision, estimate)


def nothing(errors: Errors, pair: Pair) -> Known:
    """What no measurement says of a pair."""
    width = len(errors.shared) + len(pair.unknown)
    return Known(0.0, (np.eye(width), True), np.zeros(width))


def with_one_more(before: Known, more: Whitened, number: int) -> FloatArray:
    """d_perp squared of a pair with one more sensor, for each of some, float[sensors]."""
    columns = np.concatenate([more.shared, more.unknown[number]], axis=2)
    width = columns.shape[2]
    surprise = more.difference[number] - columns @ before.estimate
    half = columns
    if before.square > 0:
        flat = columns.reshape(-1, width).T
        half = solve_triangular(before.precision[0], flat, lower=True).T.reshape(columns.shape)
    spread = half @ half.transpose(0, 2, 1) + np.eye(columns.shape[1])
    gained = np.linalg.solve(spread, surprise[:, :, None])[:, :, 0]
    return np.asarray(before.square + np.maximum((surprise * gained).sum(1), 0.0))


def covariance(errors: Errors, present: FloatArray) -> FloatArray:
    """Of the measurements that are present (a mask), unknowns left out, float[n, n]."""
    flat = errors.shared.reshape(len(errors.shared), -1)[:, present.ravel() > 0]
    whole = flat.T @ flat
    column = np.broadcast_to(np.arange(present.shape[1]), present.shape)[present > 0]
    gain = errors.gain[present > 0]
    whole += np.where(column[:, None] == column[None, :], np.outer(gain, gain), 0.0)
    whole[np.diag_indices_from(whole)] += np.maximum(errors.noise[present > 0], 1e-12) ** 2
    return np.asarray(whole)


def success(separation: float, odds: float) -> float:
    """Chance that the true explanation of two wins by so many log-odds.

    >>> round(success(5.5, 4.6), 3)
    0.972
    """
    if separation <= 0:
        return 0.0
    return 0.5 * (1 + erf((separation**2 / 2 - odds) / (separation * sqrt(2))))
