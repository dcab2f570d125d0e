"""What was tried beside the causes, and what could not be seen at all."""

from collections.abc import Sequence

import numpy as np

from rga.diagnosis.assemble.causes import rivals_of
from rga.diagnosis.assemble.effects import content, estimated_effects
from rga.diagnosis.checks.explanations import Tried
from rga.diagnosis.search.laplace import Fit
from rga.diagnosis.search.screening import Prospect
from rga.diagnosis.search.stepwise import Found
from rga.findings.phrases import explanation_words, place_words
from rga.findings.schema import (
    Explanation,
    Unidentifiable,
)
from rga.records import Record

#: decimals of log-odds and d': beyond them they differ from one processor to another
DECIMALS = 6


def explanations(tried: Sequence[Tried], found: Found, record: Record) -> list[Explanation]:
    """The explanations that were tried, the likeliest first."""
    if not tried:
        return []
    nothing = tried[0]
    named = next((one for one in tried if one.fit and _same(one.fit, found.fit)), nothing)
    explanations = []
    for one in tried:
        if one.fit is None:
            words, effects, odds = "a free gain on every channel", [], 0.0
            remark = "fits, and says nothing of channels that were not fitted"
        else:
            effects = [content(effect) for effect in estimated_effects(one.fit, record)]
            words = explanation_words(effects)
            odds = one.fit.log_evidence
            remark = _remark(one, named, found)
        explanations.append(
            Explanation(
                words=words,
                effects=effects,
                log_odds=max(round(odds, DECIMALS), -1e9),
                gap=one.gap,
                gap_unseen_channels=one.unseen.gap if np.isfinite(one.unseen.gap) else None,
                remark=remark,
            )
        )
    # What differs by rounding alone keeps the order in which it was tried.
    return sorted(explanations, key=lambda one: -round(one.log_odds, DECIMALS))


def unidentifiable(prospects: Sequence[Prospect], smallest: float) -> list[Unidentifiable]:
    """Every kind and place whose largest physical value stays too small to be seen: below a d'."""
    return [
        Unidentifiable(
            kind=p.hypothesis.name,
            place=place_words(p.hypothesis.place.values()),
            d_prime_at_largest=round(p.largest, DECIMALS),
        )
        for p in prospects
        if p.largest < smallest
    ]


def _remark(one: Tried, named: Tried, found: Found) -> str:
    """Why an explanation was kept or rejected."""
    assert one.fit is not None  # the caller takes free gains out
    if not one.fit.hypotheses:
        return "what every other explanation is measured against"
    causes, criteria = found.fit, found.problem.criteria
    ahead = one.fit.log_evidence - causes.log_evidence
    rivals = [r for number in range(len(found.log_odds)) for r in rivals_of(found, number)]
    held = [any(h.same_place(cause) for h in one.fit.hypotheses) for cause in causes.hypotheses]
    remarks = []
    if causes.hypotheses and all(held):
        added = len(one.fit.hypotheses) > len(causes.hypotheses)
        earned = f"what is added earns {ahead:+.1f} log-odds, " + (
            "too little to be named"
            if ahead < criteria.naming.log_odds
            else "and rows and channels left out do not confirm it"
        )
        remarks.append(earned if added else "what is named")
    elif causes.hypotheses:
        close = f"cannot be separated from what is named ({ahead:+.1f} log-odds)"
        hangs = f"its distance ({ahead:+.0f} log-odds) hangs on one channel: cannot be separated"
        rejected = (
            hangs
            if any(_same(one.fit, r.fit) for r in rivals)
            else f"rejected ({ahead:+.0f} log-odds)"
        )
        remarks.append(close if ahead > -criteria.rivals.log_odds else rejected)
    else:
        remarks.append(
            "rejected: not likelier than no effect at all"
            if ahead < criteria.naming.log_odds
            else f"likelier than no effect ({ahead:+.0f} log-odds), and rejected all the same: it "
            "may be what no kind explains that speaks for it"
        )
    better = criteria.explanations.predicts_better * named.unseen.gap
    if not all(held) and one.unseen.gap < better and one.unseen.log_odds > named.unseen.log_odds:
        remarks.append("yet it predicts channels that were left out better than what is named")
    if np.isfinite(one.unseen.gap) and round(one.unseen.log_odds, DECIMALS) <= 0:
        remarks.append("does not help channels that it was not fitted to")
    remarks += [
        f"{hypothesis.kind.title} would need an unlikely value"
        for hypothesis, where in zip(one.fit.hypotheses, one.fit.slices(), strict=True)
        if np.abs(one.fit.z[where]).max(initial=0.0) > criteria.explanations.unlikely
    ]
    return "; ".join(remarks)


def _same(one: Fit, other: Fit) -> bool:
    return len(one.hypotheses) == len(other.hypotheses) and all(
        a.same_place(b) for a, b in zip(one.hypotheses, other.hypotheses, strict=True)
    )
