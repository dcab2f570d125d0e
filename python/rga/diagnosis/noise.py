"""How noisy the sensors are, with what memory, and how far off the measured contexts.

The noise is estimated on what no linear structure can explain: the part of each channel that is
not a combination of the load coefficients, nor a step at one moment. So an effect that is hidden in
the record does not pass for noise, as long as it leaves the structure linear; one that changes with
time may pass for a little of it.
"""

import numpy as np
from scipy.linalg import lstsq

from rga.diagnosis.row_covariance import BoolArray, Noise, RowCovariance
from rga.model.parameter import FloatArray

ITERATIONS = 12
LARGEST_MEMORY = 0.995
#: a step: a jump from one row to the next of so many robust deviations of such jumps, by which the
#: median of so many rows before and after differs too
JUMP, BESIDE = 6.0, 12


def unexplainable(residual: FloatArray, observed: BoolArray, basis: FloatArray) -> FloatArray:
    """The part of a residual that no linear structure under these loads has.

    Args:
        residual: float[rows, sensors].
        observed: bool[rows, sensors].
        basis: float[rows, patterns], the load coefficients.

    Returns:
        float[rows, sensors], scaled for the degrees of freedom that the fit takes.
    """
    span = _orthonormal(basis, max(1, len(residual) // 12))
    left = _left(residual, observed, span)
    moment = _step(left, observed)
    if moment is not None:
        # A step would else pass for noise with a long memory, the better the larger it is.
        step = (np.arange(len(residual)) >= moment).astype(float)
        left = _left(residual, observed, np.column_stack([span, step]))
    return left


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


def _step(left: FloatArray, observed: BoolArray) -> int | None:
    """The row at which the channels jump most and stay, if any does."""
    best: tuple[float, int] | None = None
    for sensor in range(left.shape[1]):
        rows = np.flatnonzero(observed[:, sensor])
        column = left[rows, sensor]
        jumps = np.abs(np.diff(column))
        scale = 1.4826 * float(np.median(jumps)) if len(jumps) else 0.0
        for place in np.flatnonzero(jumps > JUMP * scale) + 1 if scale > 0 else ():
            if not BESIDE <= place <= len(column) - BESIDE:
                continue
            before, after = column[place - BESIDE : place], column[place : place + BESIDE]
            shift = abs(float(np.median(after) - np.median(before))) / scale
            if shift > JUMP and (best is None or shift > best[0]):
                best = (shift, int(rows[place]))
    return None if best is None else best[1]


def estimate_noise(
    left: FloatArray,
    time: FloatArray,
    observed: BoolArray,
    context_jacobian: FloatArray,
    start: Noise,
    context_known: BoolArray,
    floor: FloatArray,
) -> Noise:
    """Noise of the sensors and of the contexts by expectation and maximisation.

    Args:
        left: residual without what a model could explain, float[rows, sensors].
        time: float[rows] [s].
        observed: bool[rows, sensors].
        context_jacobian: float[rows, sensors, contexts].
        start: where to begin.
        context_known: bool[contexts], True where the model states the context's noise.
        floor: least standard deviation of each sensor, float[sensors].
    """
    noise = start
    counts = np.maximum(observed.sum(0), 1)
    pairs = observed[1:] & observed[:-1]
    for _ in range(ITERATIONS):
        rows = RowCovariance(noise, time, observed, context_jacobian)
        error = rows.context_error(left)
        # The posterior variance of a context in its own row, neighbours left out.
        precise = np.einsum("ts,tsi,tsj->tij", rows.weight.T**2, context_jacobian, context_jacobian)
        variance = np.linalg.inv(precise + np.diag(noise.context_sigma**-2.0))
        rest = np.where(observed, left - np.einsum("tsi,ti->ts", context_jacobian, error), 0.0)
        hidden = np.einsum("tsi,tij,tsj->ts", context_jacobian, variance, context_jacobian)
        square = (rest**2 + np.where(observed, hidden, 0.0)).sum(0) / counts
        product = (rest[1:] * rest[:-1] * pairs).sum(0)
        before = ((rest[:-1] ** 2 + hidden[:-1]) * pairs).sum(0)
        phi = np.clip(product / np.maximum(before, 1e-300), 0.0, LARGEST_MEMORY)
        context = np.sqrt((error**2 + np.einsum("tii->ti", variance)).mean(0))
        noise = Noise(
            sigma=np.maximum(np.sqrt(square), floor),
            phi=phi,
            context_sigma=np.where(context_known, noise.context_sigma, np.maximum(context, 1e-9)),
        )
    return noise


def _orthonormal(basis: FloatArray, most: int) -> FloatArray:
    with_constant = np.column_stack([np.ones(len(basis)), basis])
    scale = np.linalg.norm(with_constant, axis=0)
    u, s, _ = np.linalg.svd(with_constant / np.where(scale > 0, scale, 1.0), full_matrices=False)
    return np.asarray(u[:, s > 1e-6 * s[0]][:, :most])
