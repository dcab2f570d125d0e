"""The part of a residual that no linear structure can explain: noise, and errors of contexts.

That is what of each channel is not a combination of the load coefficients, nor a step at one
moment, nor a drift from one on. So an effect that is hidden in the record does not pass for noise,
as long as it leaves the structure linear; one that changes with time may pass for a little of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.numerics.decompositions import thin_svd
from rga.numerics.robust_spread import robust_spread

#: a step: a jump from one row to the next of so many robust deviations of such jumps, by which the
#: median of so many rows before and after differs too
JUMP, BESIDE = 6.0, 12
#: log likelihood by which a channel must shift or grow from a row on rather than wander by a long
#: memory: 1 in 100 random walks of 120 readings reach it by growing (E. Zivot and D. W. K. Andrews,
#: J. Business & Economic Statistics 10, 1992, table 4: t = -5.57), 1 in 1000 by a shift
BEYOND_WANDERING = 14.0
#: log likelihood that a shift may lose where the jump at its row must be of its size: 4 deviations
AGREES = 8.0
#: moments from which on it may grow
MOMENTS = 30
#: share of its squares that a line must keep beside the loads, to be no sum of them
SEEN = 1e-10
#: in the place of nothing, to divide by
TINY = 1e-300


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
    wandering = _wandering(left, observed, span)
    moment = _jump(left, observed, span)
    if moment is None:
        moment = _shift(wandering)
    if moment is not None:
        # A step would else pass for noise with a long memory, the better the larger it is.
        step = (np.arange(len(residual)) >= moment).astype(float)
        span = np.column_stack([span, step])
        wandering = _wandering(_left(own, observed, span), observed, span)
    begun = _growth(wandering)
    if begun is not None:
        clock = np.arange(len(residual)) / len(residual)
        later = np.maximum(clock - clock[begun], 0.0)
        span = np.column_stack([span, clock, later])
    return _left(residual, observed, span)


def _left(residual: FloatArray, observed: BoolArray, span: FloatArray) -> FloatArray:
    left = np.where(observed, residual, 0.0)
    for rows, sensors in _seen_together(observed):
        if len(rows) > 2 * span.shape[1]:
            place = np.ix_(rows, sensors)
            weights = lstsq(span[rows], residual[place])[0]
            rest = residual[place] - span[rows] @ weights
            left[place] = rest * np.sqrt(len(rows) / (len(rows) - span.shape[1]))
    return left


def _seen_together(observed: BoolArray) -> list[tuple[IntArray, IntArray]]:
    """Rows with the numbers of the sensors that were read in just these."""
    together: dict[bytes, list[int]] = {}
    for sensor, column in enumerate(observed.T):
        together.setdefault(column.tobytes(), []).append(sensor)
    return [
        (np.flatnonzero(observed[:, sensors[0]]), np.array(sensors))
        for sensors in together.values()
    ]


def _jump(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
    """The row at which the channels jump most and stay, if any does.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    best: tuple[float, int] | None = None
    bases = [
        (rows, sensor, basis)
        for rows, sensors in _seen_together(observed)
        for basis in [np.linalg.qr(span[rows])[0]]
        for sensor in sensors
    ]
    for rows, sensor, basis in bases:
        column, rest = _with_whole_step(left[rows, sensor], basis)
        jumps = np.abs(np.diff(column))
        scale = robust_spread(np.diff(rest))
        for place in np.flatnonzero(jumps > JUMP * scale) + 1 if scale > 0 else ():
            if not BESIDE <= place <= len(column) - BESIDE:
                continue
            before, after = column[place - BESIDE : place], column[place : place + BESIDE]
            shift = abs(float(np.median(after) - np.median(before))) / scale
            if shift > JUMP and (best is None or shift > best[0]):
                best = (shift, int(rows[place]))
    return None if best is None else best[1]


@dataclass(frozen=True)
class _Wandering:
    """A channel whose reading is predicted by the one before and by the loads of both.

    Attributes:
        rows: that were read, int[readings].
        reading: each but the first, float[readings - 1].
        predictors: of it, float[readings - 1, k]; the last is the reading before.
        known: their orthonormal basis, float[readings - 1, at most k].
        unpredicted: the part of the readings that they leave, float[readings - 1].
    """

    rows: IntArray
    reading: FloatArray
    predictors: FloatArray
    known: FloatArray
    unpredicted: FloatArray

    @classmethod
    def of(
        cls, rows: IntArray, column: FloatArray, loads: FloatArray, known: FloatArray
    ) -> "_Wandering":
        """One channel.

        Args:
            rows: that were read, int[readings].
            column: its readings there, float[readings].
            loads: of each but the first and of the one before, and a constant, float[readings - 1,
                k]. They fit a large change in part, so that they are fitted anew beside it.
            known: their orthonormal basis.
        """
        reading, before = column[1:], column[:-1]
        own = before - known @ (known.T @ before)
        own -= known @ (known.T @ own)
        size = float(np.linalg.norm(own))
        if size > 1e-12 * float(np.linalg.norm(before)):
            known = np.column_stack([known, own / size])
        unpredicted = reading - known @ (known.T @ reading)
        return cls(rows, reading, np.column_stack([loads, before]), known, unpredicted)

    @property
    def freedom(self) -> int:
        readings, predictors = self.predictors.shape
        return int(readings - predictors)

    def loss(self, *more: FloatArray) -> tuple[float, float]:
        """Minus the greatest log likelihood with more predictors, and the weight of the reading
        before."""
        predictors = np.column_stack([self.predictors, *more])
        weights = lstsq(predictors, self.reading)[0]
        rest = self.reading - predictors @ weights
        memory = float(weights[self.predictors.shape[1] - 1])
        return self.freedom / 2 * float(np.log(max(float(rest @ rest), TINY))), memory


