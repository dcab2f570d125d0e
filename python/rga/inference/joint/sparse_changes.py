"""Which few of many parameters have changed since they were found, by the evidence of new rows."""

import numpy as np
from scipy.special import chdtri

from rga.arrays import FloatArray, IntArray

#: evidence from which a parameter is held to have changed [squared standard deviations]
EVIDENT = 16.0
#: share of the most that rows say of a parameter, below which they say nothing of another
SILENT = 1e-9
#: median of that of parameters that have not
ORDINARY = float(chdtri(1, 0.5))


def sparse_changes(
    information: FloatArray, pull: FloatArray, covariance: FloatArray, kinds: IntArray
) -> FloatArray:
    """Variances of changes, each by the likelihood of the rows with it integrated out as it joins.

    Parameters are off by what was left open of them, all together, and few have changed beside
    that, by far more. These are added one by one, the one with the most evidence first, and left
    out again where others explain them (sparse Bayesian learning: Tipping and Faul, Proc. 9th Int.
    Workshop on Artificial Intelligence and Statistics, 2003). Evidence is counted in multiples of
    its median, as a model's error raises that of all of them (genomic control: Devlin and Roeder,
    Biometrics 55, 1999).

    Args:
        information: of the rows about the parameters, float[parameters, parameters].
        pull: that information times what the rows alone would have them differ by from what was
            found, float[parameters].
        covariance: of what was left open, float[parameters, parameters].
        kinds: number of the kind of each parameter, among which the median is taken,
            int[parameters].

    Returns:
        float[parameters], 0 where nothing has changed.

    Ten parameters were found to within 1, and the third has changed by 30:

    >>> found, rows = np.eye(10), 100.0 * np.eye(10)
    >>> differ = np.array([0.5, -0.9, 30.0, 1.1, 0.0, -0.3, 0.8, -1.2, 0.4, 0.7])
    >>> np.flatnonzero(sparse_changes(rows, rows @ differ, found, np.zeros(10, int))).tolist()
    [2]
    """
    seen = information @ np.linalg.inv(np.eye(len(pull)) + covariance @ information)
    left = pull - seen @ covariance @ pull
    changed = np.zeros(len(pull))
    told = np.diagonal(information) > SILENT * np.diagonal(information).max(initial=0.0)
    kinds = np.where(told, kinds, -1)
    for _ in range(2 * len(pull)):
        evidence, size = _evidence(seen, left, changed)
        weak = (changed > 0) & (evidence < _limit(evidence, changed, kinds))
        if weak.any():
            changed[np.argmin(np.where(weak, evidence, np.inf))] = 0.0
            continue
        strongest = int(np.argmax(np.where(told & (changed == 0), evidence, -1.0)))
        tried = changed.copy()
        tried[strongest] = max(size[strongest], 0.0)
        # What has changed raises the evidence of others as long as it is not among them.
        limit = _limit(_evidence(seen, left, tried)[0], tried, kinds)
        if evidence[strongest] < limit[strongest]:
            break
        changed = tried
    return changed


def _limit(evidence: FloatArray, changed: FloatArray, kinds: IntArray) -> FloatArray:
    """Evidence that a change takes, which a model's error raises, kind by kind."""
    limit = np.full(len(evidence), EVIDENT)
    for kind in np.unique(kinds):
        usual = evidence[(kinds == kind) & (changed == 0)]
        if len(usual):
            limit[kinds == kind] *= max(1.0, float(np.median(usual)) / ORDINARY)
    return limit


def _evidence(
    seen: FloatArray, left: FloatArray, changed: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Evidence that each parameter has changed beside the others, and by what variance."""
    sure, moved = _without_each(seen, left, changed)
    known = sure > 0
    evidence = np.divide(moved**2, sure, out=np.zeros_like(sure), where=known)
    size = np.divide(evidence - 1.0, sure, out=np.zeros_like(sure), where=known)
    return evidence, size


def _without_each(
    seen: FloatArray, left: FloatArray, changed: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Information about the change of each parameter, and its pull, were it not known to change."""
    own = np.flatnonzero(changed)
    among = np.linalg.inv(seen[np.ix_(own, own)] + np.diag(1.0 / changed[own]))
    beside = seen[:, own] @ among
    sure = np.diagonal(seen) - np.einsum("pa,pa->p", beside, seen[:, own])
    moved = left - beside @ left[own]
    # Taking a parameter of variance v out of those that change.
    factor = np.ones(len(changed))
    factor[own] = 1.0 / (1.0 - changed[own] * sure[own])
    return np.asarray(sure * factor), np.asarray(moved * factor)
