"""Causes examined: where structure is left, the noise is not all that it is taken for.

Evidence is exact only for the noise that it assumes. Where sensors share a pattern that no cause
explains, a cause needs three things beyond its evidence: that it helps channels which were
not fitted, that its lead over a rival does not hang on a single channel, and where it does, that
the rival does not predict unseen channels much better.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.checks.explanations import groups_left_out, hiding, on_unseen
from rga.diagnosis.search.laplace import Alternative, Fit, fit, refit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found, without_cause
from rga.simulation import Simulator

#: channels that favour a cause most, which are left out one after the other
FAVOURABLE = 8


def without_unhelpful(problem: Problem, base: Simulator, current: Fit) -> Fit:
    """The causes, less those that make channels worse which were not fitted.

    Causes on a sensor of its own say nothing of other channels, and are kept.
    """
    if not groups_left_out(base.model, problem.data.sensors):
        return current
    while len(current.hypotheses) > 1:
        fewer = [
            without_cause(problem, base, current, number)
            for number, one in enumerate(current.hypotheses)
            if not one.kind.at_sensors()
        ]
        whole, *odds = (one.log_odds for one in on_unseen(problem, base, [current, *fewer]))
        if not odds or max(odds) <= whole:
            break
        current = fewer[int(np.argmax(odds))]
    return current


def with_hanging_leads(found: Found, progress: Callable[[float], None]) -> Found:
    """The alternatives with their distance where one channel that favours the cause is left out."""
    problem = found.problem
    close = {
        (number, place): one
        for number, ranked in enumerate(found.alternatives)
        for place, one in enumerate(ranked)
        if one.behind < problem.criteria.rivals.may_hang
    }
    if not close:
        return found
    nearest = {key: one.behind for key, one in close.items()}
    favourable = _favourable(found, close.values())
    for step, sensor in enumerate(favourable):
        part = hiding(problem, [sensor])
        refitted = refit(part, found.base, [found.fit, *(one.fit for one in close.values())])
        causes = refitted[0]
        for key, other in zip(close, refitted[1:], strict=True):
            nearest[key] = min(nearest[key], causes.log_evidence - other.log_evidence)
        progress((step + 1) / len(favourable))
    return replace(
        found,
        alternatives=tuple(
            tuple(
                sorted(
                    (_nearer(one, nearest.get((number, k))) for k, one in enumerate(ranked)),
                    key=lambda one: one.behind,
                )
            )
            for number, ranked in enumerate(found.alternatives)
        ),
    )


def _nearer(one: Alternative, behind: float | None) -> Alternative:
    return one if behind is None else replace(one, behind=behind)


def with_better_prediction(found: Found) -> Found:
    """The causes, with a rival in the place of one where channels unseen speak for it.

    Where the lead of a cause hangs on a channel, evidence cannot separate the two. What predicts
    channels to which it was not fitted much better then goes before what fits better.
    """
    problem, base, criteria = found.problem, found.base, found.problem.criteria.rivals
    rivals = [
        (number, one)
        for number, ranked in enumerate(found.alternatives)
        if not found.fit.hypotheses[number].kind.at_sensors()
        for one in ranked
        if one.behind < criteria.log_odds and not one.hypothesis.kind.at_sensors()
    ]
    if not rivals or not groups_left_out(base.model, problem.data.sensors):
        return found
    whole, *others = on_unseen(problem, base, [found.fit, *(one.fit for _, one in rivals)])
    better = [
        (own.gap, number, one)
        for (number, one), own in zip(rivals, others, strict=True)
        if own.gap < criteria.predicts_better * whole.gap and own.log_odds > whole.log_odds
    ]
    if not better:
        return found
    least = min(gap for gap, _, _ in better)
    alike = [(number, one) for gap, number, one in better if gap <= criteria.predicts_alike * least]
    return _exchanged(found, *max(alike, key=lambda pair: pair[1].fit.log_evidence))


def _exchanged(found: Found, number: int, rival: Alternative) -> Found:
    """A rival in the place of a cause, and the cause among its rivals."""
    behind = rival.fit.log_evidence - found.fit.log_evidence
    causes, slices = found.fit.hypotheses, found.fit.slices()
    order = [*(k for k in range(len(causes)) if k != number), number]
    z = np.concatenate([found.fit.z[slices[k]] for k in order])
    former = fit(found.problem, found.base, [causes[k] for k in order], z)
    others = [
        replace(one, behind=one.behind + behind)
        for one in found.alternatives[number]
        if one is not rival
    ]
    ranked = (Alternative(causes[number], former, behind), *others)
    return replace(
        found,
        fit=rival.fit,
        alternatives=(*(found.alternatives[k] for k in order[:-1]), ranked),
        log_odds=(
            *(found.log_odds[k] for k in order[:-1]),
            found.log_odds[number] + behind,
        ),
    )


def _favourable(found: Found, close: Iterable[Alternative]) -> list[str]:
    """The channels on which the causes fit better than an alternative does."""
    problem = found.problem

    def misfit(one: Fit) -> FloatArray:
        residual = problem.residual(one.simulated)
        return np.asarray((residual.T * problem.covariance.inverse_times(residual)).sum(1))

    own = misfit(found.fit)
    chosen = set()
    for one in close:
        lead = misfit(one.fit) - own
        chosen |= {k for k in np.argsort(-lead)[:FAVOURABLE] if lead[k] > 0}
    return [problem.data.sensors[k] for k in sorted(chosen)]
