"""The paper's repository (T2): simulations around novel contexts join those learned from."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from rga.benchmark.loi.contexts import BEYOND
from rga.benchmark.loi.data import Calibration
from rga.benchmark.loi.levels import Learned, State
from rga.benchmark.loi.rows import Row
from rga.inference.rows import Rows
from rga.model.parameter import FloatArray

#: a context is novel where its nearest simulation is farther away than this share of the
#: simulations are from each other
QUANTILE = 0.99
#: simulations around each novel context, and how far these scatter [widths of the ranges]
AROUND, SCATTER = 8, 0.05


def with_novel(row: Row, known: Calibration, rows: FloatArray) -> Learned:
    """A state that has learned from rows of a stream, and from simulations like them.

    Where contexts are novel, the method learns anew from all simulations before it learns from
    the rows.

    Args:
        row: the method.
        known: what it was calibrated on.
        rows: of the stream, float[n, sensors].
    """
    source = known.problem.source

    def learned(state: State, recent: slice) -> State:
        nonlocal source
        calibrated = state.calibrated
        problem = replace(known.problem, source=source)
        low, high = problem.ranges.T
        width = high - low
        inferred = calibrated.infer(rows[recent]).value
        novel = _novel((source.contexts - low) / width, (inferred - low) / width)
        if novel.any():
            generator = np.random.default_rng([problem.seed, recent.start, recent.stop])
            around = np.repeat(inferred[novel], AROUND, axis=0)
            around = around + SCATTER * width * generator.standard_normal(around.shape)
            around = np.clip(around, low, high + BEYOND * width)
            source = Rows(
                np.concatenate([source.contexts, around]),
                np.concatenate([source.readings, problem.simulate(around)]),
            )
            calibrated = row.calibrated(replace(known, problem=replace(problem, source=source)))
        after = calibrated.recalibrated(rows[recent])
        return state if after is state.calibrated else State.of(after, known.problem.real, rows)

    return learned


def _novel(simulated: FloatArray, inferred: FloatArray) -> NDArray[np.bool_]:
    """Which contexts are far from all that were simulated, bool[n]."""
    tree = KDTree(simulated)
    apart = tree.query(simulated, k=2)[0][:, 1]
    return np.asarray(tree.query(inferred)[0] > np.quantile(apart, QUANTILE))
