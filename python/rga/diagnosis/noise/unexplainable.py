"""The part of a residual that no linear structure can explain: noise, and errors of contexts.

That is what of each channel is not a combination of the load coefficients, nor a step at one
moment, nor a drift from one on. So an effect that is hidden in the record does not pass for noise,
as long as it leaves the structure linear; one that changes with time may pass for a little of it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq

from rga.arrays import BoolArray, FloatArray
from rga.numerics.decompositions import thin_svd

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
    moment = _jump(left, observed, span)
    if moment is None:
        moment = _shift(left, observed, span)
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


def _jump(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
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


@dataclass(frozen=True)
class _Wandering:
    """A channel whose reading is predicted by the one before and by the loads of both.

    Attributes:
        reading: each but the first, float[readings - 1].
        predictors: of it, float[readings - 1, k]; the second is the reading before.
        known: their orthonormal basis, float[readings - 1, at most k].
        unpredicted: the part of the readings that they leave, float[readings - 1].
    """

    reading: FloatArray
    predictors: FloatArray
    known: FloatArray
    unpredicted: FloatArray

    @classmethod
    def of(cls, column: FloatArray, loads: FloatArray) -> "_Wandering | None":
        """None where the readings are too few to tell.

        Args:
            column: float[readings].
            loads: float[readings, patterns]. They fit a large change in part, so that they are
                fitted anew beside it.
        """
        reading = column[1:]
        predictors = np.column_stack([np.ones(len(reading)), column[:-1], loads[1:], loads[:-1]])
        if len(reading) - predictors.shape[1] <= 4 * BESIDE:
            return None
        known, strength, _ = thin_svd(predictors)
        known = known[:, strength > 1e-12 * strength[0]]
        return cls(reading, predictors, known, reading - known @ (known.T @ reading))

    @property
    def freedom(self) -> int:
        readings, predictors = self.predictors.shape
        return int(readings - predictors)

    def loss(self, *more: FloatArray) -> tuple[float, FloatArray]:
        """Minus the greatest log likelihood with more predictors, and their weights."""
        predictors = np.column_stack([self.predictors, *more])
        weights = lstsq(predictors, self.reading)[0]
        rest = self.reading - predictors @ weights
        return self.freedom / 2 * float(np.log(max(float(rest @ rest), TINY))), weights


def _shift(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
    """The row from which on a channel keeps to another level, if any does.

    At that row it jumps, and ever after it comes back to the new level as it did to the old. The
    jump alone says nothing: an outlier has it as well.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    best: tuple[float, int] | None = None
    for sensor in range(left.shape[1]):
        rows = np.flatnonzero(observed[:, sensor])
        wandering = _Wandering.of(left[rows, sensor], span[rows])
        if wandering is None:
            continue
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
        free, weights = wandering.loss(at, since)
        of_one_size, _ = wandering.loss(at + (1 - weights[1]) * since)
        if of_one_size - free < AGREES:
            best = (float(gained[place]), int(rows[jump[place] + 1]))
    return None if best is None else best[1]


def _growth(left: FloatArray, observed: BoolArray, span: FloatArray) -> int | None:
    """The row from which on a channel drifts in another way than before, if any does.

    A reading is predicted by the one before, with a line that bends at a row or without: what only
    wanders needs no such line.

    Args:
        left: what a fit by the span leaves, float[rows, sensors].
        observed: bool[rows, sensors].
        span: of the fit, float[rows, k].
    """
    best: tuple[float, int] | None = None
    for sensor in range(left.shape[1]):
        rows = np.flatnonzero(observed[:, sensor])
        wandering = _Wandering.of(left[rows, sensor], span[rows])
        if wandering is None:
            continue
        known, unpredicted = wandering.known, wandering.unpredicted
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


def _orthonormal(basis: FloatArray, most: int) -> FloatArray:
    with_constant = np.column_stack([np.ones(len(basis)), basis])
    scale = np.linalg.norm(with_constant, axis=0)
    u, s, _ = thin_svd(with_constant / np.where(scale > 0, scale, 1.0))
    return np.asarray(u[:, s > 1e-6 * s[0]][:, :most])
