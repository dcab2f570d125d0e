"""Scores: approximate log evidence of hypotheses, from sums of their signatures alone."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.search.signatures import Block

#: d' below which a signature has no size: what rounding leaves of it, which promises nothing
NO_SIZE = 1e-6


def gained(along: FloatArray, size: FloatArray) -> FloatArray:
    """What signatures gain in likelihood at their best amplitude, twice its log."""
    sized = size > NO_SIZE**2
    return np.where(sized, along**2 / np.where(sized, size, 1.0), 0.0)


def scored(
    block: Block, along: FloatArray, size: FloatArray, prior: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Scores of signatures with x' C^-1 r = along and x' C^-1 x = size, and z of their best.

    The latter is float[k], the value of all coordinates, or NaN: those of the trial.
    """
    sized = size > NO_SIZE**2
    size, along = np.where(sized, size, 1.0), np.where(sized, along, 0.0)
    first = np.where(block.free & block.linear, block.z[:, 0], 1.0)
    # Linear in z: the evidence is exact.
    per_z = size / first**2
    linear = (along / first) ** 2 / (1 + per_z) / 2 - np.log1p(per_z) / 2
    # A curve: the amplitude may differ a little from that of the trial, not in sign.
    amplitude = np.clip(along / size, 0.0, 3.0)
    curve = amplitude * along - amplitude**2 * size / 2 - (block.z**2).sum(1) / 2
    fixed = along - size / 2
    score = np.where(block.free, np.where(block.linear, linear, curve), fixed)
    start = np.where(block.free & block.linear, along / first / (1 + per_z), np.nan)
    return np.where(sized, score + prior, -np.inf), start
