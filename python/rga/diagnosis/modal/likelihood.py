"""How probable measured modes are, given what a model predicts of them.

The error of a frequency is that of a window, with memory of the window before, and one that the
model makes of the mode in all windows. A measured shape is off by what noise and a model that is
right in everything else make of 1 - MAC.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import ModalReadings, scaled_contexts
from rga.diagnosis.modal.trials import ModalTrials
from rga.simulation.modal.expected import SHAPE_ERROR
from rga.simulation.modal.mixed_shapes import apart, freedom_of_parts, without_parts

#: error that a model makes of what a cause changes of a frequency, as a share of the change:
#: members as built and joints that it idealises leave about as much
CHANGE_ERROR = 0.1
#: what a context may do to a mode beside what the model says, over its range, as a share of the
#: frequency: a deck of asphalt stiffens by more when it freezes, steel by less
WEATHER = 0.03
#: where its line may bend, as shares of the range
PLACES = np.arange(1, 10) / 10
#: error that a model makes of a frequency when it is right in everything that one can name, as a
#: share of it: Georgia Tech's footbridge and others leave 1 to 2 %
MODEL_ERROR = 0.01
#: errors that it may make instead, where the modes show them, and the factor by which one usually
#: does: a welded structure, which a truss has with pins, leaves 3 % and more
LEVELS: tuple[float, ...] = tuple(MODEL_ERROR * 2.0 ** (0.5 * k) for k in range(6))
USUALLY = 2.0
#: error that a model makes of what a load of known mass changes of a frequency. The change goes
#: with the square of the motion there, which is off by a share of the largest: the error is this
#: share of the geometric mean of the change and of that of the mode that moves most. A truss for a
#: frame with 2 % scatter in its members errs by 1 % in the first three modes and by 2 to 6 % in the
#: next three, in all places alike; a truck weighed to 1 % is within that
STANDING_ERROR = 0.05


@dataclass(frozen=True)
class _Series:
    """The whitening of one mode's frequencies: x' C^-1 y is the product of whitened columns.

    C is that of noise with memory, and of columns of random size beside it; in the whitened space
    these are shrunk along their principal directions (Woodbury's identity).

    ``log_size``: half the logarithm of what the columns add to the determinant of C.
    """

    seen: BoolArray
    weight: FloatArray
    memory: FloatArray
    along: FloatArray
    shrunk: FloatArray
    log_size: float

    @classmethod
    def of(cls, seen: BoolArray, scatter: float, memory: float, columns: FloatArray) -> "_Series":
        apart = np.diff(np.flatnonzero(seen), prepend=-1).astype(float)
        kept = memory**apart
        kept[:1] = 0.0
        weight = 1.0 / (scatter * np.sqrt(1.0 - kept**2))
        along, sizes, _ = np.linalg.svd(_whitened(columns[:, seen], weight, kept).T, False)
        shrunk = 1.0 - 1.0 / np.sqrt(1.0 + sizes**2)
        return cls(seen, weight, kept, along, shrunk, 0.5 * float(np.log1p(sizes**2).sum()))

    def whiten(self, columns: FloatArray) -> FloatArray:
        """Of columns float[..., windows], float[..., windows seen]."""
        white = _whitened(columns[..., self.seen], self.weight, self.memory)
        return np.asarray(white - ((white @ self.along) * self.shrunk) @ self.along.T)


def _whitened(columns: FloatArray, weight: FloatArray, memory: FloatArray) -> FloatArray:
    """Of noise with memory alone."""
    white = columns * weight
    white[..., 1:] -= weight[1:] * memory[1:] * columns[..., :-1]
    return np.asarray(white)


def bent_lines(
    contexts: dict[str, FloatArray], windows: int, bend: float | None = None
) -> FloatArray:
    """Lines that bend over the range of each context, float[k, windows].

    Args:
        contexts: float[windows] each.
        windows: how many there are.
        bend: where, as a share of the range; None: anywhere.

    A line and bends, each of which is about as likely to be the one: where asphalt stiffens or a
    bearing freezes stands in no model, and a bend in another place leaves a course that a change
    with an onset is taken for.

    >>> bent_lines({"air": np.array([0.0, 10.0])}, 2)[0]
    array([-0.5,  0.5])
    """
    bends = PLACES[:, None] if bend is None else np.array([[bend]])
    courses = []
    for course in scaled_contexts(contexts):
        bent = np.abs(course - bends) / np.sqrt(len(bends))
        courses += [course - course.mean(), *(bent - bent.mean(axis=1, keepdims=True))]
    return np.array(courses).reshape(len(courses), windows)


def standing_errors(changes: FloatArray) -> FloatArray:
    """Standard deviations of what loads of known mass change of ln f, with their signs.

    Args:
        changes: by the model, float[windows, modes].

    >>> standing_errors(np.array([[0.0, 0.0], [-0.04, -0.01]])).round(6).tolist()
    [[0.0, 0.0], [-0.002, -0.001]]
    """
    largest = np.abs(changes).max(axis=1, initial=0.0, keepdims=True)
    return np.asarray(STANDING_ERROR * np.sign(changes) * np.sqrt(np.abs(changes) * largest))


class ModalLikelihood:
    """The likelihood of measured modes.

    What measured contexts do to each mode, beside what the model says of it, is free, but for
    those that say where a load of known mass stands.

    Args:
        trials: what predicts them.
        level: error that a model makes of every frequency, as a share of it.
        hidden: modes that are not looked at, bool[modes].
        weather: what a context may do to a mode beside what the model says, over its range, as a
            share of the frequency.
        bend: where all modes bend as they follow a context, as a share of its range; None: each
            mode anywhere.
    """

    def __init__(
        self,
        trials: ModalTrials[ModalReadings],
        level: float = MODEL_ERROR,
        hidden: BoolArray | None = None,
        weather: float = WEATHER,
        bend: float | None = None,
    ) -> None:
        self.trials, self.level, self.weather, self.bend = trials, level, weather, bend
        self.readings: ModalReadings = trials.readings
        count = len(self.readings.modes)
        self.hidden = np.zeros(count, dtype=bool) if hidden is None else hidden
        # The error of the model is the same in all windows; what a context does beside is not.
        windows = len(self.readings.time)
        bent = weather * bent_lines(self.readings.weather, windows, bend)
        columns = np.concatenate([level * np.ones((1, windows)), bent])
        self._standing = standing_errors(trials.by_standing)
        self._nothing = trials.predict({})
        self._series = [
            _Series.of(
                np.isfinite(self.readings.log_f[:, mode]),
                float(self.readings.scatter[mode]),
                float(self.readings.memory[mode]),
                np.concatenate([columns, self._standing[:, mode][None]]),
            )
            for mode in range(count)
        ]

    def hiding(self, mode: int) -> "ModalLikelihood":
        """The same without one of the modes."""
        hidden = self.hidden.copy()
        hidden[mode] = True
        return ModalLikelihood(self.trials, self.level, hidden, self.weather, self.bend)

    def with_level(self, level: float) -> "ModalLikelihood":
        """The same with another error of the model."""
        return ModalLikelihood(self.trials, level, self.hidden, self.weather, self.bend)

    def with_weather(self, weather: float) -> "ModalLikelihood":
        """The same with another share that contexts may do beside what the model says."""
        return ModalLikelihood(self.trials, self.level, self.hidden, weather, self.bend)

    def bending(self, bend: float) -> "ModalLikelihood":
        """The same where all modes bend at the same place as they follow contexts."""
        return ModalLikelihood(self.trials, self.level, self.hidden, self.weather, bend)

    def likeliest_level(self, prediction: Prediction) -> float:
        """The error of the model at which a prediction is most probable, none below the usual."""
        return min(LEVELS, key=lambda level: self.with_level(level)._loss(prediction))

    def _loss(self, prediction: Prediction) -> float:
        """Less the log posterior of the level, given a prediction."""
        residual = self.residual(prediction)
        unusual = 0.5 * (np.log(self.level / MODEL_ERROR) / np.log(USUALLY)) ** 2
        return float(0.5 * residual @ residual + self.freedom(prediction) + self._size + unusual)

    @property
    def explains_weather(self) -> bool:
        """Whether a cause follows the temperature, so that little is left for the modes to do."""
        return self.weather < WEATHER

    @property
    def of_nothing(self) -> float:
        """Log density of the modes without any cause, less what all levels have alike."""
        residual = self.residual(self._nothing)
        return -0.5 * float(residual @ residual) - self._size

    @property
    def _size(self) -> float:
        """Half the log determinant of the covariance, less that of the noise."""
        return sum(
            series.log_size
            for series, hidden in zip(self._series, self.hidden, strict=True)
            if not hidden
        )

    def residual(self, prediction: Prediction) -> FloatArray:
        """What a prediction misses, whitened: its square is that under the covariance.

        The model errs in every mode by a share of what the effects of the prediction change.
        """
        off = self.frequencies_off(prediction)
        parts = []
        for mode, white in self._doubts(prediction):
            left = self._series[mode].whiten(off[:, mode])
            square = float(white @ white)
            if square > 0.0:
                along = float(white @ left) / square
                left = left - (1.0 - 1.0 / np.sqrt(1.0 + square)) * along * white
            parts.append(left)
        seen = np.flatnonzero(~self.hidden).tolist()
        parts += [self.shape_off(mode, prediction) for mode in seen]
        at_points = self.trials.point_errors.off(prediction.recorded, prediction.mixing)
        parts += [at_points[mode] for mode in seen]
        return np.concatenate(parts)

    def freedom(self, prediction: Prediction) -> float:
        """What errors of the changes, and shapes that may be mixed, cost of the log evidence.

        Beyond what it costs without any cause.
        """
        of_changes = sum(
            0.5 * float(np.log1p(white @ white)) for _, white in self._doubts(prediction)
        )
        mixed, usual = (
            sum(
                freedom_of_parts(self._parts(mode, one)[1], self.shape_spread(mode))
                for mode in range(len(self._series))
                if not self.hidden[mode]
            )
            for one in (prediction, self._nothing)
        )
        at_points, of_structure = (
            float(self.trials.point_errors.freedom(shapes, prediction.mixing)[~self.hidden].sum())
            for shapes in (prediction.recorded, prediction.every)
        )
        return of_changes + mixed - usual + at_points - of_structure

    def _doubts(self, prediction: Prediction) -> Iterator[tuple[int, FloatArray]]:
        """Modes with a standard deviation of what their changes may be off, whitened."""
        change = CHANGE_ERROR * (prediction.log_f - self._nothing.log_f)
        for mode, series in enumerate(self._series):
            if not self.hidden[mode]:
                yield mode, series.whiten(change[:, mode])

    def of_steady(self, changes: FloatArray) -> FloatArray:
        """Whitened changes of ln f that are the same in all windows, float[k, modes]: float[k, n].

        They stand first in a residual, the shapes behind them.
        """
        windows = np.ones(len(self.readings.time))
        parts = [
            np.outer(changes[:, mode], series.whiten(windows))
            for mode, series in enumerate(self._series)
            if not self.hidden[mode]
        ]
        return np.concatenate(parts, axis=1)

    def steps(self, first: FloatArray) -> list[FloatArray]:
        """Whitened columns that begin in windows, float[beginnings, windows seen] of each mode."""
        return [series.whiten(first) for series in self._series]

    def frequencies_off(self, prediction: Prediction) -> FloatArray:
        """Measured ln f less predicted, float[windows, modes]; zero where not found."""
        return np.nan_to_num(self.readings.log_f - prediction.log_f)

    def shape_off(self, mode: int, prediction: Prediction) -> FloatArray:
        """The part of a measured shape that is not along the predicted one, float[points of it].

        In standard deviations; what may be in it of other modes counts for less.
        """
        return without_parts(*self._parts(mode, prediction), self.shape_spread(mode))

    def _parts(self, mode: int, prediction: Prediction) -> tuple[FloatArray, FloatArray]:
        """What of a measured shape is not along the predicted one, and what may be of others."""
        look = self.readings.looks[mode]
        own = prediction.at_points[mode, look.at]
        return apart(look.shape, own, prediction.parts[mode])

    def shape_spread(self, mode: int) -> float:
        """Standard deviation of that."""
        return float(np.sqrt(0.5 * SHAPE_ERROR + self.readings.shape_noise[mode]))

    def mean_off(self, prediction: Prediction) -> FloatArray:
        """Mean of measured ln f less predicted, float[modes]."""
        off = self.readings.log_f - prediction.log_f
        return np.asarray(np.nanmean(off, axis=0))

    def mean_spread(self, prediction: Prediction) -> FloatArray:
        """Standard deviation of that, the errors of the model with it, float[modes]."""
        spreads = []
        change = CHANGE_ERROR * (prediction.log_f - self._nothing.log_f).mean(0)
        for series, scatter in zip(self._series, self.readings.scatter, strict=True):
            memory = float(series.memory.max(initial=0.0))
            count = max(1.0, series.seen.sum() * (1.0 - memory) / (1.0 + memory))
            spreads.append(np.hypot(self.level, scatter / np.sqrt(count)))
        return np.asarray(np.hypot(np.hypot(spreads, change), self._standing.mean(0)))
