"""Causes as findings report them: sizes, onsets, rivals, and what would separate them."""

from collections.abc import Sequence

import numpy as np

from rga.diagnosis.advice import Advice
from rga.diagnosis.assemble.effects import content, estimated_effects, last_effect
from rga.diagnosis.fallback import spared
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.search.change_point import beginnings
from rga.diagnosis.search.laplace import Alternative, extended
from rga.diagnosis.search.stepwise import Found
from rga.experiments.explanation import explanation
from rga.findings.phrases import effect_words
from rga.findings.schema import (
    Cause,
)
from rga.model.effect import Effect
from rga.model.effects.sensors.sensor_fault import SensorFault
from rga.records import Record

#: log-odds of an odd reading of a broken channel: a working one shows it once in a thousand
FAULT_NATS = float(np.log(1000.0))


def causes(
    found: Found, effects: Sequence[Effect], record: Record, warnings: list[str]
) -> list[Cause]:
    """The causes with their rivals and with what would separate them.

    Args:
        found: the end of a search.
        effects: of its causes.
        record: gives times as they are written.
        warnings: to which it is added where that cannot be worked out.
    """
    causes: list[Cause] = []
    most = found.problem.criteria.rivals.listed
    for number, effect in enumerate(effects):
        rivals = rivals_of(found, number)
        nearest = (found.alternatives[number] or (None,))[0]
        d_prime, d_perp = _sizes(found, number, nearest)
        causes.append(
            Cause(
                effect=content(effect),
                onset=effect.onset,
                onset_ci90=_onset_interval(found, number, record),
                status="ambiguous" if rivals else "named",
                log_odds=found.log_odds[number],
                d_prime=d_prime,
                d_perp=d_perp,
                rivals=[last_effect(one.fit, record) for one in rivals[:most]],
                rivals_omitted=max(0, len(rivals) - most),
                why=_why(found, number),
            )
        )
    return spared(
        "what would separate the causes from their rivals",
        lambda: _with_advice(causes, found, record),
        causes,
        warnings,
    )


def fault_cause(fault: BrokenChannel, effect: SensorFault) -> Cause:
    """A rejected channel as a cause: each of its odd readings has odds of one in a thousand."""
    odds = max(fault.readings, 1) * FAULT_NATS
    return Cause(
        effect=content(effect),
        onset=effect.onset,
        status="named",
        log_odds=odds,
        d_prime=float(np.sqrt(2 * odds)),
        d_perp=float(np.sqrt(2 * odds)),
        why=fault.why,
    )


def rivals_of(found: Found, number: int) -> list[Alternative]:
    """What the data cannot separate from a cause: the nearest of each other kind, then the rest."""
    apart = found.problem.criteria.rivals.log_odds
    rivals = sorted(
        (one for one in found.alternatives[number] if one.behind < apart),
        key=lambda one: one.behind,
    )
    first: dict[str, Alternative] = {}
    for one in rivals:
        first.setdefault(one.hypothesis.name, one)
    first.pop(found.fit.hypotheses[number].name, None)
    others = list(first.values())
    return [*others, *(one for one in rivals if all(one is not other for other in others))]


def _with_advice(causes: Sequence[Cause], found: Found, record: Record) -> list[Cause]:
    """The causes with what would separate each from its nearest rival."""
    model, problem, advice = found.base.model, found.problem, None
    together = explanation("the causes", model, estimated_effects(found.fit, record))
    advised = []
    for number, cause in enumerate(causes):
        words = ""
        if found.alternatives[number]:
            nearest = found.alternatives[number][0]
            advice = advice or Advice(model, problem, together)
            other = explanation("its rival", model, estimated_effects(nearest.fit, record))
            against = effect_words(last_effect(nearest.fit, record))
            if measured := advice.against(other):
                words = f"against {against}: {measured}"
            if words and nearest.behind >= problem.criteria.rivals.log_odds:
                words += f"; this record tells them apart by {nearest.behind:.0f} log-odds"
        advised.append(cause.model_copy(update={"separated_by": words}))
    return advised


def _sizes(found: Found, number: int, nearest: Alternative | None) -> tuple[float, float]:
    """d' of a cause, and d' after projecting off its nearest rival."""
    problem, covariance = found.problem, found.problem.covariance
    hypotheses = [one for k, one in enumerate(found.fit.hypotheses) if k != number]
    z = np.delete(found.fit.z, found.fit.slices()[number])
    without = problem.data.predict(extended(found.base, hypotheses, z))
    own = covariance.reduce((found.fit.simulated - without).T[None])
    size = float(covariance.squares(own)[0])
    if nearest is None:
        return float(np.sqrt(size)), float(np.sqrt(size))
    other = covariance.reduce((nearest.fit.simulated - without).T[None])
    across = float(covariance.product(own, other)[0, 0])
    rest = size - across**2 / max(float(covariance.squares(other)[0]), 1e-300)
    return float(np.sqrt(size)), float(np.sqrt(max(rest, 0.0)))


def _onset_interval(
    found: Found, number: int, record: Record
) -> tuple[float | str, float | str] | None:
    onset = found.fit.hypotheses[number].onset
    if onset is None:
        return None
    possible = beginnings(found.problem, found.base, found.fit, number)
    moments, below = possible.moments, np.cumsum(possible.chances)
    # What shows first on a row began after the row before it, maybe a held-out block back.
    first = moments[max(0, int(np.searchsorted(below, 0.05)) - 1)]
    last = moments[min(int(np.searchsorted(below, 0.95)), len(moments) - 1)]
    # The likeliest beginning may not be at the likeliest moment of all beginnings together.
    first, last = min(first, onset), max(last, onset)
    early, late = (record.time_label(float(moment) - record.origin) for moment in (first, last))
    return early, late


def _why(found: Found, number: int) -> str:
    """The sensors in whose readings a cause shows most."""
    where = found.fit.slices()[number]
    problem = found.problem
    hypotheses = [one for k, one in enumerate(found.fit.hypotheses) if k != number]
    z = np.delete(found.fit.z, where)
    without = problem.data.predict(extended(found.base, hypotheses, z))
    change = np.where(problem.data.observed, found.fit.simulated - without, 0.0)
    shown = np.sqrt((change**2).mean(0)) / problem.noise.sigma
    strongest = [k for k in np.argsort(-shown)[:5] if shown[k] > 0.3 * shown.max()]
    names = ", ".join(
        f"{problem.data.sensors[k]} ({shown[k]:.1f} times its noise)" for k in strongest
    )
    return f"it shows most in {names}"
