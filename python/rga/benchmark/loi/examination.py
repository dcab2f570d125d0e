"""Test rows, as calibrated methods infer them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rga.benchmark.loi.drift import Measured
from rga.benchmark.loi.method import Calibrated, Estimate
from rga.benchmark.loi.score import Score, score
from rga.model.parameter import FloatArray


class Examination:
    """Scores methods on test rows, which no method infers twice.

    Args:
        measured: the rows.
        ranges: smallest and largest of each context, float[contexts, 2].
        block: rows for which one method is chosen among several.
    """

    def __init__(self, measured: Measured, ranges: FloatArray, block: int) -> None:
        self._measured, self._ranges = measured, ranges
        self._block = np.arange(len(measured.readings)) // block
        # Methods are kept, so that no other one gets the id of one.
        self._known: dict[int, tuple[Calibrated, Estimate, FloatArray]] = {}

    def score(self, candidates: Sequence[Calibrated]) -> Score:
        """Of the candidate that leaves the least gap on each block."""
        known = [self._inferred(one) for one in {id(one): one for one in candidates}.values()]
        if len(known) == 1:
            _, estimate, simulated = known[0]
            return score(self._measured, estimate, simulated, self._ranges)
        gaps = [((self._measured.readings - one) ** 2).mean(axis=1) for *_, one in known]
        left = [np.bincount(self._block, of_row) for of_row in gaps]
        chosen = np.argmin(left, axis=0)[self._block]
        spreads = [one.spread for _, one, _ in known if one.spread is not None]
        estimate = Estimate(
            _picked([one.value for _, one, _ in known], chosen),
            _picked(spreads, chosen) if spreads else None,
        )
        return score(
            self._measured, estimate, _picked([one for *_, one in known], chosen), self._ranges
        )

    def _inferred(self, method: Calibrated) -> tuple[Calibrated, Estimate, FloatArray]:
        if id(method) not in self._known:
            estimate = method.infer(self._measured.readings)
            self._known[id(method)] = method, estimate, method.simulate(estimate.value)
        return self._known[id(method)]


def _picked(several: Sequence[FloatArray], chosen: NDArray[np.intp]) -> FloatArray:
    """Each row from the array of its number."""
    return np.asarray(np.stack(several)[chosen, np.arange(len(chosen))])
