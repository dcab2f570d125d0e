"""The diagnosis: a model and a record in, findings out."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from rga.arrays import FloatArray
from rga.diagnosis.assemble.causes import causes, fault_cause
from rga.diagnosis.assemble.contexts import contexts, doubted_instruments
from rga.diagnosis.assemble.effects import cause_name, effects_of, fault_effect
from rga.diagnosis.assemble.explanations import explanations, unidentifiable
from rga.diagnosis.assemble.gaps import gap, groups
from rga.diagnosis.checks.explanations import Tried, compare, sensor_groups
from rga.diagnosis.checks.own_response import own_response
from rga.diagnosis.checks.robustness import (
    with_better_prediction,
    with_hanging_leads,
    without_unhelpful,
)
from rga.diagnosis.checks.short_record import too_short
from rga.diagnosis.checks.support import gaps_left_out, supported
from rga.diagnosis.checks.whole_record import WholeRecord
from rga.diagnosis.data.held_out import held_out_rows
from rga.diagnosis.data.observations import Data
from rga.diagnosis.fallback import spared
from rga.diagnosis.mixed.fit import MixedEvidence
from rga.diagnosis.mixed.readings import modes_beside
from rga.diagnosis.mixed.search import search as search_both
from rga.diagnosis.mixed.told import ToldModes
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.preparation.prepare import PreparedRecord, prepare
from rga.diagnosis.residuals import patterns
from rga.diagnosis.residuals.curvature import curves, free_channels
from rga.diagnosis.residuals.lack_of_fit import misfits
from rga.diagnosis.residuals.slopes import bends, with_free_slopes
from rga.diagnosis.residuals.stated_noise import beyond_stated
from rga.diagnosis.search.hypothesis import hypotheses
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Screening
from rga.diagnosis.search.stepwise import (
    Found,
    search,
    settled,
    settled_with,
    weighed,
    without_needless,
)
from rga.diagnosis.verdict import reasons_for_doubt, verdict
from rga.errors import InputError
from rga.findings import Findings
from rga.findings.arrays import DiagnosisArrays
from rga.findings.criteria import Criteria, as_criteria
from rga.given import as_record
from rga.model import Model, as_model
from rga.numerics.seeds import as_seed
from rga.provenance import versions
from rga.records import Record, RecordMapping, RecordSource
from rga.records.modal.record import ModalRecord
from rga.simulation import ModalSimulator, Simulator

Progress = Callable[[str, float], None]
#: fewer readings of most channels show too little of the scatter
SHOW_SCATTER = 20


def diagnose(
    model: Model | str | Path,
    record: Record | RecordSource,
    *,
    mapping: str | Path | RecordMapping | None = None,
    parts: Model | None = None,
    calm: Record | None = None,
    modal: ModalRecord | str | Path | None = None,
    criteria: Criteria | str | Path | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Findings:
    """Diagnose what a model gets wrong of a record.

    Natural frequencies and mode shapes of the same structure add what gauges do not show: what is
    lateral, what is mass, and whether stiffness or load is off.

    Args:
        model: the structure with its effects and sensors, or its file.
        record: measured data, or their file.
        mapping: how to read the file, as `load_record` takes it.
        parts: the model in whose parts causes are looked for, where this one has others beside
            them; None: this one.
        calm: measured rows in which nothing acts that is looked for, so that the scatter shows
            there as it is; None: it is estimated from all rows, beside causes.
        modal: modes found in windows of time, or their file (`load_modal_record`); contexts that
            it lacks are those of the record at the time. None: there are none.
        criteria: what decides the verdict, or their file; None: the default ones.
        seed: of the bootstrap of the gain.
        progress: called with a stage and the share of it that is done.

    Returns:
        Findings with verdict, causes, gain, and what stays unexplained.

    Raises:
        InputError: a file cannot be used, the record is too short, the model cannot be simulated,
            clocks of record and modes cannot be compared, or the seed is none.
    """
    tell_progress = progress or (lambda stage, done: None)
    model, seed = as_model(model), as_seed(seed)
    record, chosen = as_record(record, model, mapping), as_criteria(criteria)
    modes = None if modal is None else modes_beside(model, record, modal)
    with threadpool_limits(1):
        return _diagnose(model, parts or model, record, calm, modes, chosen, seed, tell_progress)


def _diagnose(
    model: Model,
    parts: Model,
    record: Record,
    calm: Record | None,
    modal: ModalLikelihood | None,
    criteria: Criteria,
    seed: int,
    progress: Progress,
) -> Findings:
    def read(done: float) -> None:
        progress("reading the contexts", done)

    prepared = prepare(model, record, read, criteria)
    read(1.0)
    held_out = held_out_rows(len(prepared.data.time))
    # What a logger took off is a part of the data: a late effect shows whole all the same.
    base = Simulator(model.without_zeros())
    measured = set(record.contexts)
    scatter = None if calm is None else _scatter_of(model, calm, criteria)

    def searched(prepared: PreparedRecord) -> tuple[Problem, Screening, Found]:
        data = replace(prepared.data.rows(~held_out), scatter=scatter)
        candidates = hypotheses(parts.without_zeros(), data.sensors, measured)
        start = settled(base, data)
        progress("estimating the noise", 1.0)
        screening = Screening(start, base, candidates, lambda x: progress("screening", x))
        found = search(start, base, candidates, screening, progress)
        progress("weighing rivals", 1.0)
        return start, screening, found

    start, screening, found = searched(prepared)
    while (apart := own_response(found)) is not None:
        prepared = prepared.leaving_out(apart, base)
        start, screening, found = searched(prepared)
    whole = WholeRecord.of(prepared.data, held_out, found.problem)

    def reweighed(left: Found) -> Found:
        return weighed(left.problem, base, left.fit, screening, progress)

    found, dropped = supported(
        _confirmed(found, screening, progress), start, whole, seed, reweighed
    )
    progress("leaving out channels", 1.0)
    unseen = gaps_left_out(found)
    told: ToldModes | None = None
    if modal is not None:
        evidence = MixedEvidence(found.problem, base, modal)
        mixed = search_both(found, evidence, screening, criteria, progress)
        found, told = mixed.found, ToldModes(mixed, prepared.record)
    failed: list[str] = []
    no_explanations: list[Tried] = []
    tried = spared(
        "the comparison of explanations",
        lambda: compare(found, screening.first, lambda x: progress("comparing explanations", x)),
        no_explanations,
        failed,
    )

    effects = effects_of(found, prepared.record)
    faults = {fault: fault_effect(fault, prepared.record) for fault in prepared.faults}
    named = {cause_name(model, effect): effect for effect in effects}
    broken = {f"fault of {fault.sensor}": effect for fault, effect in faults.items()}
    known = model if told is None else ModalSimulator(model).with_shapes()
    extended = known.extended({**named, **broken})
    before, believed = whole.simulated(start), whole.believed(found.problem)
    after = whole.at_zero(found.problem, believed.predict(Simulator(extended.without_zeros())))
    gained = whole.gain(before, after, found.fit.hypotheses, seed)
    account = _account(model, extended, prepared, whole, believed, (before, after), found)
    share = patterns.share_left(found.problem)
    grouped = sensor_groups(model, found.problem.data.sensors)
    off = misfits(found.problem, found.fit.simulated, grouped)
    by_modes = told is not None and told.by_modes
    reasons = reasons_for_doubt(
        record.sensors, prepared.faults, found, dropped, off, gained, unseen, by_modes
    )
    reasons = [*prepared.doubts, *reasons, *([] if told is None else told.doubts())]
    reasons += [
        f"channel {name} answers the loads in a way of its own, likelier than causes that would "
        "move other channels too: no cause was looked for in it"
        for name in prepared.apart
    ]
    reasons += beyond_stated(found.problem, {fault.sensor for fault in prepared.faults})
    short = too_short(whole.data, before, whole.deviation)
    curved = patterns.nonlinear(found.at_fit)
    structure = bool(reasons or short or curved) or share > criteria.structure.share
    said = verdict(found, bool(prepared.faults), structure)
    pattern = spared(
        "what the structure that is left goes with",
        lambda: patterns.in_words(
            found.problem, patterns.known_contexts(found.problem, measured), curved
        ),
        "not known",
        failed,
    )
    looks_like = [*reasons, pattern]
    if short and said == "unknown":
        # What else is said of so few rows is chance.
        off, looks_like = [], [*prepared.doubts, short]
    elif short:
        looks_like = [short, *looks_like]
    findings = Findings(
        verdict=said,
        gap=gap(account, gained),
        causes=[
            *(fault_cause(fault, effect) for fault, effect in faults.items()),
            *causes(found, effects, prepared.record, failed),
        ],
        unidentifiable=unidentifiable(screening.first, criteria.explanations.smallest_d_prime),
        unexplained={"share": share, "looks_like": "; ".join(looks_like)},
        explanations=explanations(tried, found, prepared.record),
        groups=groups(account, grouped),
        contexts=contexts(found.problem, model),
        warnings=[
            *prepared.warnings,
            *doubted_instruments(found.problem, model),
            *(one.words for one in off if one.alone),
            *failed,
        ],
        misfits=list(
            dict.fromkeys([*prepared.apart, *(name for one in off for name in one.channels)])
        ),
        criteria=criteria,
        seed=seed,
        model_sha256=model.sha256,
        record_sha256=record.sha256,
        versions=versions(),
    )
    findings._account = account
    if told is not None:
        findings = told.told(findings, model, extended, tried)
    progress("done", 1.0)
    return findings


def _scatter_of(model: Model, calm: Record, criteria: Criteria) -> FloatArray | None:
    """Levels of the scatter in rows in which nothing acts; None where they show too little.

    A cause that acts for long enough would else pass for scatter.
    """
    if np.median(np.isfinite(calm.readings).sum(axis=0)) < SHOW_SCATTER:
        return None
    try:
        data = prepare(model, calm, lambda done: None, criteria).data
    except InputError:
        return None
    return settled(Simulator(model.without_zeros()), data).levels


def _confirmed(found: Found, screening: Screening, progress: Progress) -> Found:
    """The causes that stand once the structure that they leave is part of the noise.

    A cause that was named only because it resembles a pattern of unknown origin falls here, and
    one that does not help channels which were not fitted.
    """
    problem = patterns.with_leftovers(found.problem)
    doubtful = problem is not found.problem
    if doubtful:
        found = weighed(problem, found.base, found.fit, screening, progress)
    fitted = found.at_fit
    sloped, curved = bends(fitted), curves(fitted)
    if sloped or curved:
        doubtful = True
        free = with_free_slopes(fitted, sloped, free_channels(fitted, curved))
        standing = without_needless(free, found)
        if len(standing.hypotheses) < len(found.fit.hypotheses):
            problem, standing = settled_with(found.base, found.problem, standing)
            found = weighed(problem, found.base, standing, screening, progress)
    if not doubtful:
        return found
    helpful = without_unhelpful(found.problem, found.base, found.fit)
    if len(helpful.hypotheses) < len(found.fit.hypotheses):
        found = weighed(found.problem, found.base, helpful, screening, progress)
    hanging = with_hanging_leads(found, lambda done: progress("leaving out channels", done))
    return with_better_prediction(hanging)


def _account(
    model: Model,
    extended: Model,
    prepared: PreparedRecord,
    whole: WholeRecord,
    believed: Data,
    ends: tuple[FloatArray, FloatArray],
    found: Found,
) -> DiagnosisArrays:
    """What was measured and simulated at both ends of the search: before and after.

    The gap is in units of the noise as it was before shared patterns were taken out of it.
    """
    full, record = prepared.data, prepared.record
    columns = [record.sensors.index(name) for name in full.sensors]
    rejected = np.array([name not in full.sensors for name in record.sensors])

    def placed(values: FloatArray) -> FloatArray:
        out = np.full((*values.shape[:-1], len(record.sensors)), np.nan)
        out[..., columns] = values
        return out

    readings = placed(np.where(full.observed, full.readings, np.nan))
    before, after = map(placed, ends)
    return DiagnosisArrays(
        model=model,
        extended=extended,
        record=replace(record, readings=np.where(rejected, record.readings, readings)),
        held_out=whole.held_out,
        rejected=rejected,
        before=before,
        after=after,
        sigma=placed(whole.deviation),
        noise=placed(whole.noise),
        contexts=believed.belief.table,
        found=found,
        recorded=len(prepared.chosen),
    )
