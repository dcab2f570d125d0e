"""The diagnosis: a model and a record in, findings out."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from rga.diagnosis import leftover, tell
from rga.diagnosis.account import Account
from rga.diagnosis.bends import bends, with_free_slopes
from rga.diagnosis.curves import curves, free_channels
from rga.diagnosis.data import Data
from rga.diagnosis.explanations import compare, sensor_groups, variance
from rga.diagnosis.findings import Findings
from rga.diagnosis.heldout import Gain, gain, held_out_rows
from rga.diagnosis.hypothesis import hypotheses
from rga.diagnosis.prepare import Prepared, prepare
from rga.diagnosis.problem import Problem, pose, relaxed, resimulated
from rga.diagnosis.robustness import (
    with_better_prediction,
    with_hanging_leads,
    without_unhelpful,
)
from rga.diagnosis.row_covariance import BoolArray
from rga.diagnosis.screening import Screening
from rga.diagnosis.search import (
    ROUNDS,
    UNMOVED,
    Found,
    search,
    settled,
    settled_with,
    weighed,
    without_needless,
)
from rga.model.parameter import FloatArray
from rga.model.schema import Model
from rga.records import Record
from rga.simulation import Simulator

#: share of the innovations' variance that makes structure worth a word
STRUCTURE = 0.02
Progress = Callable[[str, float], None]


def diagnose(
    model: Model, record: Record, *, seed: int = 0, progress: Progress | None = None
) -> Findings:
    """Diagnose what a model gets wrong of a record.

    Args:
        model: the structure with its effects and sensors.
        record: measured data.
        seed: of the bootstrap of the gain.
        progress: told a stage and the share of it that is done.

    Returns:
        Findings with verdict, causes, gain, and what stays unexplained.

    Raises:
        InputError: the record is too short, or the model cannot be simulated.
    """
    tell_progress = progress or (lambda stage, done: None)
    with threadpool_limits(1):
        return _diagnose(model, record, seed, tell_progress)


def _diagnose(model: Model, record: Record, seed: int, progress: Progress) -> Findings:
    prepared = prepare(model, record, lambda done: progress("reading the contexts", done))
    held_out = held_out_rows(len(prepared.data.time))
    data = prepared.data.rows(~held_out)
    base = Simulator(model)
    measured = set(record.contexts)
    candidates = hypotheses(model, data.sensors, measured)
    start = settled(base, data)
    screening = Screening(start, base, candidates, lambda x: progress("screening", x))
    found = search(start, base, candidates, screening, progress)
    noise = found.problem
    found = _confirmed(found, screening, progress)
    tried = compare(found, screening.first, lambda done: progress("comparing explanations", done))

    effects = tell.effects_of(found, prepared.record)
    faults = {fault: tell.fault_effect(fault, prepared.record) for fault in prepared.faults}
    named = {tell.cause_name(model, effect): effect for effect in effects}
    broken = {f"fault of {fault.sensor}": effect for fault, effect in faults.items()}
    extended = model.extended({**named, **broken})
    account = _account(model, extended, prepared, held_out, (start, found), noise)
    share = leftover.share_left(found.problem)
    structure = share > STRUCTURE or bool(bends(found.problem) or curves(found.problem))
    grouped = sensor_groups(model, data.sensors)
    misfits = tell.misfits(account, grouped)
    findings = Findings(
        verdict=tell.verdict(found, bool(prepared.faults), structure),
        gap=tell.gap(account, gain_of(account, seed)),
        causes=[
            *(tell.fault_cause(fault, effect) for fault, effect in faults.items()),
            *tell.causes(found, effects, prepared.record),
        ],
        unidentifiable=tell.unidentifiable(screening.first),
        unexplained={
            "share": share,
            "looks_like": leftover.in_words(
                found.problem, leftover.known_contexts(found.problem, measured)
            ),
        },
        explanations=tell.explanations(tried, found, prepared.record),
        groups=tell.groups(account, grouped),
        contexts=tell.contexts(found.problem, model),
        warnings=[*prepared.warnings, *misfits.values()],
        misfits=list(misfits),
        seed=seed,
        model_sha256=model.sha256,
        record_sha256=record.sha256,
        versions=tell.versions(),
    )
    findings._account = account
    progress("done", 1.0)
    return findings


def _confirmed(found: Found, screening: Screening, progress: Progress) -> Found:
    """The causes that stand once the structure that they leave is part of the noise.

    A cause that was named only because it resembles a pattern of unknown origin falls here, and
    one that does not help channels which were not fitted.
    """
    problem = leftover.with_leftovers(found.problem)
    doubtful = problem is not found.problem
    if doubtful:
        found = weighed(problem, found.base, found.fit, screening, progress)
    bent, curved = bends(found.problem), curves(found.problem)
    if bent or curved:
        doubtful = True
        free = with_free_slopes(found.problem, bent, free_channels(found.problem, curved))
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
    prepared: Prepared,
    held_out: BoolArray,
    ends: tuple[Problem, Found],
    noise_of: Problem,
) -> Account:
    """What was measured and simulated, before and after: the search's `ends`.

    The gap is in units of the noise as it was before shared patterns were taken out of it.
    """
    full = prepared.data
    start, found = ends
    at_first = _everywhere(full, start)
    before = at_first.predict(Simulator(model))
    believed = at_first if found.problem is start else _everywhere(full, found.problem)
    after = believed.predict(Simulator(extended))
    record = prepared.record
    columns = [record.sensors.index(name) for name in full.sensors]
    rejected = np.array([name not in full.sensors for name in record.sensors])

    def placed(values: FloatArray, otherwise: float = np.nan) -> FloatArray:
        out = np.full((len(values), len(record.sensors)), otherwise)
        out[:, columns] = values
        return out

    spread = np.sqrt(variance(noise_of))
    noise = np.empty_like(full.readings)
    noise[~held_out] = spread
    noise[held_out] = np.sqrt((spread**2).mean(0))
    sigma = np.full(len(record.sensors), np.nan)
    sigma[columns] = noise_of.noise.deviation
    readings = placed(np.where(full.observed, full.readings, np.nan))

    return Account(
        model=model,
        extended=extended,
        record=replace(record, readings=np.where(rejected, record.readings, readings)),
        held_out=held_out,
        rejected=rejected,
        before=placed(before),
        after=placed(after),
        sigma=sigma,
        noise=placed(noise),
        contexts=believed.belief.table,
        found=found,
    )


def _everywhere(full: Data, part: Problem) -> Data:
    """All rows with their latent contexts.

    Lines are prolonged. What is latent row by row can only come from the readings of the row: on
    held-out rows the model infers it as it would in use.
    """
    changes = {}
    belief = part.data.belief
    clock = part.data.time - part.data.time[0]
    for name in belief.lines:
        line = np.polyfit(clock, belief.table[name], 1)
        changes[name] = np.polyval(line, full.time - part.data.time[0])
    whole = replace(full, belief=full.belief.with_values(changes))
    if not belief.latent:
        return whole
    problem = pose(part.simulator, whole, factors=part.factors)
    for _ in range(ROUNDS):
        inferred = relaxed(problem).belief.table
        latent = {name: column for name, column in inferred.items() if name in belief.latent}
        before, whole = whole, replace(whole, belief=whole.belief.with_values(latent))
        if whole.belief.distance(before.belief) < UNMOVED:
            break
        problem = resimulated(problem, part.simulator, whole)
    return whole


def gain_of(account: Account, seed: int) -> Gain:
    """Gain by the readings of the held-out rows."""
    left = (account.record.readings - account.after) / account.noise
    change = (account.after - account.before) / account.noise
    return gain(left, change, account.held_out, seed)
