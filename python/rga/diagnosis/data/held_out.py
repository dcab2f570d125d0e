"""Blocks of rows that no step of a diagnosis sees, and the gain by their readings."""

from dataclasses import dataclass

import numpy as np
import scipy
from scipy.special import ndtr, stdtrit

from rga.arrays import BoolArray, FloatArray
from rga.errors import InputError

#: blocks of a record, and the one in so many that is held out: ten blocks for a bootstrap, four
#: fifths of the rows to learn from
BLOCKS, EVERY = 50, 5
#: change over the noise below which a reading does not feel it
UNFELT = 1e-6
#: of the interval of the gain, as of all intervals of the findings (`ci90`)
CONFIDENCE = 0.9


@dataclass(frozen=True)
class Gain:
    """Gap of the record before and after, and the 90 % interval of their difference [-]."""

    before: float
    after: float
    interval: tuple[float, float]


def held_out_rows(rows: int) -> BoolArray:
    """Every fifth of fifty blocks of rows, bool[rows]; of fewer than fifty rows every fifth.

    >>> held_out_rows(100).sum(), held_out_rows(12).sum()
    (np.int64(20), np.int64(2))
    """
    block = np.arange(rows) * min(BLOCKS, rows) // rows
    return np.asarray(block % EVERY == EVERY // 2)


def gain(left: FloatArray, change: FloatArray, held_out: BoolArray, seed: int) -> Gain:
    """Gap of the record before and after by readings that no step saw, and the gain.

    With d the change of the simulation and r what the extended model leaves, both over the noise,
    the model as given leaves r + d, and the gain is the mean of (r + d)^2 - r^2 = d^2 + 2 d r. The
    first term needs no reading and is known in every row; the held-out blocks have to stand for
    the second alone, so that loads which they happen to miss are no uncertainty of the gain. This
    is the difference estimator of survey sampling (Cochran 1977, Sampling Techniques, 7.2).

    The interval is a block bootstrap of the second term. As the blocks are few, percentiles are
    moved outwards as far as Student's t is wider than a normal distribution (Hesterberg 2015, The
    American Statistician 69, 371: the expanded percentile interval). Where no held-out reading
    feels the change, nothing stands for the second term: it is then only known to lie within
    2 sqrt(mean d^2 mean r^2) of zero (Cauchy and Schwarz).

    Args:
        left: residual of the extended model over its noise, float[rows, sensors], NaN where
            missing.
        change: simulation of the extended model less that of the model as given, over the same
            noise, float[rows, sensors].
        held_out: bool[rows], in blocks.
        seed: of the bootstrap.

    Raises:
        InputError: fewer than two held-out blocks have a reading to compare.
    """
    seen = np.isfinite(left) & np.isfinite(change)
    count = seen.sum(1)
    rows = np.flatnonzero(held_out)
    blocks = [
        block
        for block in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
        if count[block].any()
    ]
    if len(blocks) < 2:
        raise InputError(
            "fewer than two held-out blocks have a reading to compare",
            "record",
            "give more rows under load",
        )
    product = np.where(seen, 2 * change * left, 0.0).sum(1)
    sums = [np.array([column[block].sum() for block in blocks]) for column in (product, count)]
    wide = stdtrit(len(blocks) - 1, 0.5 + CONFIDENCE / 2) * np.sqrt(len(blocks) / (len(blocks) - 1))
    found = scipy.stats.bootstrap(
        sums,
        lambda product, count, axis: product.sum(axis) / count.sum(axis),
        paired=True,
        confidence_level=2 * ndtr(wide) - 1,
        method="percentile",
        rng=np.random.default_rng(seed),
    ).confidence_interval
    known = float((change[seen] ** 2).mean())
    after = float((left[rows][seen[rows]] ** 2).mean())
    low, high = float(found.low), float(found.high)
    felt = np.abs(np.where(seen, change, 0.0))[rows].max(initial=0.0)
    if felt <= UNFELT < np.sqrt(known):
        high = 2 * float(np.sqrt(known * after))
        low = -high
    return Gain(
        before=known + float(sums[0].sum() / sums[1].sum()) + after,
        after=after,
        interval=(known + low, known + high),
    )
