"""How well contexts were inferred, and what gap they leave."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.twin.history import History
from rga_bench.contexts.drift import MeasuredRows
from rga_bench.contexts.method import Estimate

#: half of a 90 % interval [standard deviations]
REACH = 1.6449


@dataclass(frozen=True)
class Score:
    """How good inferred contexts are.

    Attributes:
        rg: mean over rows and sensors of the squared gap [mm^2].
        error: mean over contexts of MSE / (range^2 / 12) [-]; None where nothing is inferred.
        errors: root of the mean squared error of each context, in its unit.
        coverage: share of the rows whose 90 % interval holds each context; None where a method
            has none.
    """

    rg: float
    error: float | None = None
    errors: tuple[float, ...] | None = None
    coverage: tuple[float, ...] | None = None


def score(
    measured: MeasuredRows, estimate: Estimate, simulated: FloatArray, ranges: FloatArray
) -> Score:
    """Hold what was inferred against the truth.

    Error weighs every context alike, by the variance of an even distribution over its range, so
    that the middle of the ranges has an Error of 1 where contexts are spread evenly.

    Args:
        measured: with the true contexts.
        estimate: of the same rows.
        simulated: at the estimate, in the units of the sensors, float[n, sensors].
        ranges: smallest and largest of each context, float[contexts, 2].
    """
    deviation = estimate.value - measured.contexts
    squared = (deviation**2).mean(axis=0)
    weighed = squared / (np.ptp(ranges, axis=1) ** 2 / 12.0)
    coverage = None
    if estimate.spread is not None:
        held = np.abs(deviation) <= REACH * estimate.spread
        coverage = tuple(held.mean(axis=0).tolist())
    return Score(
        rg=gap(measured.readings - simulated),
        error=float(weighed.mean()),
        errors=tuple(np.sqrt(squared).tolist()),
        coverage=coverage,
    )


def score_of_history(
    history: History, contexts: FloatArray, rows: slice, ranges: FloatArray
) -> Score:
    """How good the contexts of rows are, as a twin inferred them at the time.

    Args:
        history: of the twin.
        contexts: true ones of all rows, float[n, contexts].
        rows: to look at.
        ranges: smallest and largest of each context, float[contexts, 2].
    """
    spread = history.spread[rows]
    estimate = Estimate(history.inferred[rows], spread if np.isfinite(spread).any() else None)
    measured = MeasuredRows(contexts[rows], history.record.readings[rows], np.zeros(0))
    return score(measured, estimate, history.simulated[rows], ranges)


def gap(residuals: FloatArray) -> float:
    """The mean of the squares [mm^2]."""
    return float(np.mean(residuals**2))
