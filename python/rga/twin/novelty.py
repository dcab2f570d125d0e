"""T2: should a newly inferred context and its simulation join the repository?"""

import numpy as np
import scipy
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: share of the neighbours' distances in the design phase that counts as known ground
KNOWN_GROUND = 0.95
#: share of their spread by which contexts may lie outside all others and be like them
BESIDE = 0.1


def beside(contexts: FloatArray, others: FloatArray) -> NDArray[np.bool_]:
    """Which rows have a context that none of others had, bool[rows].

    Args:
        contexts: of the rows, float[rows, contexts].
        others: float[others, contexts], one row or more.
    """
    low, high = others.min(axis=0), others.max(axis=0)
    reach = BESIDE * (high - low)
    return np.asarray(((contexts < low - reach) | (contexts > high + reach)).any(axis=1))


def spacing(contexts: FloatArray, width: FloatArray) -> float:
    """Distance that hardly any context of the design phase has to its neighbour.

    Args:
        contexts: float[n, contexts].
        width: of the range of each, float[contexts].
    """
    scaled = contexts / width
    if len(scaled) < 2:
        return 0.0
    near, _ = scipy.spatial.cKDTree(scaled).query(scaled, k=2)
    return float(np.quantile(near[:, 1], KNOWN_GROUND))


def novel(
    gaps: FloatArray,
    contexts: FloatArray,
    *,
    bound: FloatArray,
    stored: FloatArray,
    width: FloatArray,
    distinct: float,
) -> list[int]:
    """Rows to store, by the paper's two checks, each against what the rows before it added.

    The gap of every sensor stays below mean + z standard deviations of the errors known so far,
    and min d(c_t, c_r) over all stored contexts c_r exceeds the threshold.

    Args:
        gaps: squared gaps of the rows, float[n, channels], NaN where missing.
        contexts: of the rows, float[n, contexts].
        bound: mean + z standard deviations of the errors known so far, float[channels].
        stored: contexts in the repository, float[k, contexts].
        width: of the range of each context: distances are in shares of it, float[contexts].
        distinct: the threshold.

    Returns:
        Numbers of the rows among the n.
    """
    if not len(contexts):
        return []
    credible = np.asarray(~(gaps > bound).any(axis=1) & np.isfinite(gaps).any(axis=1))
    known = scipy.spatial.cKDTree(stored / width) if len(stored) else None
    chosen: list[int] = []
    for row in np.flatnonzero(credible):
        place = contexts[row] / width
        near = float(known.query(place)[0]) if known is not None else np.inf
        fresh = contexts[chosen] / width
        if len(fresh):
            near = min(near, float(np.linalg.norm(fresh - place, axis=1).min()))
        if near > distinct:
            chosen.append(int(row))
    return chosen
