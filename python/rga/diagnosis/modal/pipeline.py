"""The diagnosis by modes: a model and a modal record in, findings out."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from rga.diagnosis.assemble.effects import as_dead, cause_name, content
from rga.diagnosis.modal.account import mode_gap, mode_groups, mode_readings, windows_of
from rga.diagnosis.modal.candidates import ModalProspect, modal_hypotheses
from rga.diagnosis.modal.changes import change, moved_modes, moving_nothing, passing
from rga.diagnosis.modal.checks import left_out_modes, modes_off, pairs_in_doubt, squares
from rga.diagnosis.modal.doubts import (
    FEW_MODES,
    doubts_of_windows,
    drifting,
    following_contexts,
    following_doubts,
    lagging,
    other_freezing,
    thin,
    unlike_modes,
    warnings_of,
    weather,
)
from rga.diagnosis.modal.fit import ModalFit, fitted, shown_by
from rga.diagnosis.modal.following import with_what_follows
from rga.diagnosis.modal.likelihood import MODEL_ERROR, ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.remarks import apart_words, rival_words
from rga.diagnosis.modal.search import ModalFound, search
from rga.diagnosis.modal.separating import separating
from rga.diagnosis.modal.trials import ModalTrials
from rga.diagnosis.search.laplace import effects_at
from rga.findings import Findings
from rga.findings.criteria import Criteria, as_criteria
from rga.findings.modal_arrays import ModalArrays
from rga.findings.phrases import effect_words, explanation_words, place_words
from rga.findings.schema import (
    Cause,
    Explanation,
    Unexplained,
    Unidentifiable,
    Verdict,
)
from rga.model import Model, as_model
from rga.model.effect import Effect
from rga.model.parameter import Estimated
from rga.numerics.seeds import as_seed
from rga.provenance import versions
from rga.records.modal.read import load_modal_record
from rga.records.modal.record import ModalRecord
from rga.simulation import ModalSimulator

Progress = Callable[[str, float], None]
#: decimals of log-odds
DECIMALS = 2
#: of what may stand for a cause, by how many the modes are read anew
READ_ANEW = 5
#: share of the windows in which it may be in doubt which mode is which
MOST = 0.5


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

    >>> import rga
    >>> from rga.model.schema import ExpectedMode
    >>> mast = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    >>> mast = mast.add_node("foot").add_node("head", z="6 m").support("foot", "fixed")
    >>> mast = mast.add_member("foot", "head", "tube", kind="frame").mass("head", "500 kg").build()
    >>> modes = {"sway": ExpectedMode(near=1.588), "nod": ExpectedMode(near=2.678)}
    >>> mast = mast.model_copy(update={"modes": modes})
    >>> frequencies = np.tile([1.588, 2.678], (40, 1))  # [Hz], in each window
    >>> frequencies *= 1 + 0.002 * np.random.default_rng(0).standard_normal((40, 2))
    >>> found = [{"Fn": 0.9 * window} for window in frequencies]
    >>> record = rga.modal_record(found, mast, [], time=[600.0 * k for k in range(40)])
    >>> diagnose_modes(mast, record).verdict  # fewer than three modes decide nothing
    'unknown'
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
    found = _searched(model, readings, criteria, progress)
    if found.fit.hypotheses and readings.names_in_doubt:
        # A structure that has changed may have modes that are hardly those expected.
        again = min(_read_anew(model, record, found, criteria), key=lambda one: one.cost)
        if again.cost < readings.cost:
            readings = again
            found = _searched(model, readings, criteria, progress)
    if len(readings.modes) < FEW_MODES or readings.doubtful > MOST * len(readings.time):
        # Few modes, and modes of which it is in doubt which they are, are explained by anything.
        found = _without_causes(found)
    # What is told is held against what a model usually misses, whatever this one does.
    likelihood = found.fit.likelihood.with_level(MODEL_ERROR)
    left_out = left_out_modes(likelihood, found.fit)
    of_structure = any(not one.at_points for one in found.fit.hypotheses)
    against = []
    if of_structure and left_out.surely_worse:
        names = " and ".join(
            place_words([one.kind.title, *one.place.values()]) for one in found.fit.hypotheses
        )
        against.append(
            f"{names} would explain what was fitted, and modes that were left out are surely "
            "predicted worse with it"
        )
        found, of_structure = _without_causes(found), False
        likelihood = found.fit.likelihood
        left_out = left_out_modes(likelihood, found.fit)
    nothing = likelihood.trials.predict({})
    after = found.fit.prediction or nothing
    against += modes_off(likelihood, after)
    if of_structure and left_out.after.mean() >= left_out.before.mean():
        against.append("modes that were left out are predicted no better with the causes")
    against += moving_nothing(likelihood, found.fit) + drifting(likelihood, after)
    against += unlike_modes(readings)
    following = following_doubts(likelihood, bool(found.fit.hypotheses), after)
    doubts = [
        *against,
        *pairs_in_doubt(likelihood, after),
        *thin(readings, bool(found.fit.hypotheses)),
        *weather(readings, found.fit.hypotheses, after),
        *lagging(likelihood, found.fit.hypotheses, after),
        *following,
        *passing(likelihood, found.fit),
        *other_freezing(likelihood),
        *doubts_of_windows(likelihood, effects_at(found.fit.hypotheses, found.fit.z)),
    ]
    effects = [
        as_dead(estimated(found.fit, number), criteria.channels.dead_gain)
        for number in range(len(found.fit.hypotheses))
    ]
    with_causes = {cause_name(model, effect): effect for effect in effects}
    extended = ModalSimulator(model).with_shapes().extended(with_causes)
    findings = Findings(
        verdict=_verdict(found, bool(doubts), criteria),
        gap=mode_gap(model, likelihood, (nothing, after), left_out.before, left_out.after),
        causes=_causes(likelihood, found, effects, criteria),
        unidentifiable=_unidentifiable(found.first, criteria),
        unexplained=Unexplained(
            share=_share_left(likelihood, nothing, after),
            looks_like="; ".join(doubts),
            speaks_against=bool(against),
        ),
        explanations=_explanations(likelihood, found, criteria),
        groups=mode_groups(model, likelihood, nothing, after),
        warnings=warnings_of(model, readings)
        + [one for one in following_contexts(likelihood, after) if one not in following],
        criteria=criteria,
        seed=seed,
        model_sha256=model.sha256,
        record_sha256=record.sha256,
        windows=windows_of(likelihood),
        versions=versions(),
    )
    findings._modes = ModalArrays(
        model, extended, mode_readings(likelihood, nothing, after), readings.time, readings.weather
    )
    progress("done", 1.0)
    return findings


def _read_anew(
    model: Model, record: ModalRecord, found: ModalFound, criteria: Criteria
) -> list[ModalReadings]:
    """The modes out of a record where what was found, or what may stand for it, acts."""
    near = [
        one
        for ranked in found.rivals
        for one, behind in ranked[:READ_ANEW]
        if behind < criteria.rivals.log_odds
    ]
    several = []
    for fit in (found.fit, *near):
        causes = effects_at(fit.hypotheses, fit.z)
        looks = fit.likelihood.trials.looks(causes)
        several.append(ModalReadings.of(model, record, looks, list(causes.values())))
    return several


def _without_causes(found: ModalFound) -> ModalFound:
    """What was found, of which nothing may be named."""
    nothing = fitted(ModalLikelihood(found.fit.likelihood.trials), [], [])
    return replace(found, fit=nothing, log_odds=(), rivals=())


def _searched(
    model: Model, readings: ModalReadings, criteria: Criteria, progress: Progress
) -> ModalFound:
    likelihood = ModalLikelihood(ModalTrials(model, readings))
    candidates = modal_hypotheses(likelihood.trials)
    found = search(likelihood, candidates, criteria, progress)
    while (likelihood := shown_by(found.fit)).level > found.fit.likelihood.level:
        found = search(likelihood, candidates, criteria, progress)
    return with_what_follows(found, criteria, progress)


def estimated(fit: ModalFit, number: int) -> Effect:
    """A cause as an effect with its estimates and their 90 % intervals."""
    hypothesis, where = fit.hypotheses[number], fit.of(number)
    values = {}
    for (name, prior), z, interval in zip(
        hypothesis.priors.items(), fit.z[where], fit.interval[where], strict=True
    ):
        ends = sorted(prior.value(float(end)) for end in interval)
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
            whole = found.fit.log_evidence - nearest.log_evidence
            if ranked[0][1] >= criteria.rivals.log_odds:
                words += f"; {apart_words(ranked[0][1], whole)}"
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
                why=moved_modes(likelihood, found.fit, number),
            )
        )
    return causes


def _sizes(likelihood: ModalLikelihood, found: ModalFound, number: int) -> tuple[float, float]:
    """d' of a cause, and d' after projecting off its nearest rival."""
    own = change(likelihood, found.fit, number)
    size = float(np.linalg.norm(own))
    if not found.rivals[number]:
        return size, size
    rival = found.rivals[number][0][0]
    other = change(likelihood, rival, len(rival.hypotheses) - 1)
    length = float(other @ other)
    rest = own - other * (float(own @ other) / length) if length > 0 else own
    return size, float(np.linalg.norm(rest))


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
            whole = found.fit.log_evidence - one.log_evidence
            several.append((one, rival_words(behind, whole, criteria)))
    explanations = []
    for one, remark in several:
        if one.prediction is None:
            continue
        effects = [content(estimated(one, number)) for number in range(len(one.hypotheses))]
        explanations.append(
            Explanation(
                words=explanation_words(effects),
                effects=effects,
                log_odds=round(one.log_evidence, DECIMALS) + 0.0,
                gap=float(squares(likelihood, one.prediction).mean()),
                remark=remark,
            )
        )
    return sorted(explanations, key=lambda one: -one.log_odds)


def _share_left(likelihood: ModalLikelihood, before: Prediction, after: Prediction) -> float:
    """Share of the squared deviations that is left."""
    first, last = (float(squares(likelihood, one).sum()) for one in (before, after))
    return min(1.0, last / first) if first > 0 else 0.0
