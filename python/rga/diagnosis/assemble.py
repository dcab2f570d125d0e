"""From numbers to findings: causes, gaps, groups and contexts as they are told."""

import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.advice import Advice
from rga.diagnosis.checks.explanations import Tried
from rga.diagnosis.data.held_out import Gain
from rga.diagnosis.optional import spared
from rga.diagnosis.preparation.single_channel import BrokenChannel
from rga.diagnosis.search.change_point import beginnings
from rga.diagnosis.search.laplace import Fit, extended
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Prospect
from rga.diagnosis.search.stepwise import NAMED, RIVAL, Alternative, Found
from rga.experiments.explanation import explanation
from rga.findings.arrays import DiagnosisArrays
from rga.findings.phrases import effect_words, place_words
from rga.findings.schema import (
    Cause,
    Explanation,
    Gap,
    GroupGap,
    HeldOut,
    SensorGap,
    Unidentifiable,
)
from rga.model.effect import Effect
from rga.model.effects.sensors import SensorFault, SensorGain
from rga.model.parameter import Estimated
from rga.model.schema import Model
from rga.records import Record

NORMAL_90 = 1.6448536269514722
SMALLEST_D_PRIME = 3.0
FAULT_NATS = float(np.log(1000.0))
#: gain below which a channel is dead [-]
DEAD = 0.05
#: share of the gap on unseen channels that an explanation must take off; unlikely z
UNHELPFUL, UNLIKELY = 0.98, 3.0
#: share of the named causes' gap on unseen channels below which another predicts them better
BETTER = 0.9
#: rivals that are listed: kinds that pass for each other are fewer, and of places that do, more
#: would say no more than that the place is open
MOST_RIVALS = 8


def effects_of(found: Found, record: Record) -> list[Effect]:
    """The causes as effects with estimated parameters, onsets as in the record."""
    return [_dead(effect) for effect in _effects(found.fit, record)]


def cause_name(model: Model, effect: Effect) -> str:
    """A name for a cause in the extended model, new to the model."""
    place = " ".join(str(one) for one in effect.place.values() if isinstance(one, str))
    name = f"{effect.kind.replace('_', ' ')} {place}".strip()
    return name if name not in model.effects else f"{name} (found)"


def content(effect: Effect) -> dict[str, Any]:
    """An effect as it stands in a model file."""
    return {"kind": effect.kind, **effect.model_dump(mode="json", exclude_defaults=True)}


def causes(
    found: Found, effects: Sequence[Effect], record: Record, warnings: list[str]
) -> list[Cause]:
    """The causes with their rivals and with what would tell them apart.

    Args:
        found: the end of a search.
        effects: of its causes.
        record: gives times as they are written.
        warnings: to which it is added where that cannot be worked out.
    """
    told: list[Cause] = []
    for number, effect in enumerate(effects):
        rivals = _rivals(found, number)
        nearest = (found.alternatives[number] or (None,))[0]
        d_prime, d_perp = _sizes(found, number, nearest)
        told.append(
            Cause(
                effect=content(effect),
                onset=effect.onset,
                onset_ci90=_onset_interval(found, number, record),
                status="ambiguous" if rivals else "named",
                log_odds=found.log_odds[number],
                d_prime=d_prime,
                d_perp=d_perp,
                rivals=[last_effect(one.fit, record) for one in rivals[:MOST_RIVALS]],
                rivals_omitted=max(0, len(rivals) - MOST_RIVALS),
                why=_why(found, number),
            )
        )
    return spared(
        "what would tell the causes from their rivals",
        lambda: _with_advice(told, found, record),
        told,
        warnings,
    )


def _with_advice(told: Sequence[Cause], found: Found, record: Record) -> list[Cause]:
    """The causes with what would tell each from its nearest rival."""
    model, problem, advice = found.base.model, found.problem, None
    together = explanation("the causes", model, _effects(found.fit, record))
    advised = []
    for number, cause in enumerate(told):
        words = ""
        if found.alternatives[number]:
            nearest = found.alternatives[number][0].fit
            advice = advice or Advice(model, problem.data, together, problem.levels)
            other = explanation("its rival", model, _effects(nearest, record))
            against = effect_words(last_effect(nearest, record))
            if measured := advice.against(other):
                words = f"against {against}: {measured}"
        advised.append(cause.model_copy(update={"separated_by": words}))
    return advised


def _effects(one: Fit, record: Record) -> list[Effect]:
    return [_effect(one, number, record) for number in range(len(one.hypotheses))]


def fault_effect(fault: BrokenChannel, record: Record) -> SensorFault:
    """A rejected channel as it stands in the extended model."""
    onset = None if fault.row is None else record.time_label(float(record.time[fault.row]))
    return SensorFault(sensor=fault.sensor, mode=fault.mode, onset=onset)


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


