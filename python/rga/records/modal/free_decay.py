"""Natural frequencies and mode shapes out of a free decay, as after a train or truck has left.

Eigensystem realisation (Juang and Pappa, An eigensystem realization algorithm for modal parameter
identification and model reduction, Journal of Guidance 8, 1985), from several beginnings and with
many orders: a mode of the structure is found by most of them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np
from scipy import signal, stats

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.errors import InputError
from rga.numerics.robust_spread import robust_spread
from rga.records.modal.poles import alike_poles
from rga.records.modal.read import as_real

#: samples that are kept of a period of the highest frequency
PER_PERIOD = 4
#: samples of all sensors that a column of the Hankel matrix has, at most, and its columns
TALLEST, LONGEST = 400, 2000
#: samples of which anything is found
LEAST = 60
#: orders of the realisations, and beginnings within the first quarter of the decay
ORDERS = range(4, 41, 2)
BEGINNINGS = 5
#: part of the largest singular value that is rounding
ROUNDING = 1e-12
#: periods that a decay has of a mode, and most damping that a structure has
PERIODS, MOST_DAMPING = 4, 0.1
#: part of a frequency about it in which noise is looked at
ABOUT = 0.3
#: of noise alone that anything stands out of it
CHANCE = 1e-3


@dataclass(frozen=True)
class DecayingMode:
    """A mode that decays.

    Attributes:
        frequency: [Hz].
        scatter: of it among the realisations, standard deviation [Hz].
        damping: share of the critical one.
        shape: motion of the sensors, float[sensors], the largest 1.
        realness: share of the shape that is in phase.
        found: share of the realisations that have it.
        over_noise: how far it stands out, 1 where noise alone does so once in a thousand decays.
    """

    frequency: float
    scatter: float
    damping: float
    shape: FloatArray
    realness: float
    found: float
    over_noise: float

    @property
    def in_doubt(self) -> bool:
        """Whether noise may look the same."""
        return self.over_noise < 1.0


def decaying_modes(motion: FloatArray, step: float, highest: float) -> list[DecayingMode]:
    """The modes of a free decay, the lowest first.

    Args:
        motion: what sensors read, float[samples, sensors], in any units.
        step: between samples [s].
        highest: frequency that is looked for [Hz].

    Raises:
        InputError: samples are too few, too many or too far apart; a reading is missing, a sensor
            does not move, or the frequency is not above zero.

    >>> time = np.arange(0, 10, 0.02)
    >>> swing = np.exp(-0.2 * time) * np.cos(2 * np.pi * 1.5 * time)
    >>> noise = 0.01 * np.random.default_rng(1).standard_normal((500, 2))
    >>> found = decaying_modes(np.outer(swing, [1.0, -0.5]) + noise, 0.02, 4.0)
    >>> (mode,) = [one for one in found if not one.in_doubt]
    >>> round(mode.frequency, 2), mode.shape.round(1).tolist(), round(mode.damping, 3)
    (1.5, [1.0, -0.5], 0.021)
    """
    motion, step = _thinned(motion, step, highest)
    # Sensors of all units count alike.
    sizes = motion.std(0)
    motion = motion / sizes
    poles = _Poles.of(motion, step, highest)
    groups = list(poles.alike())
    frequencies = [poles.frequency(own) for own in groups]
    courses = [poles.course(own, len(motion), step) for own in groups]
    stand_out = _over_noise(motion, step, frequencies, courses)
    found = [poles.mode(own, sizes, out) for own, out in zip(groups, stand_out, strict=True)]
    return sorted(found, key=lambda one: one.frequency)


def _thinned(motion: FloatArray, step: float, highest: float) -> tuple[FloatArray, float]:
    """Samples without what lies above the highest frequency."""
    if not np.isfinite(motion).all():
        row = int(np.argmax(~np.isfinite(motion).all(1)))
        raise InputError(
            "a reading is missing", f"sample {row} of the decay", "give a stretch without gaps"
        )
    if not highest > 0:
        raise InputError(
            f"{highest:g} Hz is no frequency", "highest", "give the highest to look for"
        )
    if PER_PERIOD * highest * step > 2.0:
        raise InputError(
            f"samples every {step:g} s show frequencies up to {0.5 / step:g} Hz",
            f"highest {highest:g} Hz",
            f"look for frequencies up to {2.0 / (PER_PERIOD * step):g} Hz",
        )
    of_each = int(max(1, 1.0 / (PER_PERIOD * highest * step)))
    samples = len(motion) // of_each
    if not LEAST <= samples <= LONGEST:
        seconds = [bound * of_each * step for bound in (LEAST, LONGEST)]
        raise InputError(
            f"the stretch lasts {len(motion) * step:g} s",
            f"with frequencies up to {highest:g} Hz",
            f"give {seconds[0]:.3g} to {seconds[1]:.3g} s of the decay, or another highest "
            "frequency",
        )
    spread = np.ptp(motion, axis=0)
    if not (spread > 0).all():
        raise InputError(
            "a sensor does not move", f"sensor {int(np.argmin(spread))}", "leave it out"
        )
    # A filter takes an offset for a step at both ends.
    motion = signal.detrend(motion, axis=0)
    if of_each > 1:
        motion = signal.decimate(motion, of_each, n=20 * of_each, ftype="fir", axis=0)
    return np.asarray(motion - motion.mean(0)), step * of_each


@dataclass(frozen=True)
class _Poles:
    """Poles of all realisations.

    Attributes:
        run: number of the realisation of each, int[poles].
        rate: logarithm of the pole over time [rad/s], complex[poles].
        shape: of length one, complex[poles, sensors].
        runs: number of realisations.
    """

    run: IntArray
    rate: np.ndarray
    shape: np.ndarray
    runs: int

    @classmethod
    def of(cls, motion: FloatArray, step: float, highest: float) -> "_Poles":
        number, runs, rates, shapes = count(), list[IntArray](), [], []
        for begin in range(BEGINNINGS):
            part = motion[begin * len(motion) // (4 * BEGINNINGS) :]
            for poles, motions in _realisations(part):
                rate = np.log(poles.astype(complex)) / step
                frequency = np.abs(rate) / (2 * np.pi)
                damping = -rate.real / np.abs(rate)
                kept = (rate.imag > 0) & (frequency < highest)
                kept &= (damping > 0) & (damping < MOST_DAMPING)
                kept &= frequency * len(part) * step > PERIODS
                kept &= np.linalg.norm(motions, axis=0) > 0
                runs.append(np.full(kept.sum(), next(number)))
                rates.append(rate[kept])
                shapes.append((motions[:, kept] / np.linalg.norm(motions[:, kept], axis=0)).T)
        return cls(
            np.concatenate(runs), np.concatenate(rates), np.concatenate(shapes), next(number)
        )

    def alike(self) -> Iterator[BoolArray]:
        """Poles that are of one mode, bool[poles], of each that enough realisations have."""
        return alike_poles(np.abs(self.rate), self.shape, self.run, self.runs)

    def frequency(self, own: BoolArray) -> float:
        """Of such a mode [Hz]."""
        return float(np.median(np.abs(self.rate[own]))) / (2 * np.pi)

    def course(self, own: BoolArray, samples: int, step: float) -> FloatArray:
        """How such a mode moves, cosine and sine, float[samples, 2]."""
        rate = np.median(self.rate[own].real) + 1j * np.median(self.rate[own].imag)
        swing = np.exp(rate * step * np.arange(samples))
        return np.column_stack([swing.real, swing.imag])

    def mode(self, own: BoolArray, sizes: FloatArray, over_noise: float) -> DecayingMode:
        """The mode of poles that are alike, of sensors of which each has its size."""
        frequency = np.abs(self.rate[own]) / (2 * np.pi)
        middle = self.frequency(own)
        shapes = self.shape[own]
        turned = shapes * np.exp(-1j * np.angle(shapes @ shapes[0].conj()))[:, None]
        (shape,), (realness,) = as_real(turned.mean(0)[None])
        shape = shape * sizes
        return DecayingMode(
            frequency=middle,
            scatter=robust_spread(frequency - middle),
            damping=float(np.median(-self.rate[own].real / np.abs(self.rate[own]))),
            shape=shape / shape[np.argmax(np.abs(shape))],
            realness=float(realness),
            found=len(np.unique(self.run[own])) / self.runs,
            over_noise=over_noise,
        )


def _realisations(motion: FloatArray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Poles, and the motion of the sensors in each, complex[sensors, poles], order by order."""
    samples, sensors = motion.shape
    rows = min(samples // 2, max(2, TALLEST // sensors))
    columns = samples - rows
    hankel = np.concatenate([motion[row : row + columns].T for row in range(rows + 1)])
    left, sizes, right = np.linalg.svd(hankel[:-sensors], full_matrices=False)
    # Without noise there is nothing beyond a few orders.
    rank = int((sizes > ROUNDING * sizes[0]).sum())
    for order in [one for one in ORDERS if one <= rank] or [rank]:
        root = np.sqrt(sizes[:order])
        system = (left[:, :order] / root).T @ hankel[sensors:] @ right[:order].T / root
        poles, vectors = np.linalg.eig(system)
        yield poles, (left[:sensors, :order] * root) @ vectors


def _over_noise(
    motion: FloatArray, step: float, frequencies: list[float], courses: list[FloatArray]
) -> list[float]:
    """How far each course stands out of what is left about its frequency [Hz]: an F test."""
    if not courses:
        return []
    samples, sensors = motion.shape
    left = _left(motion, courses)
    power = np.abs(np.fft.rfft(left, axis=0)) ** 2 / samples
    cycles = np.fft.rfftfreq(samples, step)
    found = []
    for number, frequency in enumerate(frequencies):
        without = _left(motion, courses[:number] + courses[number + 1 :])
        gained = (without**2).sum(0) - (left**2).sum(0)
        about = np.abs(cycles / frequency - 1.0) < ABOUT
        noise = np.maximum(power[about].mean(0), ROUNDING**2)
        size = float((gained / noise).sum()) / (2 * sensors)
        # Any of as many frequencies could have stood out.
        chance = CHANCE / samples
        found.append(size / float(stats.f.isf(chance, 2 * sensors, 2 * sensors * about.sum())))
    return found


def _left(motion: FloatArray, courses: list[FloatArray]) -> FloatArray:
    """What courses and a mean leave of a motion."""
    columns = np.column_stack([np.ones(len(motion)), *courses])
    amounts, *_ = np.linalg.lstsq(columns, motion, rcond=None)
    return np.asarray(motion - columns @ amounts)