def _wandering(left: FloatArray, observed: BoolArray, span: FloatArray) -> list[_Wandering]:
    """The channels of which enough was read to tell.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    found = []
    for rows, sensors in _seen_together(observed):
        loads = np.column_stack([np.ones(len(rows)), span[rows]])
        loads = np.column_stack([loads[1:], loads[:-1, 1:]])
        if len(loads) - loads.shape[1] - 1 <= 4 * BESIDE:
            continue
        known, strength, _ = thin_svd(loads)
        known = known[:, strength > 1e-12 * strength[0]]
        found += [_Wandering.of(rows, left[rows, sensor], loads, known) for sensor in sensors]
    return found


def _shift(channels: Sequence[_Wandering]) -> int | None:
    """The row from which on a channel keeps to another level, if any does.

    At that row it jumps, and ever after it comes back to the new level as it did to the old. The
    jump alone says nothing: an outlier has it as well.
    """
    best: tuple[float, int] | None = None
    for wandering in channels:
        known, unpredicted = wandering.known, wandering.unpredicted
        # Moments of the jump, and of all readings after it, with what the predictors leave.
        jump = np.arange(BESIDE, len(unpredicted) - BESIDE)
        after = jump + 1
        later = np.cumsum(known[::-1], axis=0)[::-1][after]
        jumps = np.maximum(1 - (known[jump] ** 2).sum(1), SEEN)
        both = -(later * known[jump]).sum(1)
        levels = len(unpredicted) - after - (later**2).sum(1) - both**2 / jumps
        along = np.cumsum(unpredicted[::-1])[::-1][after] - both * unpredicted[jump] / jumps
        rest = unpredicted @ unpredicted - unpredicted[jump] ** 2 / jumps
        share = np.where(levels > 1.0, along**2 / np.maximum(levels * rest, TINY), 0.0)
        gained = -wandering.freedom / 2 * np.log(np.maximum(1 - share, SEEN))
        place = int(np.argmax(gained))
        if gained[place] <= BEYOND_WANDERING or (best and gained[place] <= best[0]):
            continue
        at = (np.arange(len(unpredicted)) == jump[place]).astype(float)
        since = (np.arange(len(unpredicted)) > jump[place]).astype(float)
        free, memory = wandering.loss(at, since)
        of_one_size, _ = wandering.loss(at + (1 - memory) * since)
        if of_one_size - free < AGREES:
            best = (float(gained[place]), int(wandering.rows[jump[place] + 1]))
    return None if best is None else best[1]


def _growth(channels: Sequence[_Wandering]) -> int | None:
    """The row from which on a channel drifts in another way than before, if any does.

    A reading is predicted by the one before, with a line that bends at a row or without: what only
    wanders needs no such line.
    """
    best: tuple[float, int] | None = None
    for wandering in channels:
        rows, known, unpredicted = wandering.rows, wandering.known, wandering.unpredicted
        clock = np.arange(len(unpredicted)) / len(rows)
        places = np.linspace(BESIDE, len(rows) - BESIDE, MOMENTS).astype(int)
        bends = np.maximum(clock[:, None] - clock[places - 1], 0.0)
        # All moments at once: what neither the loads nor the reading before predicts of each line.
        together = np.column_stack([clock, bends])
        lines = together - known @ (known.T @ together)
        lines = np.where((lines**2).sum(0) > SEEN * (together**2).sum(0), lines, 0.0)
        line, bends = lines[:, 0], lines[:, 1:]
        whole = np.maximum((bends**2).sum(0), TINY)
        bends = bends - np.outer(line, line @ bends) / max(float(line @ line), TINY)
        bends = np.where((bends**2).sum(0) > SEEN * whole, bends, 0.0)
        fitted = (line @ unpredicted) ** 2 / max(float(line @ line), TINY)
        fitted = fitted + (bends.T @ unpredicted) ** 2 / np.maximum((bends**2).sum(0), TINY)
        alone = max(float(unpredicted @ unpredicted), TINY)
        gained = -wandering.freedom / 2 * np.log(np.maximum(1 - fitted / alone, SEEN))
        place = int(np.argmax(gained))
        if gained[place] > BEYOND_WANDERING and (best is None or gained[place] > best[0]):
            best = (float(gained[place]), int(rows[places[place]]))
    return None if best is None else best[1]


def _with_whole_step(left: FloatArray, basis: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a fit leaves, given back what it took of the likeliest step; and less that step.

    The loads fit a large step in part, and what they put there hides it among jumps of their own.

    Args:
        left: float[readings].
        basis: orthonormal, of the span of the fit, float[readings, k].
    """
    readings = len(left)
    if readings <= max(2 * BESIDE, 2 * basis.shape[1]):
        return left, left
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


def _orthonormal(basis: FloatArray, most: int) -> FloatArray:
    with_constant = np.column_stack([np.ones(len(basis)), basis])
    scale = np.linalg.norm(with_constant, axis=0)
    u, s, _ = thin_svd(with_constant / np.where(scale > 0, scale, 1.0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, :most])
