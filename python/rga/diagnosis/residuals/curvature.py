"""Curves and loops: readings that go with a square, or lag behind what they should be.

A linear structure shows combinations of the courses of its loads, whatever its stiffnesses. What
the channels show along a square beyond such combinations was put there by no cause that acts in
proportion: the specification test of Ramsey (1969, J. Royal Statistical Society B 31, 350). The
square of a context is sought in all channels together, that of its own simulated reading in each
as well: a member that softens bends the reading of its gauge. A joint that slips with friction lags
behind its force, and others with it: a loop over what a channel should read is sought in all
channels. A cause that follows the linear part of such a response is none.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtrc

from rga.arrays import FloatArray
from rga.diagnosis.residuals.slopes import STRAIGHT, squares, standardised
from rga.diagnosis.search.linearised import Calibration, Problem, load_basis
from rga.numerics.decompositions import thin_svd
from rga.numerics.hysteresis import PLAY, loop

#: share of the rows that the courses of the loads may take, and of a curve that they must leave
MOST_COURSES, LEFT = 1 / 12, 1e-3
#: share of its prior spread by which a latent context must vary to be shown by anything
SHOWN = 1e-3
#: correlation from which on two readings drive the same loop
ALIKE = 0.97
#: courses that stand for nothing, beside each shape, and their seed
CONTROLS, SEED = 8, 0


@dataclass(frozen=True)
class _Shape:
    """A curve or loop that the readings may go with.

    Attributes:
        words: what that would be.
        linear: the driver of each channel about its mean, in its standard deviations, float[rows,
            sensors].
        shape: the curve or loop over it, float[rows, sensors].
        alone: each channel has a size of its own, that tells nothing of the others: a single one
            may have it, and be lost among many that have not.
        among: number of shapes of its sort that are tried.
    """

    words: str
    linear: FloatArray
    shape: FloatArray
    alone: bool
    among: int


@dataclass(frozen=True)
class Curve(_Shape):
    """What the channels go with that is not in proportion.

    Attributes:
        sizes: of the shape in the readings, as far as scatter does not explain it, over the noise
            of the channel [-], float[sensors].
    """

    sizes: FloatArray


def curves(problem: Problem) -> list[Curve]:
    """What the channels go with that is not in proportion, beyond chance."""
    data, rows = problem.data, problem.covariance.rows
    sensors = len(data.sensors)
    tried = [*_over_contexts(problem), _over_own_readings(problem), *_loops(problem)]
    residual = problem.residual(problem.simulated)
    left = np.where(data.observed, residual - problem.explained_by_scatter(residual), 0.0)
    courses = _courses(load_basis(problem.simulator, data))
    known = courses.shape[1]
    sizes, squared, count = np.zeros((3, sensors, len(tried)))
    controls = _wandering(tried)
    chance_squared = np.full((sensors, len(tried)), np.nan)
    for sensor in range(sensors):
        free = int(data.observed[:, sensor].sum()) - known - 1
        if free < known:
            continue
        shapes = np.column_stack([one.shape[:, sensor] for one in tried])
        columns = np.column_stack([courses, shapes, controls, left[:, sensor]]).T[:, None]
        white = rows.whiten(columns, np.full(len(columns), sensor)[:, None])[:, 0].T
        span, _ = np.linalg.qr(white[:, :known])
        rest = white[:, known:] - span @ (span.T @ white[:, known:])
        reading = rest[:, -1]
        along, wandering = np.split(rest[:, :-1], [len(tried)], axis=1)
        size = (along**2).sum(0)
        seen = size > LEFT * (white[:, known : known + len(tried)] ** 2).sum(0)
        product = along[:, seen].T @ reading
        variance = (reading**2).sum() / free
        if variance == 0.0:
            continue
        sizes[sensor, seen] = product / size[seen] / problem.noise.sigma[sensor]
        squared[sensor, seen] = product**2 / size[seen] / variance
        count[sensor, seen] = 1
        chance_squared[sensor] = _by_chance(along, wandering, reading) / variance
    squared /= _excess(chance_squared)
    chance = chdtrc(np.maximum(count.sum(0), 1), squared.sum(0))
    largest = sensors * chdtrc(1, squared.max(0, initial=0.0))
    found: dict[str, tuple[float, Curve]] = {}
    for number, one in enumerate(tried):
        likely = 2 * min(chance[number], largest[number]) if one.alone else chance[number]
        if likely < problem.criteria.structure.curve_chance / one.among:
            curve = Curve(**vars(one), sizes=sizes[:, number])
            if one.alone:
                most = data.sensors[int(np.abs(curve.sizes).argmax())]
                curve = replace(curve, words=f"{one.words}, most of all channel {most}")
            # One loop shows over many readings, and with other widths.
            other = found.get(one.words)
            found[one.words] = min(other or (likely, curve), (likely, curve), key=lambda at: at[0])
    return [curve for _, curve in found.values()]


def free_channels(problem: Problem, found: list[Curve]) -> list[Calibration]:
    """Random effects by which every channel may follow a driver and a curve over it.

    Args:
        problem: in which there are curves.
        found: those.
    """
    free = []
    for curve in found:
        common = np.full(len(curve.sizes), np.sqrt((curve.sizes**2).mean()))
        size = STRAIGHT * (np.abs(curve.sizes) if curve.alone else common)
        for sensor, one in enumerate(np.diag(problem.noise.sigma)):
            if problem.data.observed[:, sensor].any() and size[sensor] > 0:
                both = (curve.linear[:, sensor], curve.shape[:, sensor])
                free += [(np.outer(along, one), float(size[sensor])) for along in both]
    return free


def _over_contexts(problem: Problem) -> list[_Shape]:
    """Squares of the contexts, the same in every channel; of a latent one as it was inferred.

    A latent context that nothing shows is inferred as a constant.
    """
    belief, sensors = problem.data.belief, len(problem.data.sensors)
    inferred = {
        name: belief.table[name]
        if belief.table[name].std() > SHOWN * belief.spread[name]
        else np.zeros(len(belief.table[name]))
        for name in belief.latent
    }
    linear = standardised({**belief.centre, **inferred})
    curved = squares(linear)
    return [
        _Shape(
            f"the readings go with the square of {name}",
            _in_all(linear[name], sensors),
            _in_all(square, sensors),
            alone=False,
            among=len(curved),
        )
        for name, square in curved.items()
    ]


def _over_own_readings(problem: Problem) -> _Shape:
    """The square of what each channel should read."""
    shown = problem.simulated
    own = standardised(dict(enumerate(shown.T)))
    nothing = np.zeros(len(shown))
    curved = squares(own)
    linear = np.column_stack([own.get(sensor, nothing) for sensor in range(shown.shape[1])])
    square = np.column_stack([curved.get(sensor, nothing) for sensor in range(shown.shape[1])])
    bent = "the readings go with the square of what the model says that they should be"
    return _Shape(bent, linear, square, alone=True, among=1)


def _loops(problem: Problem) -> list[_Shape]:
    """Loops over what each channel should read, the same in every channel."""
    words = "the readings lag behind what the model says, in a loop as of friction"
    sensors = len(problem.data.sensors)
    drivers = _distinct(standardised(dict(enumerate(problem.simulated.T))).values())
    if not drivers:
        return []
    together = np.repeat(np.column_stack(drivers), len(PLAY), axis=1)
    loops = loop(together, np.tile(PLAY, len(drivers)))
    return [
        _Shape(words, _in_all(linear, sensors), _in_all(one, sensors), True, len(loops.T))
        for linear, one in zip(together.T, loops.T, strict=True)
    ]


def _wandering(tried: Sequence[_Shape]) -> FloatArray:
    """Chance courses, `CONTROLS` with the spectrum of each shape tried, at random phases.

    They are as slow as the shape at every scale: surrogate data of Theiler et al. (1992, Physica D
    58, 77).

    Returns:
        float[rows, shapes * CONTROLS].
    """
    shapes = np.column_stack([one.shape.mean(axis=1) for one in tried])
    size = np.abs(np.fft.rfft(shapes - shapes.mean(axis=0), axis=0)).repeat(CONTROLS, axis=1)
    turned = np.random.default_rng(SEED).uniform(0.0, 2 * np.pi, size.shape)
    return np.asarray(np.fft.irfft(size * np.exp(1j * turned), len(shapes), axis=0))


def _by_chance(along: FloatArray, wandering: FloatArray, reading: FloatArray) -> FloatArray:
    """How much a channel goes with courses that stand for nothing, each shape taken out first.

    Args:
        along: the shapes, float[rows, shapes].
        wandering: their chance courses, float[rows, shapes * CONTROLS].
        reading: what is left of the channel, float[rows].

    Returns:
        Mean square along the courses of each shape, float[shapes].
    """
    size = np.sqrt(np.maximum((along**2).sum(0), 1e-300))
    shape = along / size
    courses = wandering.reshape(*shape.shape, CONTROLS)
    own = np.einsum("rs,rsk->sk", shape, courses)
    left = np.einsum("r,rsk->sk", reading, courses) - (shape.T @ reading)[:, None] * own
    length = np.einsum("rsk,rsk->sk", courses, courses) - own**2
    return np.asarray((left**2 / np.maximum(length, 1e-300)).mean(axis=1))


def _excess(squared: FloatArray) -> FloatArray:
    """How much more readings go with courses that stand for nothing than chance says [-].

    Args:
        squared: with those of each shape, over the variance, float[sensors, shapes]; NaN where
            too little is read.

    Returns:
        Half what a channel itself shows and half what all of them do, less the deviation that so
        few squares have by chance, float[sensors, shapes].
    """
    read = np.isfinite(squared)
    own = np.where(read, squared, 1.0)
    both = own + own.sum(axis=0, where=read) / np.maximum(read.sum(axis=0), 1)
    return np.asarray(np.maximum(1.0, (both - np.sqrt(2 / CONTROLS)) / 2))


def _in_all(course: FloatArray, sensors: int) -> FloatArray:
    """The same course in every channel, float[rows, sensors]."""
    return np.broadcast_to(course[:, None], (len(course), sensors))


def _distinct(courses: Iterable[FloatArray]) -> list[FloatArray]:
    """Standardised courses, less those that are much like another, or its mirror image."""
    kept: list[FloatArray] = []
    for one in courses:
        if all(abs(one @ other) < ALIKE * len(one) for other in kept):
            kept.append(one)
    return kept


def _courses(basis: FloatArray) -> FloatArray:
    """A level and the courses of the loads, orthonormal, float[rows, courses]."""
    together = np.column_stack([np.ones(len(basis)), basis])
    u, s, _ = thin_svd(together / np.linalg.norm(together, axis=0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, : max(1, int(MOST_COURSES * len(basis)))])