def gap(account: DiagnosisArrays, gained: Gain) -> Gap:
    """The gap on the fitted rows and by sensor, and the gain by the held-out rows."""
    measured = account.record.readings
    before = ((measured - account.before) / account.noise) ** 2
    after = ((measured - account.after) / account.noise) ** 2
    fitted = ~account.held_out
    by_sensor = {
        name: SensorGap(
            before=float(np.nanmean(before[fitted, k])), after=float(np.nanmean(after[fitted, k]))
        )
        for k, name in enumerate(account.record.sensors)
        if not account.rejected[k] and np.isfinite(before[fitted, k]).any()
    }
    return Gap(
        before=float(np.nanmean(before[fitted])),
        after=float(np.nanmean(after[fitted])),
        held_out=HeldOut(
            before=gained.before,
            after=gained.after,
            gain=gained.before - gained.after,
            gain_ci90=gained.interval,
        ),
        by_sensor=by_sensor,
    )


def groups(account: DiagnosisArrays, grouped: Mapping[str, Sequence[str]]) -> list[GroupGap]:
    """Measured over simulated of each group of sensors, in percent off."""
    order = {name: k for k, name in enumerate(account.record.sensors)}
    return [
        GroupGap(
            group=word,
            sensors=list(names),
            before_percent=_percent_off(account, account.before, [order[n] for n in names]),
            after_percent=_percent_off(account, account.after, [order[n] for n in names]),
        )
        for word, names in grouped.items()
    ]


def unidentifiable(prospects: Sequence[Prospect]) -> list[Unidentifiable]:
    """Every kind and place whose largest physical value stays too small to be seen."""
    return [
        Unidentifiable(
            kind=p.hypothesis.name,
            place=place_words(p.hypothesis.place.values()),
            d_prime_at_largest=p.largest,
        )
        for p in prospects
        if p.largest < SMALLEST_D_PRIME
    ]


def explanations(tried: Sequence[Tried], found: Found, record: Record) -> list[Explanation]:
    """The explanations that were tried, the likeliest first."""
    if not tried:
        return []
    nothing = tried[0]
    named = next((one for one in tried if one.fit and _same(one.fit, found.fit)), nothing)
    told = []
    for one in tried:
        if one.fit is None:
            words, effects, odds = "a free gain on every channel", [], 0.0
            remark = "fits, and says nothing of channels that were not fitted"
        else:
            effects = [content(effect) for effect in _effects(one.fit, record)]
            words = " + ".join(effect_words(effect) for effect in effects) or "the model as it is"
            odds = one.fit.log_evidence
            remark = _remark(one, nothing, named, found)
        told.append(
            Explanation(
                words=words,
                effects=effects,
                log_odds=max(odds, -1e9),
                gap=one.gap,
                gap_unseen_channels=one.gap_unseen if np.isfinite(one.gap_unseen) else None,
                remark=remark,
            )
        )
    return sorted(told, key=lambda one: -one.log_odds)


def contexts(problem: Problem, model: Model) -> dict[str, dict[str, Any]]:
    """Latent contexts as they were inferred, and the noise of the measured ones."""
    told: dict[str, dict[str, Any]] = {}
    belief = problem.data.belief
    clock = problem.data.time - problem.data.time[0]
    for name in belief.lines:
        slope, level = np.polyfit(clock, belief.table[name], 1)
        unit = model.context[name].unit
        told[name] = {
            f"rate [{unit}/s]": float(slope),
            f"at the first analysed row [{unit}]": float(level),
        }
    for number, name in enumerate(belief.spread):
        unit = model.context[name].unit
        if name in belief.latent:
            column = belief.table[name]
            told[name] = {
                f"inferred mean [{unit}]": float(column.mean()),
                f"inferred smallest [{unit}]": float(column.min()),
                f"inferred largest [{unit}]": float(column.max()),
            }
        else:
            told[name] = {
                f"noise of its measurement [{unit}]": float(problem.noise.context_sigma[number])
            }
    return told


def versions() -> dict[str, str]:
    """Versions of what took part."""
    packages = ("rga", "numpy", "scipy", "pydantic", "polars")
    return {**{name: version(name) for name in packages}, "python": platform.python_version()}


def _percent_off(account: DiagnosisArrays, simulated: FloatArray, columns: Sequence[int]) -> float:
    measured, own = account.record.readings[:, columns], simulated[:, columns]
    seen = np.isfinite(measured) & np.isfinite(own)
    weight = np.broadcast_to(account.sigma[list(columns)] ** -2, measured.shape)[seen]
    power = float((weight * own[seen] ** 2).sum())
    if power == 0:
        return 0.0
    return 100 * (float((weight * own[seen] * measured[seen]).sum()) / power - 1)


