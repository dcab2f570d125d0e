"""The search for causes in a record and in modes: from those of the record on."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.mixed.fit import MixedEvidence, MixedFit
from rga.diagnosis.modal.candidates import ModalProspect, modal_hypotheses, prospects
from rga.diagnosis.modal.fit import shown_by
from rga.diagnosis.modal.search import (
    EXCHANGED,
    UNLIKELY,
    borne,
    likeliest_onset,
    worth_fitting,
)
from rga.diagnosis.modal.separating import COMMON
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Alternative
from rga.diagnosis.search.screening import Screening
from rga.diagnosis.search.stepwise import Found, alternatives_of, without_cause
from rga.findings.criteria import Criteria
from rga.findings.criteria.causes import NamingCriteria

#: log-odds that an exchange must gain
WORTH_EXCHANGE = 1.0
#: what could stand in the place of a cause by the record alone and is weighed by the modes too
MOST = 16
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class MixedFound:
    """What a search ends with.

    Attributes:
        found: the causes, with rivals and log-odds by record and modes together.
        evidence: that weighed them.
        fit: the causes fitted together.
        rivals: of each cause what could stand in its place, with how far it is behind [log-odds].
        promising: what modes may show beside the causes of the record, the likeliest first.
    """

    found: Found
    evidence: MixedEvidence
    fit: MixedFit
    rivals: tuple[tuple[tuple[MixedFit, float], ...], ...]
    promising: list[ModalProspect]


def search(
    found: Found,
    evidence: MixedEvidence,
    screening: Screening,
    criteria: Criteria,
    progress: Progress,
) -> MixedFound:
    """Find the causes that a record and modes name together.

    Args:
        found: the causes that the record names.
        evidence: of the record about these, and of the modes.
        screening: of what could be wrong, by the record.
        criteria: what decides a verdict.
        progress: called with what is done and the share of it.
    """
    mixed = _searched(found, evidence, screening, criteria, progress)
    while (shown := shown_by(mixed.fit.modal)).level > mixed.evidence.likelihood.level:
        again = replace(evidence, likelihood=shown)
        mixed = _searched(found, again, screening, criteria, progress)
    return mixed


def _searched(
    found: Found,
    evidence: MixedEvidence,
    screening: Screening,
    criteria: Criteria,
    progress: Progress,
) -> MixedFound:
    candidates = modal_hypotheses(evidence.likelihood.trials)
    naming = criteria.naming
    current, evidence, first = _grown(found, evidence, (screening, candidates), naming, progress)
    standing = found.fit.hypotheses, screening, candidates
    odds, rivals = _weighed(current, evidence, standing, progress)
    for _ in range(EXCHANGED):
        beside = [fit for ranked in rivals for fit, _ in ranked]
        better = max(beside, key=log_evidence, default=current)
        if better.log_evidence <= current.log_evidence + WORTH_EXCHANGE:
            break
        # What stands for a cause is better beside those that came after it.
        current = _pruned(better, evidence, naming.log_odds)
        odds, rivals = _weighed(current, evidence, standing, progress)
    joined = Found(
        found.problem,
        current.static,
        found.base,
        tuple(
            tuple(Alternative(one.hypotheses[-1], one.static, behind) for one, behind in ranked)
            for ranked in rivals
        ),
        tuple(odds),
    )
    return MixedFound(joined, evidence, current, tuple(map(tuple, rivals)), first)


def _grown(
    found: Found,
    evidence: MixedEvidence,
    possible: tuple[Screening, Sequence[Hypothesis]],
    naming: NamingCriteria,
    progress: Progress,
) -> tuple[MixedFit, MixedEvidence, list[ModalProspect]]:
    """The causes of a record, and those of the modes added one by one as long as they are worth it.

    With the evidence, of which the error of the model may be larger, and the prospects beside the
    causes of the record.

    Args:
        found: the causes that the record names.
        evidence: of record and modes.
        possible: what could be wrong by the record, and by the modes.
        naming: what a cause must be worth, and how many there may be.
        progress: called with what is done and the share of it.
    """
    screening, candidates = possible
    current = _exchanged(evidence.beside(found.fit), evidence, screening)
    current = _begun(current, evidence)
    modes = len(evidence.likelihood.readings.modes)
    of_record = len(current.hypotheses)
    first = promising = _promising(evidence, current, candidates, progress)
    for number in range(naming.most_causes - of_record):
        if number:
            left = borne(candidates, current.hypotheses[of_record:], modes)
            promising = _promising(evidence, current, left, progress)
        fits = _fitted(evidence, current, promising)
        best = max(fits, key=log_evidence, default=current)
        if best.log_evidence - current.log_evidence < naming.log_odds:
            break
        current = _pruned(best, evidence, naming.log_odds)
    shown = shown_by(current.modal)
    if shown.level > evidence.likelihood.level:
        # Before rivals are weighed, which takes longest.
        return _grown(found, replace(evidence, likelihood=shown), possible, naming, progress)
    return current, evidence, first


def _weighed(
    current: MixedFit,
    evidence: MixedEvidence,
    standing: tuple[Sequence[Hypothesis], Screening, Sequence[Hypothesis]],
    progress: Progress,
) -> tuple[list[float], list[list[tuple[MixedFit, float]]]]:
    """Log-odds of each cause against leaving it out, and what could stand in its place.

    Args:
        current: the causes.
        evidence: of record and modes.
        standing: what the record named; what could be wrong by the record, and by the modes.
        progress: called with what is done and the share of it.
    """
    odds, rivals = [], []
    for number in range(len(current.hypotheses)):
        progress("weighing rivals", number / len(current.hypotheses))
        rest = _without(current, evidence, number)
        odds.append(current.log_evidence - rest.log_evidence)
        rivals.append(_rivals(current, rest, number, evidence, standing))
    return odds, rivals


def log_evidence(one: MixedFit) -> float:
    return one.log_evidence


def _promising(
    evidence: MixedEvidence,
    current: MixedFit,
    candidates: Sequence[Hypothesis],
    progress: Progress,
) -> list[ModalProspect]:
    """What the modes would have beside causes, the likeliest first."""
    return prospects(
        evidence.likelihood,
        candidates,
        current.modal.hypotheses,
        current.modal.z,
        lambda done: progress("looking for causes in the modes", done),
    )


def _fitted(
    evidence: MixedEvidence, current: MixedFit, promising: Sequence[ModalProspect]
) -> list[MixedFit]:
    """The best of these, fitted to the record as well."""
    return [
        evidence.fit([*current.hypotheses, one.hypothesis], [*current.z, *one.z])
        for one in worth_fitting(promising)
        if not any(one.hypothesis.same_place(other) for other in current.hypotheses)
    ]


def _exchanged(current: MixedFit, evidence: MixedEvidence, screening: Screening) -> MixedFit:
    """The causes of the record, less those in whose place the modes would have another."""
    for number in range(len(current.hypotheses)):
        options = [
            evidence.beside(one.fit) for one in _of_record(current, number, evidence, screening)
        ]
        best = max(options, key=log_evidence, default=current)
        if best.log_evidence > current.log_evidence + WORTH_EXCHANGE:
            current = best
    return current


def _begun(current: MixedFit, evidence: MixedEvidence) -> MixedFit:
    """The causes of the record, those that act in all of it begun when the modes show them first.

    A record that lies wholly behind an onset cannot tell it, nor can shapes, which are means.
    """
    for number, one in enumerate(current.hypotheses):
        shown = evidence.on_modes(current.hypotheses)
        if one.onset is not None or one.at_points or number not in shown:
            continue
        onset = likeliest_onset(current.modal, shown.index(number))
        if onset is None:
            continue
        begun = list(current.hypotheses)
        begun[number] = one.beginning(onset)
        other = evidence.fit(begun, current.z)
        if other.log_evidence > current.log_evidence + WORTH_EXCHANGE:
            current = other
    return current


def _of_record(
    current: MixedFit, number: int, evidence: MixedEvidence, screening: Screening
) -> list[Alternative]:
    """What could stand in the place of a cause by the record, the nearest first."""
    found = alternatives_of(evidence.problem, evidence.base, current.alone, number, screening)
    return found[:MOST]


def _without(current: MixedFit, evidence: MixedEvidence, number: int) -> MixedFit:
    """The fit anew without one of its hypotheses."""
    alone = without_cause(evidence.problem, evidence.base, current.alone, number)
    return evidence.beside(alone, _others(current, number))


def _others(current: MixedFit, number: int) -> FloatArray:
    """Coordinates of all hypotheses but one."""
    return np.delete(current.z, current.static.slices()[number])


def _pruned(current: MixedFit, evidence: MixedEvidence, least: float) -> MixedFit:
    """Take out causes that others have made needless."""
    while current.hypotheses:
        fits = [_without(current, evidence, number) for number in range(len(current.hypotheses))]
        best = max(fits, key=log_evidence)
        if current.log_evidence - best.log_evidence >= least:
            break
        current = best
    return current


def _rivals(
    current: MixedFit,
    rest: MixedFit,
    number: int,
    evidence: MixedEvidence,
    standing: tuple[Sequence[Hypothesis], Screening, Sequence[Hypothesis]],
) -> list[tuple[MixedFit, float]]:
    """What could stand in the place of a cause beside the others, with how far it is behind.

    By its evidence; for what the modes named, and for what moves all modes alike, by the data alone
    where that is less: what is usual of moduli, masses and clocks must not tell them apart.
    """
    known, screening, candidates = standing
    own = current.hypotheses[number]
    others = _others(current, number)
    several = [
        evidence.beside(one.fit, [*others, *one.fit.z[len(others) :]])
        for one in _of_record(current, number, evidence, screening)
    ]
    if evidence.on_modes([own]):
        several += _fitted(
            evidence, rest, _promising(evidence, rest, candidates, lambda stage, done: None)
        )
    found: list[tuple[MixedFit, float]] = []
    for one in several:
        rival = one.hypotheses[-1]
        if own.same_place(rival) or any(
            rival.same_place(other.hypotheses[-1]) for other, _ in found
        ):
            continue
        if not np.isfinite(one.log_evidence):
            continue
        behind = current.log_evidence - one.log_evidence
        near = np.abs(one.z[one.static.slices()[-1]]).max(initial=0.0) <= UNLIKELY
        by_modes = not any(own.same_place(one) for one in known)
        if {own.name, rival.name} <= COMMON or (by_modes and near):
            behind = min(behind, one.loss - current.loss)
        found.append((one, behind))
    return sorted(found, key=lambda pair: pair[1])
