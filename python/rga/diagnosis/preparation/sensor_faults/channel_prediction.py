"""What every channel shows by itself: beyond what loads can do, and what the other channels share.

A linear structure shows combinations of the courses of its loads, whatever its stiffnesses. What
a structure does otherwise (friction, a jump, a swing) it does in several channels at once, and
those predict each other. What is left after both belongs to one channel alone.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.model.schema import Model
from rga.numerics.robust_spread import robust_spread

#: robust deviations at which a reading is drawn in before it predicts other channels
DRAWN_IN = 4.0
#: readings that a least-squares fit leaves out: beyond so many robust deviations, at so many goes
FAR, GOES = 4.0, 4
#: rows for each time history that is fitted, at least
ROWS_PER_COURSE = 12
#: channels of a kind of which a median says how noisy one is usually
ALIKE = 3
#: rows of a mean that shows what wanders, and how much more than fast a channel may be off slowly:
#: channels differ in the memory of their noise
WIDTH, SLOWLY = 8, 1.2
#: share of what channels have in common that the prediction of one by the others misses
SHARED = 0.12
#: share of the channels below which a row does not predict one by the others
FEW_BESIDE = 0.3
#: share of the readings of a working channel that may lie anywhere
SPIKES = 0.01
#: of two like channels the one may be so much noisier than the other
PAIR = 2.0


@dataclass(frozen=True)
class OwnParts:
    """What channels show by themselves.

    Attributes:
        left: readings less their best fit by the courses of the loads, float[rows, sensors].
        own: the same less what the other channels predict of it, float[rows, sensors]; zero where
            missing.
        usual: root mean square that `own` of a working channel has, float[sensors]; NaN where
            nothing shows it.
        usual_slow: the same of its means over some rows.
    """

    left: FloatArray
    own: FloatArray
    usual: FloatArray
    usual_slow: FloatArray

    @property
    def size(self) -> FloatArray:
        """Root mean square of the own part over that of a working channel, float[sensors].

        Fast or slow, whichever is larger, without the largest readings, as few as heavy tails of
        the noise may have.
        """
        fast = trimmed_size(self.own) / self.allowed
        slow = trimmed_size(slow_part(self.own)) / np.hypot(self.usual_slow, self._shared)
        return np.fmax(fast, slow / SLOWLY)

    @property
    def allowed(self) -> FloatArray:
        """Root mean square that the own part of a working channel may have, float[sensors].

        The usual one, and what the prediction by other channels misses of a large shared part.
        """
        return np.hypot(self.usual, self._shared)

    @property
    def _shared(self) -> FloatArray:
        return SHARED * trimmed_size(self.left)


def own_parts(
    model: Model,
    sensors: tuple[str, ...],
    readings: FloatArray,
    observed: BoolArray,
    basis: FloatArray,
    simulated: FloatArray,
) -> OwnParts:
    """What channels show by themselves.

    Args:
        model: states the noise of sensors, and which are of a kind.
        sensors: names of the channels.
        readings: float[rows, sensors].
        observed: bool[rows, sensors].
        basis: courses of the loads, float[rows, courses].
        simulated: float[rows, sensors].
    """
    left = np.zeros_like(readings)
    for number in range(len(sensors)):
        seen = observed[:, number]
        if seen.any():
            column = readings[seen, number]
            left[seen, number] = column - robust_fit(column, basis[seen])
    own = beyond_others(left, observed)
    signal = simulated.std(axis=0)
    usual = _usual(model, sensors, trimmed_size(own), signal, 1.0)
    slow = _usual(model, sensors, trimmed_size(slow_part(own)), signal, 0.0)
    return OwnParts(left, own, usual, slow)


def robust_fit(column: FloatArray, basis: FloatArray) -> FloatArray:
    """Least-squares fit of a column by the first courses of a basis, readings far away left out.

    Args:
        column: float[readings].
        basis: float[readings, courses].
    """
    few = np.column_stack([np.ones(len(column)), basis[:, : len(column) // ROWS_PER_COURSE]])
    kept = np.ones(len(column), dtype=bool)
    fitted = np.full(len(column), np.median(column))
    for _ in range(GOES):
        fitted = few @ np.linalg.lstsq(few[kept], column[kept], rcond=None)[0]
        rest = column - fitted
        before, kept = kept, np.abs(rest) <= FAR * max(robust_deviation(rest[kept]), 1e-12)
        if kept.sum() <= few.shape[1] + ALIKE:
            return np.full(len(column), np.median(column))
        if (kept == before).all():
            break
    return np.asarray(fitted)


def robust_deviation(values: FloatArray) -> float:
    """Standard deviation by the median of the absolute deviations."""
    return robust_spread(values - np.median(values)) if len(values) else 0.0


def root_mean_square(columns: FloatArray) -> FloatArray:
    """By column, zeros of missing readings left out, float[columns]."""
    count = np.maximum((columns != 0).sum(0), 1)
    return np.asarray(np.sqrt((columns**2).sum(0) / count))


def trimmed_size(columns: FloatArray) -> FloatArray:
    """The same without the largest few readings, float[columns]."""
    largest = np.quantile(np.abs(columns), 1 - SPIKES, axis=0)
    return root_mean_square(np.where(np.abs(columns) <= largest, columns, 0.0))


def slow_part(columns: FloatArray) -> FloatArray:
    """Means over some rows, float[pieces, columns]."""
    pieces = np.array_split(columns, max(1, len(columns) // WIDTH))
    return np.array([piece.mean(0) for piece in pieces])


def beyond_others(left: FloatArray, observed: BoolArray) -> FloatArray:
    """What each channel shows beyond what the others predict of it, float[rows, sensors].

    A ridge regression of each on all others, by one inverse, or one for each channel that lacks
    readings: rows without them would make it resemble the others less. Rows in which most channels
    are silent predict nothing.
    """
    sensors = left.shape[1]
    beside = observed.sum(axis=1) > FEW_BESIDE * observed.any(axis=0).sum()
    scale = np.array(
        [robust_deviation(left[observed[:, number], number]) for number in range(sensors)]
    )
    scale = np.where(scale > 0, scale, 1.0)
    scaled = np.clip(left / scale, -DRAWN_IN, DRAWN_IN)
    scaled /= np.maximum(root_mean_square(scaled), 1e-12)
    alone = _unpredicted(scaled)
    for number in np.flatnonzero(~observed.all(axis=0) & observed.any(axis=0)):
        seen = observed[:, number]
        alone[seen, number] = _unpredicted(scaled[seen])[:, number]
    spread = np.maximum(root_mean_square(np.clip(left / scale, -DRAWN_IN, DRAWN_IN)), 1e-12)
    predicted = (scaled - alone) * scale * spread
    return np.where(observed & beside[:, None], left - predicted, 0.0)


def _unpredicted(scaled: FloatArray) -> FloatArray:
    """What ridge regressions of each column on the others leave, float[rows, columns].

    The ridge is what as many columns of chance correlate with each other.
    """
    rows, columns = scaled.shape
    correlation = scaled.T @ scaled / rows
    precision = np.linalg.inv(correlation + np.eye(columns) * columns / rows)
    return np.asarray((scaled @ precision) / np.diag(precision))


def _usual(
    model: Model,
    sensors: tuple[str, ...],
    size: FloatArray,
    signal: FloatArray,
    least: float,
) -> FloatArray:
    """Root mean square of the own part of working channels, float[sensors].

    What the model states of the noise, times what all channels that state one have beyond it in
    the median. Where nothing is stated, the median of the channels of the kind; of a lone one what
    the others have for the variation that is expected; of two the smaller with an allowance, if
    that is more.

    Args:
        model: states the noise of sensors, and which are of a kind.
        sensors: names of the channels.
        size: root mean square of their own parts, float[sensors].
        signal: standard deviation that is expected of them, float[sensors].
        least: noise beyond which no channel has less, in what is stated.
    """
    stated = np.array([model.sensors[name].noise or np.nan for name in sensors])
    beyond = np.nanmedian(size / stated) if np.isfinite(stated).any() else 1.0
    usual = stated * max(float(beyond), least)
    kinds = np.array([f"{model.sensors[n].kind} {model.sensors[n].unit}" for n in sensors])
    share = size / np.where(signal > 0, signal, np.nan)
    typical = np.nanmedian(share) if np.isfinite(share).sum() >= ALIKE else np.nan
    for kind in np.unique(kinds[np.isnan(stated)]):
        like = (kinds == kind) & np.isnan(stated)
        if like.sum() >= ALIKE:
            usual[like] = np.median(size[like])
        elif like.sum() > 1:
            usual[like] = np.fmax(PAIR * size[like].min(), typical * signal[like])
        else:
            usual[like] = typical * signal[like]
    return np.where(usual > 0, usual, np.nan)
