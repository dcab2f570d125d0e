"""A channel that answers the loads in a way of its own.

A wire that picks up another channel, or a gauge that reads more than its member, answers the loads
linearly, as a structure does, and alone among the channels. Causes of the structure may imitate
that. So a channel whose responses are free is held against all causes of the structure
together: by the marginal likelihood, which charges for every response that is free. Such a channel
need not be broken (a gauge at a welded gusset reads the bending there): it is left out of the
search, and reported as one that does not fit.
"""

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.search.laplace import fit
from rga.diagnosis.search.stepwise import Found

#: spread of the response of a channel to a load pattern, where it is free [its own size]
FREE = 0.3


def own_response(found: Found) -> str | None:
    """The name of a channel that is likelier to have a response of its own than causes are to act.

    Args:
        found: the end of a search.

    Returns:
        None where the causes of the structure are likelier, or where there are none.
    """
    problem, causes = found.problem, found.fit.hypotheses
    criteria = problem.criteria
    kept = [k for k, one in enumerate(causes) if one.kind.at_sensors()]
    if len(kept) == len(causes):
        return None
    slices = found.fit.slices()
    start = np.concatenate([np.zeros(0), *(found.fit.z[slices[k]] for k in kept)])
    without = fit(problem, found.base, [causes[k] for k in kept], start)
    needed = found.fit.log_evidence - without.log_evidence

    residual = problem.residual(without.simulated)
    names, covariance, channel = problem.data.sensors, problem.covariance, problem.scatter.channel
    gained = _gained(*covariance.posterior(residual), covariance.spread, channel)
    best = int(np.argmax(gained))
    odds = float(gained[best] - np.log(2 * len(names) * causes[0].kinds))
    few = len(names) < criteria.channels.fewest_for_own_response
    return None if few or odds < max(criteria.naming.log_odds, needed) else names[best]


def _gained(
    mean: FloatArray, covariance: FloatArray, spread: FloatArray, channel: IntArray
) -> FloatArray:
    """Log likelihood that each channel gains where its responses are free, float[channels].

    The prior precision of a block of random effects changes by a diagonal D. With m and H their
    posterior mean and covariance, the log likelihood changes by
    -1/2 (m' D (I + H D)^-1 m + log det(I + H D)) - log(new spread / old spread), by Woodbury's
    identity and the lemma of matrix determinants.
    """
    found = np.zeros(channel.max(initial=-1) + 1)
    for number in range(len(found)):
        block = np.flatnonzero(channel == number)
        change = FREE**-2.0 - spread[block] ** -2.0
        inner = np.eye(len(block)) + covariance[np.ix_(block, block)] * change
        fitted = float((mean[block] * change) @ np.linalg.solve(inner, mean[block]))
        freedom = float(np.linalg.slogdet(inner)[1])
        found[number] = -0.5 * (fitted + freedom) - float(np.log(FREE / spread[block]).sum())
    return found
