"""The search for what is wrong of how a structure swings: forward, backward, and rivals."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rga.diagnosis.modal.candidates import BEGINNINGS, ModalProspect, prospects
from rga.diagnosis.modal.fit import ModalFit, fitted, least_loss, predicted, shown_by
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.separating import COMMON
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.findings.criteria import Criteria

#: prospects that are fitted whatever their kind: so many, or as many as are so near the best
#: [log-odds, or a share of what it promises: what changes much is promised roughly], but not more
#: than so many; and log-odds by which a score may be wrong
FITTED, NEAR, SHARE, MOST, ROUGHLY = 8, 12.0, 0.1, 24, 30.0
#: modes that speak for a cause: fewer are explained by anything
MODES_A_CAUSE = 3
#: coordinates beyond which a parameter is too unlikely for a rival by the data alone
UNLIKELY = 4.5
#: log-odds by which a rival is better than what was found, and how often it takes its place
WORTH_EXCHANGING, EXCHANGED = 1.0, 3
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class ModalFound:
    """What a search ends with.

    Attributes:
        fit: the causes together.
        log_odds: of each against leaving it out.
        rivals: of each what could stand in its place, the nearest first, with how far behind it is
            [log-odds]: by its evidence, or by the data alone where that is less. What is usual of
            moduli, masses and clocks, which are alike in all modes, must not tell them apart.
        first: prospects beside nothing, the best first.
    """

    fit: ModalFit
    log_odds: tuple[float, ...]
    rivals: tuple[tuple[tuple[ModalFit, float], ...], ...]
    first: list[ModalProspect]


def search(
    likelihood: ModalLikelihood,
    candidates: Sequence[Hypothesis],
    criteria: Criteria,
    progress: Progress,
) -> ModalFound:
    """Find the causes that the modes name."""
    current, first = _grown(fitted(likelihood, [], []), candidates, criteria, progress)
    odds, rivals = _weighed(current, first, candidates, progress)
    for _ in range(EXCHANGED):
        better = max((one for ranked in rivals for one, _ in ranked), key=evidence, default=current)
        if better.log_evidence - current.log_evidence < WORTH_EXCHANGING:
            break
        # What stands for a cause is better beside those that came after it.
        current = _pruned(better, criteria.naming.log_odds)
        odds, rivals = _weighed(current, first, candidates, progress)
    return ModalFound(current, odds, rivals, first)


def _grown(
    current: ModalFit,
    candidates: Sequence[Hypothesis],
    criteria: Criteria,
    progress: Progress,
) -> tuple[ModalFit, list[ModalProspect]]:
    """Causes added one by one as long as they are worth it, and the prospects beside nothing."""
    likelihood, naming = current.likelihood, criteria.naming
    first: list[ModalProspect] = []
    modes = len(likelihood.readings.modes)
    for number in range(naming.most_causes):
        words = "screening" if number == 0 else f"looking for cause {number + 1}"
        promising = prospects(
            likelihood,
            borne(candidates, current.hypotheses, modes),
            current.hypotheses,
            current.z,
            lambda done, words=words: progress(words, done),  # type: ignore[misc]
        )
        if not number:
            first = promising
        fits = [_beside(current, one) for one in worth_fitting(promising)]
        best = _timed(max(fits, key=evidence, default=current))
        if best.log_evidence - current.log_evidence < naming.log_odds:
            break
        current = _pruned(best, naming.log_odds)
    shown = shown_by(current)
    if shown.level > likelihood.level:
        # Before rivals are weighed, which takes longest.
        return _grown(fitted(shown, [], []), candidates, criteria, progress)
    return current, first


def _weighed(
    current: ModalFit,
    first: Sequence[ModalProspect],
    candidates: Sequence[Hypothesis],
    progress: Progress,
) -> tuple[tuple[float, ...], tuple[tuple[tuple[ModalFit, float], ...], ...]]:
    """Log-odds of each cause against leaving it out, and what could stand in its place."""
    odds, rivals = [], []
    for number in range(len(current.hypotheses)):
        progress("weighing rivals", number / len(current.hypotheses))
        odds.append(current.log_evidence - without(current, number).log_evidence)
        rivals.append(tuple(_rivals(current.likelihood, current, number, first, candidates)))
    progress("weighing rivals", 1.0)
    return tuple(odds), tuple(rivals)


def borne(
    candidates: Sequence[Hypothesis], causes: Sequence[Hypothesis], modes: int
) -> Sequence[Hypothesis]:
    """Candidates of which so many modes bear another beside causes.

    Those at points are borne by shapes: of a structure frequencies bear few.
    """
    of_structure = sum(not one.at_points for one in causes)
    if of_structure < max(1, modes // MODES_A_CAUSE):
        return candidates
    return [one for one in candidates if one.at_points]


def evidence(one: ModalFit) -> float:
    return one.log_evidence


def worth_fitting(promising: Sequence[ModalProspect]) -> list[ModalProspect]:
    """The best prospects, and the best of every kind, less those far behind.

    What moves all modes alike is never left out: how unusual it is must not decide.
    """
    kinds: dict[str, ModalProspect] = {}
    for one in promising:
        kinds.setdefault(one.hypothesis.name, one)
    best = promising[0].score if promising else 0.0
    near = sum(one.score > best - max(NEAR, SHARE * best) for one in promising)
    chosen = list(promising[: min(max(FITTED, near), MOST)])
    chosen += [one for one in kinds.values() if all(one is not other for other in chosen)]
    least = min(0.0, best - ROUGHLY)
    return [one for one in chosen if one.score > least or one.hypothesis.name in COMMON]


def without(current: ModalFit, number: int) -> ModalFit:
    """The fit anew without one of its hypotheses."""
    others = [one for k, one in enumerate(current.hypotheses) if k != number]
    return fitted(current.likelihood, others, np.delete(current.z, current.of(number)))


def _beside(current: ModalFit, one: ModalProspect) -> ModalFit:
    return fitted(current.likelihood, [*current.hypotheses, one.hypothesis], [*current.z, *one.z])


def _timed(one: ModalFit) -> ModalFit:
    """The fit with the last onset moved to the likeliest window about it."""
    if not one.hypotheses or one.hypotheses[-1].onset is None:
        return one
    last, best = one.hypotheses[-1], one
    for moment in _about(one.likelihood, last):
        moved = last.beginning(moment, last.profile, last.end)
        other = fitted(one.likelihood, [*one.hypotheses[:-1], moved], one.z)
        best = max(best, other, key=evidence)
    return best


def likeliest_onset(current: ModalFit, number: int) -> float | None:
    """When a cause that is held for always would have begun; None where that is no better.

    The others, and its size, stay as they are.
    """
    likelihood, several = current.likelihood, list(current.hypotheses)
    always = several[number]

    def loss(moment: float) -> float:
        several[number] = always.beginning(moment)
        there = predicted(likelihood, several, current.z)
        return np.inf if there is None else float((likelihood.residual(there) ** 2).sum())

    time = likelihood.readings.time
    step = len(time) // BEGINNINGS + 1
    nearest = min(time[1:].tolist()[::step], key=loss, default=None)
    if nearest is None:
        return None
    best = min(_about(likelihood, always.beginning(nearest)), key=loss)
    return best if loss(best) < float((current.residual**2).sum()) else None


def _about(likelihood: ModalLikelihood, late: Hypothesis) -> list[float]:
    """Times of the windows between the beginnings that were tried, about that of a hypothesis."""
    time = likelihood.readings.time
    at = int(np.searchsorted(time, np.inf if late.onset is None else late.onset))
    reach = len(time) // BEGINNINGS + 1
    return [float(moment) for moment in time[max(1, at - reach) : at + reach + 1]]


def _pruned(current: ModalFit, least: float) -> ModalFit:
    """Take out causes that others have made needless."""
    while current.hypotheses:
        fits = [without(current, number) for number in range(len(current.hypotheses))]
        best = max(fits, key=evidence)
        if current.log_evidence - best.log_evidence >= least:
            break
        current = best
    return current


def _rivals(
    likelihood: ModalLikelihood,
    current: ModalFit,
    number: int,
    first: Sequence[ModalProspect],
    candidates: Sequence[Hypothesis],
) -> list[tuple[ModalFit, float]]:
    """What could stand in the place of a cause, beside the others."""
    others = [one for k, one in enumerate(current.hypotheses) if k != number]
    z = np.delete(current.z, current.of(number))
    promising = (
        first if not others else prospects(likelihood, candidates, others, z, lambda done: None)
    )
    own = current.hypotheses[number]
    found = []
    for one in worth_fitting(promising):
        if own.same_place(one.hypothesis):
            continue
        rival = one.hypothesis
        if rival.onset is not None and own.onset in _about(likelihood, rival):
            # What begins about then has the moment that was found, as the cause has.
            rival = rival.beginning_with(own)
        other = fitted(likelihood, [*others, rival], [*z, *one.z])
        if np.isfinite(other.log_evidence):
            behind = current.log_evidence - other.log_evidence
            far = np.abs(other.z[other.of(len(others))]).max(initial=0.0) > UNLIKELY
            if {own.name, rival.name} <= COMMON:
                behind = min(behind, least_loss(other) - least_loss(current))
            elif not far:
                behind = min(behind, other.likelihood_loss - current.likelihood_loss)
            found.append((other, behind))
    return sorted(found, key=lambda pair: pair[1])
