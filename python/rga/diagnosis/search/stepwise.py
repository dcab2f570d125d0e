"""The search for causes: forward, backward and swap, by evidence."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from rga.diagnosis.data.observations import Data
from rga.diagnosis.noise.random_effects import MEDIANS, level_evidence
from rga.diagnosis.search.change_point import beginnings
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Alternative, Fit, fit
from rga.diagnosis.search.linearised import Problem, pose, relaxed, resimulated
from rga.diagnosis.search.screening import Prospect, Screening
from rga.errors import InputError
from rga.simulation import Simulator

#: prospects that are fitted, whatever their kinds: more are far behind (FAR)
FITTED = 10
#: share of the best score below which a prospect is far behind, and one of another kind than the
#: ten best hopelessly so; log-odds by which a score may be wrong whatever its size
FAR, HOPELESS, ROUGHLY = 0.3, 0.7, 30.0
#: of these fits, the likeliest that are judged by the scatter that they leave
JUDGED = 3
#: prospects that are tried because they would stand out of less scatter
HIDDEN = 5
#: log-odds to the likeliest within which fits are made exact
CLOSE = 15.0
#: rounds of weighing and exchanging causes, and the log-odds that an exchange must gain: less lies
#: within what Laplace's approximation misses
EXCHANGES, WORTH_EXCHANGE = 3, 1.0
#: log-odds that rounding makes of what acts on the same readings
ROUNDING = 1e-6
#: rounds in which inferred contexts come to rest
ROUNDS = 4
#: how far contexts at rest may move [their prior spread]
UNMOVED = 2e-4
#: rounds of posing and fitting, and the change of z below which the second is left out
SETTLED, STILL = 2, 0.05
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Found:
    """What a search ends with.

    Attributes:
        problem: the record about the extended simulation.
        fit: the causes fitted together.
        base: the simulator without causes.
        alternatives: for each cause what could stand in its place, the nearest first.
        log_odds: of each cause against leaving it out.
    """

    problem: Problem
    fit: Fit
    base: Simulator
    alternatives: tuple[tuple[Alternative, ...], ...]
    log_odds: tuple[float, ...]

    @property
    def at_fit(self) -> Problem:
        """The problem about the causes as fitted; posed a little beside them, it looks curved."""
        simulator = self.fit.simulator(self.base)
        return replace(self.problem, simulator=simulator, simulated=self.fit.simulated)


def search(
    start: Problem,
    base: Simulator,
    candidates: Sequence[Hypothesis],
    screening: Screening,
    progress: Progress,
) -> Found:
    """Find the causes that the record names.

    Args:
        start: the record about the simulation as it was given.
        base: that simulation.
        candidates: all hypotheses.
        screening: of these, about `start`.
        progress: called with what is done and the share of it.
    """
    problem, current = start, fit(start, base, [], [])
    criteria = start.criteria.naming
    for number in range(criteria.most_causes):
        prospects = screening.first
        if number:
            progress(f"looking for cause {number + 1}", 0.0)
            prospects = screening.again(problem, current.simulator(base), current.hypotheses)
        promising = [one for one in worth_fitting(prospects) if one.score > 0]
        fits = sorted(fitted_beside(problem, base, current, promising), key=evidence, reverse=True)
        fits = fits[_first_simulated(problem, base, fits) :]
        if fits and fits[0].log_evidence - current.log_evidence >= criteria.log_odds:
            best = fits[0]
        elif (hidden := _hidden_by_scatter(problem, base, current, fits, screening)) is not None:
            best = hidden
        else:
            break
        best = with_moment(problem, base, best, len(best.hypotheses) - 1)
        scattered = bool((problem.levels > MEDIANS).any())
        problem, current = settled_with(base, problem, best)
        if scattered:
            problem, current = _swapped(problem, base, current, screening)
        problem, current = _merged(base, problem, current, candidates)
        problem, current = _pruned(base, problem, current)
    return weighed(problem, base, current, screening, progress)


def weighed(
    problem: Problem,
    base: Simulator,
    current: Fit,
    screening: Screening,
    progress: Progress,
) -> Found:
    """Causes weighed against leaving each out, and against what could stand in its place.

    A cause for which something likelier is found, now that others stand beside it, is exchanged.
    """
    if current.problem is not problem:
        current = fit(problem, base, current.hypotheses, current.z)
    for number in range(len(current.hypotheses)):
        current = with_moment(problem, base, current, number)
    for _ in range(EXCHANGES):
        problem, current = _pruned(base, problem, current)
        alternatives, odds = [], []
        for number in range(len(current.hypotheses)):
            progress("weighing rivals", number / len(current.hypotheses))
            without = without_cause(problem, base, current, number)
            odds.append(current.log_evidence - without.log_evidence)
            alternatives.append(tuple(alternatives_of(problem, base, current, number, screening)))
        found = Found(problem, current, base, tuple(alternatives), tuple(odds))
        likelier = [one[0].fit for one in alternatives if one and one[0].behind < 0]
        ahead = sorted(likelier, key=evidence, reverse=True)
        better = next(iter(ahead[_first_simulated(problem, base, ahead) :]), current)
        if better.log_evidence <= current.log_evidence + WORTH_EXCHANGE:
            break
        better = with_moment(problem, base, better, len(better.hypotheses) - 1)
        problem, current = settled_with(base, problem, better)
    return found


def evidence(one: Fit) -> float:
    return one.log_evidence


def _first_simulated(problem: Problem, base: Simulator, fits: Sequence[Fit]) -> int:
    """The number of the first fit whose effects can be simulated together, or how many there are.

    Beside others an effect is tried along their signatures; friction and play, say, are not
    simulated in one model.
    """
    for number, one in enumerate(fits):
        try:
            problem.data.predict(one.simulator(base))
        except InputError:
            continue
        return number
    return len(fits)


def settled(simulator: Simulator, data: Data) -> Problem:
    """The problem of a simulation, its contexts moved to where the record puts them."""
    problem = pose(simulator, data)
    for _ in range(ROUNDS if data.belief.inferred else 1):
        moved = relaxed(problem)
        still = moved.belief.distance(problem.data.belief) < UNMOVED
        problem = pose(simulator, moved, problem)
        if still:
            break
    return problem


def with_moment(problem: Problem, base: Simulator, current: Fit, number: int) -> Fit:
    """The fit with the onset of one of its hypotheses moved to its most likely row."""
    hypothesis = current.hypotheses[number]
    if hypothesis.onset is None:
        return current
    moved = beginnings(problem, base, current, number).likeliest
    if moved == hypothesis:
        return current
    hypotheses = [moved if k == number else one for k, one in enumerate(current.hypotheses)]
    likelier = fit(problem, base, hypotheses, current.z)
    return likelier if evidence(likelier) > evidence(current) + ROUNDING else current


def _hidden_by_scatter(
    problem: Problem,
    base: Simulator,
    current: Fit,
    fits: Sequence[Fit],
    screening: Screening,
) -> Fit | None:
    """A cause that is to be named if the scatter may be as low as it makes it.

    What changes the response of many members a little passes for scatter, and is looked for where
    scatter is low.

    Args:
        fits: of prospects under the scatter as it is, the likeliest first.
    """
    fits = list(fits[:JUDGED])
    if (problem.levels > MEDIANS).any():
        usual = np.minimum(problem.levels, MEDIANS)
        covariance = problem.covariance.with_spread(problem.scatter.spread(usual))
        lower = replace(problem, covariance=covariance, levels=usual)
        hidden = screening.again(lower, current.simulator(base), current.hypotheses)
        promising = [one for one in hidden[:HIDDEN] if one.score > 0]
        fits += fitted_beside(lower, base, current, promising)
    if not fits:
        return None
    before = _at_free_levels(problem, current)
    gained = [_at_free_levels(problem, one) - before for one in fits]
    best = int(np.argmax(gained))
    return fits[best] if gained[best] >= problem.criteria.naming.log_odds else None


def _swapped(
    problem: Problem, base: Simulator, current: Fit, screening: Screening
) -> tuple[Problem, Fit]:
    """Something likelier in the place of the last cause, if there is.

    What a cause leaves out passes for scatter until it is named: causes that were much alike among
    that scatter may be far apart without it.
    """
    last = len(current.hypotheses) - 1
    for one in alternatives_of(problem, base, current, last, screening)[:1]:
        if one.fit.log_evidence > current.log_evidence + WORTH_EXCHANGE:
            better = with_moment(problem, base, one.fit, last)
            return settled_with(base, problem, better)
    return problem, current


def fitted_beside(
    problem: Problem, base: Simulator, current: Fit, prospects: Sequence[Prospect]
) -> list[Fit]:
    """Each prospect fitted beside the causes of a fit; those near the likeliest exactly."""

    def beside(hypothesis: Hypothesis, z: Sequence[float], exactly: bool) -> Fit:
        return fit(problem, base, [*current.hypotheses, hypothesis], z, current, exactly)

    fits = [beside(one.hypothesis, [*current.z, *one.z], False) for one in prospects]
    near = max(map(evidence, fits), default=0.0) - CLOSE
    return [
        one
        if one.exact or one.log_evidence < near
        else beside(one.hypotheses[-1], list(one.z), True)
        for one in fits
    ]


def _at_free_levels(problem: Problem, one: Fit) -> float:
    """Log evidence of a fit with the scatter that suits it, up to a constant."""
    if not np.isfinite(one.log_evidence):
        return -np.inf
    residual = problem.residual(one.simulated)
    free = level_evidence(problem.covariance, problem.scatter, residual, problem.levels)
    freedom = float(one.z @ one.z) + float(np.linalg.slogdet(one.information)[1])
    return free - 0.5 * freedom + sum(each.log_prior for each in one.hypotheses)


def worth_fitting(prospects: Sequence[Prospect]) -> list[Prospect]:
    """The best prospects, and the best of every other kind, less those far behind the best.

    Places of one kind may be much alike, and would leave no room for another kind.
    """
    best = prospects[0].score if prospects else 0.0
    first: dict[str, Prospect] = {}
    for one in prospects:
        first.setdefault(one.hypothesis.name, one)
    fitted = prospects[:FITTED]
    others = [one for one in first.values() if one not in fitted]
    return [
        one
        for some, share in ((fitted, FAR), (others, HOPELESS))
        for one in some
        if one.score > min(share * best, best - ROUGHLY)
    ]


def settled_with(base: Simulator, problem: Problem, best: Fit) -> tuple[Problem, Fit]:
    """The problem posed anew about the extended simulation, and the causes fitted again."""
    current = best
    for _ in range(SETTLED):
        simulator = current.simulator(base)
        moved = relaxed(resimulated(problem, simulator, problem.data))
        problem = pose(simulator, moved, problem)
        before, current = current, fit(problem, base, current.hypotheses, current.z)
        if np.abs(current.z - before.z).max(initial=0.0) < STILL:
            break
    return problem, current


def _merged(
    base: Simulator, problem: Problem, current: Fit, candidates: Sequence[Hypothesis]
) -> tuple[Problem, Fit]:
    """Put one hypothesis for many places in the stead of several for one place each."""
    for candidate in candidates:
        parts = [k for k, one in enumerate(current.hypotheses) if candidate.contains(one)]
        if len(parts) < 2:
            continue
        slices = current.slices()
        kept = [k for k in range(len(current.hypotheses)) if k not in parts]
        hypotheses = [*(current.hypotheses[k] for k in kept), candidate]
        others = [current.z[slices[k]] for k in kept]
        # Shared by many, the effect is smaller at each.
        trials = product(*(prior.trials for prior in candidate.priors.values()))
        starts = [current.z[slices[parts[0]]], *map(np.array, trials)]
        merged = max(
            (fit(problem, base, hypotheses, np.concatenate([*others, one])) for one in starts),
            key=evidence,
        )
        if merged.log_evidence > current.log_evidence:
            return settled_with(base, problem, merged)
    return problem, current


def _pruned(base: Simulator, problem: Problem, current: Fit) -> tuple[Problem, Fit]:
    """Take out causes that the others have made needless."""
    while current.hypotheses:
        fits = [without_cause(problem, base, current, k) for k in range(len(current.hypotheses))]
        best = max(fits, key=evidence)
        if current.log_evidence - best.log_evidence >= problem.criteria.naming.log_odds:
            break
        problem, current = settled_with(base, problem, best)
    return problem, current


def without_needless(problem: Problem, found: Found) -> Fit:
    """The causes, less those that another problem on the same record speaks for much less.

    A cause at a sensor stays where it is named there too: a channel that is far off is no less off
    for a slope that may be free within the size of a curve.
    """
    base, kept = found.base, list(range(len(found.fit.hypotheses)))
    least, share = problem.criteria.naming.log_odds, problem.criteria.naming.kept_with_free_slopes
    needed = [
        least if cause.kind.on_sensors else max(least, share * odds)
        for cause, odds in zip(found.fit.hypotheses, found.log_odds, strict=True)
    ]
    current = fit(problem, base, found.fit.hypotheses, found.fit.z)
    while kept:
        fits = [without_cause(problem, base, current, k) for k in range(len(kept))]
        over = [
            current.log_evidence - one.log_evidence - needed[number]
            for one, number in zip(fits, kept, strict=True)
        ]
        weakest = int(np.argmin(over))
        if over[weakest] >= 0:
            break
        current = fits[weakest]
        del kept[weakest]
    return current


def without_cause(problem: Problem, base: Simulator, current: Fit, *numbers: int) -> Fit:
    """The fit anew without some of its hypotheses; it is kept."""
    key = problem, base, numbers
    if key not in current.without:
        others = [one for k, one in enumerate(current.hypotheses) if k not in numbers]
        parts = [np.arange(len(current.z))[part] for part in current.slices()]
        gone = np.concatenate([parts[number] for number in numbers])
        current.without[key] = fit(problem, base, others, np.delete(current.z, gone))
    return current.without[key]


def alternatives_of(
    problem: Problem,
    base: Simulator,
    current: Fit,
    number: int,
    screening: Screening,
) -> list[Alternative]:
    """Other hypotheses in the place of a cause, fitted beside the others, the best first.

    They are kept.
    """
    key = problem, base, screening, number
    if key not in current.alternatives:
        current.alternatives[key] = _fitted_alternatives(problem, base, current, number, screening)
    return current.alternatives[key]


def _fitted_alternatives(
    problem: Problem, base: Simulator, current: Fit, number: int, screening: Screening
) -> list[Alternative]:
    without = without_cause(problem, base, current, number)
    cause = current.hypotheses[number]
    beginning = None if cause.onset is None else cause
    simulator = without.simulator(base)
    prospects = screening.again(problem, simulator, current.hypotheses, beginning)
    found = [
        Alternative(one.hypotheses[-1], one, current.log_evidence - one.log_evidence)
        for one in fitted_beside(problem, base, without, worth_fitting(prospects))
    ]
    return sorted(found, key=lambda one: -one.fit.log_evidence)
