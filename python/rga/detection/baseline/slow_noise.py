"""Noise so slow that the memory of an autoregression does not see it."""

import numpy as np

from rga.arrays import FloatArray

#: correlation of slow noise with the row before
SLOW = 0.9
#: rows of a block over which it adds up, and blocks to tell it from chance by, at least
BLOCK, FEWEST = 36, 6
#: part of it that blocks of these rows show: the variance of their sums over that of endless ones
SHOWN = 1.0 - 2.0 * SLOW * (1.0 - SLOW**BLOCK) / (BLOCK * (1.0 - SLOW**2))
#: what nine sensors in ten stay below, in standard deviations between sensors
NINE_IN_TEN = 1.28
#: what sums of residuals of a real structure vary more by, and blocks that say as much as knowing
#: so: models of bridges leave 1.1 to 1.7 times what independent scores have, and a baseline of a
#: few days cannot tell
USUAL, WORTH = 0.35, 12


def long_run_variance(scores: FloatArray) -> float:
    """Variance that sums of scores have over that of independent ones, in most sensors [-].

    From means over blocks (batch means: Conway, Management Science 10, 1963), as large as nine
    sensors in ten have it, without what chance makes of so few blocks; where they are few, at least
    what is usual.

    Args:
        scores: float[rows, sensors], NaN where missing.

    Returns:
        Near 1 where many rows show nothing.
    """
    blocks = len(scores) // BLOCK
    shown = _shown(scores, blocks)
    return 1.0 + max(shown, (blocks * shown + WORTH * USUAL) / (blocks + WORTH))


def _shown(scores: FloatArray, blocks: int) -> float:
    """What blocks show beyond 1."""
    if blocks < FEWEST:
        return 0.0
    parts = scores[: blocks * BLOCK].reshape(blocks, BLOCK, -1)
    count = np.isfinite(parts).sum(axis=1)
    sums = np.nansum(parts, axis=1) - count * np.nanmean(scores, axis=0)
    sizes = count.sum(axis=0) * np.nanvar(scores, axis=0)
    told = sizes > 0
    if not told.any():
        return 0.0
    ratio = (sums[:, told] ** 2).sum(axis=0) / sizes[told] * blocks / (blocks - 1)
    chance = 2.0 / blocks
    mean = float(ratio.mean())
    between = max(float(ratio.var()) - chance * mean**2, 0.0)
    sure = mean - np.sqrt((between + chance * mean**2) / len(ratio))
    excess = float(sure + NINE_IN_TEN * np.sqrt(between)) - 1.0
    return max(excess, 0.0) / SHOWN
