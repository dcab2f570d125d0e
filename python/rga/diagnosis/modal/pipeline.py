"""The diagnosis by modes: a model and a modal record in, findings out."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy
from threadpoolctl import threadpool_limits

from rga.arrays import FloatArray
from rga.diagnosis.assemble.effects import cause_name, content
from rga.diagnosis.modal.candidates import ModalProspect, modal_hypotheses
from rga.diagnosis.modal.checks import left_out_modes, modes_off, squares
from rga.diagnosis.modal.doubts import thin, warnings_of, weather
from rga.diagnosis.modal.fit import ModalFit, fitted, predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.search import ModalFound, search
from rga.diagnosis.modal.separating import separating
from rga.diagnosis.modal.trials import ModalTrials, Prediction
from rga.findings import Findings
from rga.findings.criteria import Criteria, as_criteria
from rga.findings.modal_arrays import ModalArrays, ModeReading
from rga.findings.phrases import effect_words, place_words
from rga.findings.schema import (
    Cause,
    Explanation,
    Gap,
    GroupGap,
    HeldOut,
    SensorGap,
    Unexplained,
    Unidentifiable,
    Verdict,
)
from rga.model import Model, as_model
from rga.model.effect import Effect
from rga.model.parameter import NORMAL_90, Estimated
from rga.numerics.seeds import as_seed
from rga.provenance import versions
from rga.records.modal.read import load_modal_record
from rga.records.modal.record import ModalRecord

Progress = Callable[[str, float], None]
#: of intervals
CONFIDENCE = 0.9
#: decimals of log-odds
DECIMALS = 2


def diagnose_modes(
    model: Model | str | Path,
    record: ModalRecord | str | Path,
    *,
    criteria: Criteria | str | Path | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Findings:
    """Diagnose what a model gets wrong of natural frequencies and mode shapes.

    A mode is known by its shape; which computed mode it is, is decided anew for every explanation.

    Args:
        model: the structure with its masses, effects, points, modes and sensors, or its file.
        record: modes found in windows of time, or their file (`load_modal_record`).
        criteria: what decides the verdict, or their file; None: the default ones.
        seed: of the findings; nothing is drawn.
        progress: called with a stage and the share of it that is done.

    Returns:
        Findings with verdict, causes, rivals, gain, and what stays unexplained.

    Raises:
        InputError: a file cannot be used, no mode of the model is in the record, or the model
            cannot be simulated.
        UnstableStructureError: the structure can move; names node and direction.
    """
    tell = progress or (lambda stage, done: None)
    model, seed, chosen = as_model(model), as_seed(seed), as_criteria(criteria)
    if not isinstance(record, ModalRecord):
        record = load_modal_record(record, model)
    with threadpool_limits(1):
        return _diagnosed(model, record, chosen, seed, tell)


def _diagnosed(
    model: Model, record: ModalRecord, criteria: Criteria, seed: int, progress: Progress
) -> Findings:
    readings = ModalReadings.of(model, record)
    likelihood = ModalLikelihood(ModalTrials(model, readings))
    found = search(likelihood, modal_hypotheses(likelihood.trials), criteria, progress)
    nothing = likelihood.trials.predict({})
    after = found.fit.prediction or nothing
    left_out = left_out_modes(likelihood, found.fit)
    doubts = modes_off(likelihood, after)
    if found.fit.hypotheses and left_out.after.mean() >= left_out.before.mean():
        doubts.append("modes that were left out are predicted no better with the causes")
    doubts += thin(readings, bool(found.fit.hypotheses))
    doubts += weather(readings, found.fit.hypotheses, after)
    if readings.doubtful:
        doubts.append(
            f"in {readings.doubtful} of {len(readings.time)} windows another pairing of the modes "
            "found is nearly as probable"
        )
    effects = [estimated(found.fit, number) for number in range(len(found.fit.hypotheses))]
    extended = model.extended({cause_name(model, effect): effect for effect in effects})
    findings = Findings(
        verdict=_verdict(found, bool(doubts), criteria),
        gap=_gap(model, likelihood, (nothing, after), left_out.before, left_out.after),
        causes=_causes(likelihood, found, effects, criteria),
        unidentifiable=_unidentifiable(found.first, criteria),
        unexplained=Unexplained(
            share=_share_left(likelihood, nothing, after), looks_like="; ".join(doubts)
        ),
        explanations=_explanations(likelihood, found, criteria),
        groups=_groups(model, likelihood, nothing, after),
        warnings=warnings_of(model, readings),
        criteria=criteria,
        seed=seed,
        model_sha256=model.sha256,
        record_sha256=record.sha256,
        versions=versions(),
    )
    findings._modes = ModalArrays(
        model, extended, _mode_readings(likelihood, nothing, after), readings.time
    )
    progress("done", 1.0)
    return findings


def estimated(fit: ModalFit, number: int) -> Effect:
    """A cause as an effect with its estimates and their 90 % intervals."""
    hypothesis, where = fit.hypotheses[number], fit.of(number)
    values = {}
    spreads = fit.spreads()
    for (name, prior), z, spread in zip(
        hypothesis.priors.items(), fit.z[where], spreads[where], strict=True
    ):
        ends = sorted(prior.value(float(z + sign * NORMAL_90 * spread)) for sign in (-1, 1))
        values[name] = Estimated(value=prior.value(float(z)), ci90=(ends[0], ends[1]))
    found = hypothesis.effect(fit.z[where]).with_values(values)
    if hypothesis.onset is None:
        return found
    onset = fit.likelihood.readings.label(hypothesis.onset)
    return found.model_copy(update={"onset": onset})


def _verdict(found: ModalFound, structure: bool, criteria: Criteria) -> Verdict:
    if not found.fit.hypotheses:
        return "unknown" if structure else "nothing_wrong"
    if structure:
        return "partial"
    apart = criteria.rivals.log_odds
    rivals = any(behind < apart for ranked in found.rivals for _, behind in ranked)
    return "ambiguous" if rivals else "named"


def _causes(
    likelihood: ModalLikelihood,
    found: ModalFound,
    effects: list[Effect],
    criteria: Criteria,
) -> list[Cause]:
    causes = []
    for number, effect in enumerate(effects):
        ranked = found.rivals[number]
        rivals = [one for one, behind in ranked if behind < criteria.rivals.log_odds]
        d_prime, d_perp = _sizes(likelihood, found, number)
        nearest = ranked[0][0] if ranked else None
        words = ""
        if nearest is not None:
            against = effect_words(content(estimated(nearest, len(nearest.hypotheses) - 1)))
            words = f"against {against}: {separating(likelihood, found.fit, nearest)}"
            if ranked[0][1] >= criteria.rivals.log_odds:
                words += f"; this record tells them apart by {ranked[0][1]:.0f} log-odds"
        listed = [content(estimated(one, len(one.hypotheses) - 1)) for one in rivals]
        causes.append(
            Cause(
                effect=content(effect),
                onset=effect.onset,
                status="ambiguous" if rivals else "named",
                log_odds=found.log_odds[number],
                d_prime=d_prime,
                d_perp=d_perp,
                rivals=listed[: criteria.rivals.listed],
                rivals_omitted=max(0, len(listed) - criteria.rivals.listed),
                separated_by=words,
                why=_why(likelihood, found, number),
            )
        )
    return causes


def _change(likelihood: ModalLikelihood, fit: ModalFit, number: int) -> FloatArray:
    """What a cause changes of the whitened residual, beside the others."""
    others = [one for k, one in enumerate(fit.hypotheses) if k != number]
    z = np.delete(fit.z, fit.of(number))
    without = predicted(likelihood, others, z)
    if without is None:
        return np.zeros_like(fit.residual)
    return np.asarray(likelihood.residual(without) - fit.residual)


def _sizes(likelihood: ModalLikelihood, found: ModalFound, number: int) -> tuple[float, float]:
    """d' of a cause, and d' after projecting off its nearest rival."""
    own = _change(likelihood, found.fit, number)
    size = float(np.linalg.norm(own))
    if not found.rivals[number]:
        return size, size
    rival = found.rivals[number][0][0]
    other = _change(likelihood, rival, len(rival.hypotheses) - 1)
    length = float(other @ other)
    rest = own - other * (float(own @ other) / length) if length > 0 else own
    return size, float(np.linalg.norm(rest))


def _why(likelihood: ModalLikelihood, found: ModalFound, number: int) -> str:
    """The modes in which a cause shows most."""
    others = [one for k, one in enumerate(found.fit.hypotheses) if k != number]
    without = predicted(likelihood, others, np.delete(found.fit.z, found.fit.of(number)))
    after = found.fit.prediction
    if without is None or after is None:
        return ""
    moved = np.expm1((after.log_f - without.log_f)[-1])
    most = np.argsort(-np.abs(moved))[:5]
    names = likelihood.readings.modes
    shown = [
        f"{names[k]} ({moved[k]:+.1%})" for k in most if abs(moved[k]) > 0.1 * abs(moved).max()
    ]
    return f"it moves {', '.join(shown)}"


def _unidentifiable(first: list[ModalProspect], criteria: Criteria) -> list[Unidentifiable]:
    return [
        Unidentifiable(
            kind=one.hypothesis.name,
            place=place_words(one.hypothesis.place.values()),
            d_prime_at_largest=round(one.largest, DECIMALS),
        )
        for one in first
        if one.largest < criteria.explanations.smallest_d_prime
    ]


def _explanations(
    likelihood: ModalLikelihood, found: ModalFound, criteria: Criteria
) -> list[Explanation]:
    """No effect at all, what is named, and what could stand in its place."""
    nothing = fitted(likelihood, [], [])
    several = [(nothing, "what every other explanation is measured against")]
    if found.fit.hypotheses:
        several.append((found.fit, "what is named"))
    for ranked in found.rivals:
        for one, behind in ranked:
            close = behind < criteria.rivals.log_odds
            words = "cannot be separated from what is named" if close else "rejected"
            several.append((one, f"{words} ({-behind:+.1f} log-odds)"))
    explanations = []
    for one, remark in several:
        if one.prediction is None:
            continue
        effects = [content(estimated(one, number)) for number in range(len(one.hypotheses))]
        explanations.append(
            Explanation(
                words="; ".join(map(effect_words, effects)) or "no effect at all",
                effects=effects,
                log_odds=round(one.log_evidence, DECIMALS) + 0.0,
                gap=float(squares(likelihood, one.prediction).mean()),
                remark=remark,
            )
        )
    return sorted(explanations, key=lambda one: -one.log_odds)


def _gap(
    model: Model,
    likelihood: ModalLikelihood,
    ends: tuple[Prediction, Prediction],
    before: FloatArray,
    after: FloatArray,
) -> Gap:
    own = [squares(likelihood, one) for one in ends]
    modes = likelihood.readings.modes
    by_sensor = {
        name: SensorGap(before=float(own[0][at]), after=float(own[1][at]))
        for name, sensor in model.modal_sensors.items()
        if sensor.point is None and sensor.mode in modes
        for at in [modes.index(sensor.mode)]
    }
    gains = before - after
    wide = 0.0
    if len(gains) > 1:
        quantile = float(scipy.stats.t.ppf(0.5 + CONFIDENCE / 2, len(gains) - 1))
        wide = quantile * float(gains.std(ddof=1)) / np.sqrt(len(gains))
    middle = float(gains.mean())
    return Gap(
        before=float(own[0].mean()),
        after=float(own[1].mean()),
        unit="mean squared deviation of frequencies over what noise and a right model leave",
        held_out=HeldOut(
            before=float(before.mean()),
            after=float(after.mean()),
            gain=middle,
            gain_ci90=(middle - wide, middle + wide),
        ),
        by_sensor=by_sensor,
    )


def _groups(
    model: Model, likelihood: ModalLikelihood, before: Prediction, after: Prediction
) -> list[GroupGap]:
    """Every mode, as per cent that is measured beyond what is simulated."""
    ends = [np.expm1(likelihood.mean_off(one)) for one in (before, after)]
    return [
        GroupGap(
            group=f"mode {mode}",
            sensors=[name for name, one in model.modal_sensors.items() if one.mode == mode],
            before_percent=float(100 * ends[0][at]),
            after_percent=float(100 * ends[1][at]),
        )
        for at, mode in enumerate(likelihood.readings.modes)
    ]


def _share_left(likelihood: ModalLikelihood, before: Prediction, after: Prediction) -> float:
    """Share of the squared deviations that is left."""
    first, last = (float(squares(likelihood, one).sum()) for one in (before, after))
    return min(1.0, last / first) if first > 0 else 0.0


def _mode_readings(
    likelihood: ModalLikelihood, before: Prediction, after: Prediction
) -> list[ModeReading]:
    readings, trials = likelihood.readings, likelihood.trials
    points = list(trials.model.points)
    return [
        ModeReading(
            name=name,
            frequency=look.near,
            scatter=float(readings.scatter[at]),
            found=float(readings.found[at]),
            points=[points[number] for number in look.at],
            shape=look.shape,
            log_f=readings.log_f[:, at],
            before=before.log_f[:, at],
            after=after.log_f[:, at],
            mac=(float(before.mac[at]), float(after.mac[at])),
            number=(int(before.number[at]) + 1, int(after.number[at]) + 1),
            shapes=(before.shapes[at], after.shapes[at]),
        )
        for at, (name, look) in enumerate(zip(readings.modes, readings.looks, strict=True))
    ]
