"""Test rows, as calibrated methods infer them."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray
from rga_bench.contexts.drift import MeasuredRows
from rga_bench.contexts.levels import CalibratedMethod, most_likely
from rga_bench.contexts.method import Calibrated, Estimate
from rga_bench.contexts.score import Score, score


class Evaluation:
    """Scores methods on test rows, which no method infers twice.

    Args:
        measured: the rows.
        ranges: smallest and largest of each context, float[contexts, 2].
        block: rows for which one state is chosen among several.
    """

    def __init__(self, measured: MeasuredRows, ranges: FloatArray, block: int) -> None:
        self._measured, self._ranges = measured, ranges
        self._block = block
        # Methods are kept, so that no other one gets the id of one.
        self._known: dict[int, tuple[Calibrated, tuple[Estimate, FloatArray]]] = {}

    def score(self, method: Calibrated) -> Score:
        """Of one method for all rows."""
        estimate, simulated = self._inferred(method)
        return score(self._measured, estimate, simulated, self._ranges)

    def score_of_likeliest(self, states: Sequence[CalibratedMethod]) -> Score:
        """Of the state, for each block of rows, after which what it leaves of them is likeliest."""
        known = [self._inferred(one.calibrated) for one in states]
        left = [self._measured.readings - simulated for _, simulated in known]
        rows = np.arange(len(self._measured.readings))
        chosen = np.zeros_like(rows)
        for first in range(0, len(rows), self._block):
            block = slice(first, first + self._block)
            chosen[block] = most_likely(states, [one[block] for one in left])

        def picked(several: Sequence[FloatArray]) -> FloatArray:
            return np.asarray(np.stack(several)[chosen, rows])

        spreads = [estimate.spread for estimate, _ in known if estimate.spread is not None]
        value = picked([estimate.value for estimate, _ in known])
        return score(
            self._measured,
            Estimate(value, picked(spreads) if spreads else None),
            picked([simulated for _, simulated in known]),
            self._ranges,
        )

    def _inferred(self, method: Calibrated) -> tuple[Estimate, FloatArray]:
        """Estimate, and what is simulated there."""
        if id(method) not in self._known:
            estimate = method.infer(self._measured.readings)
            self._known[id(method)] = method, (estimate, method.simulate(estimate.value))
        return self._known[id(method)][1]