def _effect(one: Fit, number: int, record: Record) -> Effect:
    hypothesis, where, spreads = one.hypotheses[number], one.slices()[number], one.spreads()
    values = {}
    for (name, prior), z, spread in zip(
        hypothesis.priors.items(), one.z[where], spreads[where], strict=True
    ):
        ends = sorted(prior.value(float(z + sign * NORMAL_90 * spread)) for sign in (-1, 1))
        values[name] = Estimated(value=prior.value(float(z)), ci90=(ends[0], ends[1]))
    effect = hypothesis.beginning(None).effect(one.z[where]).with_values(values)
    if hypothesis.onset is None:
        return effect
    late: dict[str, Any] = {"onset": record.time_label(hypothesis.onset - record.origin)}
    if hypothesis.profile == "ramp":
        late["profile"] = "ramp"
    if hypothesis.end is not None:
        late["end"] = record.time_label(hypothesis.end - record.origin)
    return effect.model_copy(update=late)


def _same(one: Fit, other: Fit) -> bool:
    return len(one.hypotheses) == len(other.hypotheses) and all(
        a.same_place(b) for a, b in zip(one.hypotheses, other.hypotheses, strict=True)
    )


def _dead(effect: Effect) -> Effect:
    """A gain of nearly nothing told as what it is: a channel that is dead."""
    if isinstance(effect, SensorGain) and isinstance(effect.factor, Estimated):
        low, high = effect.factor.ci90
        if low < DEAD < high or abs(effect.factor.value) < DEAD:
            return SensorFault(sensor=effect.sensor, mode="dead", onset=effect.onset)
    return effect


def last_effect(one: Fit, record: Record) -> dict[str, Any]:
    """The last hypothesis of a fit as an effect of a model file, with its estimates."""
    return content(_effect(one, len(one.hypotheses) - 1, record))


def _rivals(found: Found, number: int) -> list[Alternative]:
    """What the data cannot tell from a cause: the nearest of each other kind, then the rest."""
    rivals = sorted(
        (one for one in found.alternatives[number] if one.behind < RIVAL),
        key=lambda one: one.behind,
    )
    first: dict[str, Alternative] = {}
    for one in rivals:
        first.setdefault(one.hypothesis.name, one)
    first.pop(found.fit.hypotheses[number].name, None)
    others = list(first.values())
    return [*others, *(one for one in rivals if all(one is not other for other in others))]


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
    told = found.fit.hypotheses[number].onset
    if told is None:
        return None
    possible = beginnings(found.problem, found.base, found.fit, number)
    moments, below = possible.moments, np.cumsum(possible.chances)
    # What shows first on a row began after the row before it, maybe a held-out block back.
    first = moments[max(0, int(np.searchsorted(below, 0.05)) - 1)]
    last = moments[min(int(np.searchsorted(below, 0.95)), len(moments) - 1)]
    # The likeliest beginning may not be at the likeliest moment of all beginnings together.
    first, last = min(first, told), max(last, told)
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


def _remark(one: Tried, nothing: Tried, named: Tried, found: Found) -> str:
    """Why an explanation was kept or rejected."""
    assert one.fit is not None  # the caller tells free gains apart
    if not one.fit.hypotheses:
        return "what every other explanation is measured against"
    causes = found.fit
    ahead = one.fit.log_evidence - causes.log_evidence
    rivals = [r for number in range(len(found.log_odds)) for r in _rivals(found, number)]
    held = [any(h.same_place(cause) for h in one.fit.hypotheses) for cause in causes.hypotheses]
    remarks = []
    if causes.hypotheses and all(held):
        added = len(one.fit.hypotheses) > len(causes.hypotheses)
        earned = f"what is added earns {ahead:+.1f} log-odds, too little to be named"
        remarks.append(earned if added else "what is named")
    elif causes.hypotheses:
        close = f"cannot be told from what is named ({ahead:+.1f} log-odds)"
        hangs = f"its distance ({ahead:+.0f} log-odds) hangs on one channel: cannot be told apart"
        rejected = (
            hangs
            if any(_same(one.fit, r.fit) for r in rivals)
            else f"rejected ({ahead:+.0f} log-odds)"
        )
        remarks.append(close if ahead > -RIVAL else rejected)
    else:
        remarks.append(
            "rejected: not likelier than no effect at all"
            if ahead < NAMED
            else f"likelier than no effect ({ahead:+.0f} log-odds), and rejected all the same: it "
            "may be what no kind explains that speaks for it"
        )
    if not all(held) and one.gap_unseen < BETTER * named.gap_unseen:
        remarks.append("yet it predicts channels that were left out better than what is named")
    if np.isfinite(one.gap_unseen) and one.gap_unseen > UNHELPFUL * nothing.gap_unseen:
        remarks.append("does not help channels that it was not fitted to")
    remarks += [
        f"{hypothesis.name.replace('_', ' ')} would need an unlikely value"
        for hypothesis, where in zip(one.fit.hypotheses, one.fit.slices(), strict=True)
        if np.abs(one.fit.z[where]).max(initial=0.0) > UNLIKELY
    ]
    return "; ".join(remarks)
