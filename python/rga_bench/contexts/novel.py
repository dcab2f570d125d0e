"""The paper's repository (T2): simulations around novel contexts join those learned from."""

from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.inference.rows import Rows
from rga.twin.novelty import novel, spacing
from rga.twin.settings import Settings
from rga_bench.contexts.context_regime import BEYOND
from rga_bench.contexts.data import CalibrationData
from rga_bench.contexts.levels import CalibratedMethod, Learned
from rga_bench.contexts.method import Calibrated
from rga_bench.contexts.rows import Row

#: simulations around each novel context, and how far these scatter [widths of the ranges]
AROUND, SCATTER = 8, 0.05


def with_novel(row: Row, known: CalibrationData, rows: FloatArray) -> Learned:
    """A state that has learned from rows of a stream, and from simulations like them.

    Where contexts are credible and novel by the paper's checks, the method learns anew from all
    simulations before it learns from the rows.

    Args:
        row: the method.
        known: what it was calibrated on.
        rows: of the stream, float[n, sensors].
    """
    source = known.problem.source

    def learned(state: CalibratedMethod, recent: slice) -> CalibratedMethod:
        nonlocal source
        problem = replace(known.problem, source=source)
        low, high = problem.ranges.T
        width, calibrated = high - low, state.calibrated
        inferred, gaps = _inferred(calibrated, rows[recent])
        chosen = novel(
            gaps,
            inferred,
            errors=_inferred(calibrated, problem.real)[1],
            stored=source.contexts,
            width=width,
            z=Settings().repository_z,
            distinct=spacing(known.problem.source.contexts, width),
        )
        if chosen:
            generator = np.random.default_rng([problem.seed, recent.start, recent.stop])
            around = np.repeat(inferred[chosen], AROUND, axis=0)
            around = around + SCATTER * width * generator.standard_normal(around.shape)
            around = np.clip(around, low, high + BEYOND * width)
            source = Rows(
                np.concatenate([source.contexts, around]),
                np.concatenate([source.readings, problem.simulate(around)]),
            )
            calibrated = row.calibrated(replace(known, problem=replace(problem, source=source)))
        after = calibrated.recalibrated(rows[recent])
        return (
            state
            if after is state.calibrated
            else CalibratedMethod.of(after, known.problem.real, rows)
        )

    return learned


def _inferred(calibrated: Calibrated, readings: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Contexts of rows, and their squared gaps, float[n, sensors]."""
    contexts = calibrated.infer(readings).value
    return contexts, (readings - calibrated.simulate(contexts)) ** 2
