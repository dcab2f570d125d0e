"""Blocks of rows that no step of a diagnosis sees, and the gain on them."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import bootstrap

from rga.diagnosis.row_covariance import BoolArray
from rga.errors import InputError
from rga.model.parameter import FloatArray

BLOCKS = 25
EVERY = 5
PIECES = 6


@dataclass(frozen=True)
class Gain:
    """Gap before and after on held-out rows, and the gain with its 90 % interval [-]."""

    before: float
    after: float
    interval: tuple[float, float]


def held_out_rows(rows: int) -> BoolArray:
    """Every fifth of twenty-five blocks of rows, bool[rows].

    >>> held_out_rows(100).sum()
    np.int64(20)
    """
    block = np.arange(rows) * BLOCKS // rows
    return np.asarray(block % EVERY == EVERY // 2)


def gain(before: FloatArray, after: FloatArray, held_out: BoolArray, seed: int) -> Gain:
    """Gap before and after on held-out rows, with a block bootstrap of their difference.

    Args:
        before: squared residual over its variance, float[rows, sensors], NaN where missing.
        after: the same of the extended model.
        held_out: bool[rows], in blocks.
        seed: of the bootstrap.

    Raises:
        InputError: no held-out row has a reading to compare.
    """
    rows = np.flatnonzero(held_out & np.isfinite(before).any(1))
    if not len(rows):
        raise InputError(
            "no held-out row has a reading to compare", "record", "give more rows under load"
        )
    pieces = [
        piece
        for block in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
        for piece in np.array_split(block, min(PIECES, len(block)))
        if len(piece)
    ]
    gains = np.array([np.nanmean(before[piece] - after[piece]) for piece in pieces])
    interval = (float(gains.min()), float(gains.max()))
    if len(gains) > 2 and np.ptp(gains) > 0:
        found = bootstrap(
            (gains,),
            np.mean,
            confidence_level=0.9,
            method="percentile",
            rng=np.random.default_rng(seed),
        ).confidence_interval
        interval = (float(found.low), float(found.high))
    return Gain(float(np.nanmean(before[rows])), float(np.nanmean(after[rows])), interval)
