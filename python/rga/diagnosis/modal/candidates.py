"""What could be wrong of how a structure swings: hypotheses, and which are worth a fit."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.modal.fit import predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses_of
from rga.model.effect import Effect
from rga.model.parameter import Factor, Prior
from rga.simulation.modal.pairing import close_modes

#: places of a kind at one member or node that are simulated: by what they would explain, and by
#: how much they move
EXPLAINING, MOVING = 15, 6
#: beginnings that are distinguished, and windows that must lie on either side of one
BEGINNINGS, EITHER = 30, 5
#: prospects that are simulated at the size that they promise, rounds of that, and the farthest
#: that they may promise [prior sd]
FARTHER, ROUNDS, FARTHEST = 40, 4, 6.0
#: factor at which hardly anything is left
LOST = 0.03
#: modes of which the shape must have been measured at a point; kinds at points are fitted at so
#: many, and so many exchanges are simulated
SHAPES, AT_POINTS, EXCHANGES = 2, 5, 8


@dataclass(frozen=True)
class ModalProspect:
    """A hypothesis with what its trial values promise.

    Attributes:
        hypothesis: with an onset where one promises more.
        z: coordinates to start a fit from.
        score: approximate log evidence, beside what is found already.
        largest: d' of the largest of its trial values.
    """

    hypothesis: Hypothesis
    z: tuple[float, ...]
    score: float
    largest: float


def modal_hypotheses(trials: ModalTrials[ModalReadings]) -> list[Hypothesis]:
    """All hypotheses that natural frequencies and mode shapes can show, whatever the weather.

    Those at points are there where shapes of two modes were measured, since anything explains the
    one.
    """
    model = trials.model
    kinds = []
    for kind in Effect.vocabulary.values():
        of_structure = kind.structural and not kind.on_sensors
        if kind.overrides("change_values"):
            continue
        if of_structure or kind.on_modes or kind.at_points():
            kinds.append(kind)
    measured = Counter(point for look in trials.readings.looks for point in look.at.tolist())
    points = [name for number, name in enumerate(model.points) if measured[number] >= SHAPES]
    return hypotheses_of(kinds, model, (), list(trials.readings.contexts), points)


def prospects(
    likelihood: ModalLikelihood,
    candidates: Sequence[Hypothesis],
    found: Sequence[Hypothesis],
    z: FloatArray,
    progress: Callable[[float], None],
) -> list[ModalProspect]:
    """Candidates by what they promise beside what is found, the best first.

    Trial values are simulated: changes are finite, and the pairing is made anew.

    Args:
        likelihood: of the modes.
        candidates: hypotheses without onset.
        found: hypotheses that are in the model already.
        z: their coordinates.
        progress: called with the share that is done.
    """
    base = predicted(likelihood, found, z)
    if base is None:
        return []
    left = likelihood.residual(base)
    steps = _Steps.of(likelihood, left)
    worth = _worth_simulating(likelihood, candidates, left, steps)
    worth &= _worth_exchanging(likelihood, candidates, base)
    several = []
    for number, (candidate, simulated) in enumerate(zip(candidates, worth, strict=True)):
        progress(number / max(len(candidates), 1))
        if not simulated or any(candidate.same_place(one) for one in found):
            continue
        best: ModalProspect | None = None
        largest = 0.0
        for trial in product(*map(_trials, candidate.priors.values())):
            there = predicted(likelihood, [*found, candidate], np.array([*z, *trial]))
            if there is None:
                continue
            rest = likelihood.residual(there)
            change = left - rest
            largest = max(largest, float(np.linalg.norm(change)))
            prior = float(np.square(trial).sum())
            # What has no size has no part of it either.
            score = _score(left, rest, change, prior) if trial else _whole(left, rest)
            score += candidate.log_prior
            score -= likelihood.freedom(there)
            options = [ModalProspect(candidate, trial, score, largest)]
            moved = (there.log_f - base.log_f).mean(0)
            # What acts at points moves no frequency, though it may pair modes otherwise.
            later = None if candidate.at_points else steps.best(moved, prior)
            if later is not None:
                onset, gained = later
                late = candidate.beginning(onset)
                options.append(ModalProspect(late, trial, gained + late.log_prior, largest))
            for one in options:
                if best is None or one.score > best.score:
                    best = one
        if best is not None:
            several.append(
                ModalProspect(best.hypothesis, best.z, best.score, max(largest, best.largest))
            )
    several.sort(key=lambda one: -one.score)
    several = _without_many_at_points(several)
    nearest = [_farther(likelihood, one, (found, z), left) for one in several[:FARTHER]]
    progress(1.0)
    return sorted([*nearest, *several[FARTHER:]], key=lambda one: -one.score)


def _trials(prior: Prior) -> tuple[float, ...]:
    """Where a parameter is tried: of what may be lost altogether, there too.

    What is lost changes modes by far more than slopes at usual sizes promise.
    """
    may_be_lost = isinstance(prior, Factor) and prior.tail > 0.0
    return (*prior.trials, prior.z(LOST)) if may_be_lost else prior.trials


def _farther(
    likelihood: ModalLikelihood,
    one: ModalProspect,
    beside: tuple[Sequence[Hypothesis], FloatArray],
    left: FloatArray,
) -> ModalProspect:
    """The same at the size that its trial promises, where that is simulated to fit better.

    What changes much does so in its own way: the size is looked for in rounds, by secants.
    """
    found, z = beside
    for _ in range(ROUNDS):
        if len(one.z) != 1 or one.z[0] == 0.0:
            break
        there = predicted(likelihood, [*found, one.hypothesis], np.array([*z, *one.z]))
        if there is None:
            break
        change = left - likelihood.residual(there)
        size = float(change @ change)
        if size == 0.0:
            break
        times = float(change @ left) / size
        farther = float(np.clip(one.z[0] * times, -FARTHEST, FARTHEST))
        there = predicted(likelihood, [*found, one.hypothesis], np.array([*z, farther]))
        if there is None:
            break
        rest = likelihood.residual(there)
        score = _score(left, rest, left - rest, farther**2) + one.hypothesis.log_prior
        score -= likelihood.freedom(there)
        if score <= one.score:
            break
        one = replace(one, z=(farther,), score=score)
    return one


def _without_many_at_points(several: Sequence[ModalProspect]) -> list[ModalProspect]:
    """Prospects, the best first, of those at points the best few of each kind.

    There are as many points as there are accelerometers: what none of them explains must not crowd
    out what a structure may have.
    """
    count: Counter[str] = Counter()
    kept = []
    for one in several:
        count[one.hypothesis.name] += one.hypothesis.at_points
        if not one.hypothesis.at_points or count[one.hypothesis.name] <= AT_POINTS:
            kept.append(one)
    return kept


def _score(left: FloatArray, rest: FloatArray, change: FloatArray, prior: float) -> float:
    """Log evidence of the trial, or of a part of its change where that promises more."""
    size = float(change @ change)
    whole = _whole(left, rest) - 0.5 * prior
    if size == 0.0:
        return whole
    along = float(change @ left)
    part = 0.5 * along**2 / (size + prior) if along > 0 else -np.inf
    return max(whole, min(part, 0.5 * along**2 / size)) - 0.5 * float(np.log1p(size))


def _whole(left: FloatArray, rest: FloatArray) -> float:
    return 0.5 * float(left @ left - rest @ rest)


@dataclass(frozen=True)
class _Steps:
    """Changes that begin in a window, by products that are known beforehand.

    Attributes:
        onsets: times at which one may begin [s].
        along: of a step of one in ln f with what is left, float[beginnings, modes].
        squares: of such a step, float[beginnings, modes].
    """

    onsets: FloatArray
    along: FloatArray
    squares: FloatArray

    @classmethod
    def of(cls, likelihood: ModalLikelihood, left: FloatArray) -> "_Steps":
        time = likelihood.readings.time
        last = len(time) - EITHER
        places = np.unique(np.linspace(EITHER, last, BEGINNINGS).astype(int))
        places = places[(places >= EITHER) & (places <= last)]
        first = (np.arange(len(time)) >= places[:, None]).astype(float)
        along, squares, start = [], [], 0
        for mode, white in enumerate(likelihood.steps(first)):
            if likelihood.hidden[mode]:
                along.append(np.zeros(len(places)))
                squares.append(np.zeros(len(places)))
                continue
            own = left[start : start + white.shape[1]]
            start += white.shape[1]
            along.append(white @ own)
            squares.append((white**2).sum(1))
        return cls(time[places], np.array(along).T, np.array(squares).T)

    def best(self, moved: FloatArray, prior: float) -> tuple[float, float] | None:
        """The likeliest onset of a change of ln f, and what it promises; None where none does."""
        if not len(self.onsets):
            return None
        along, sizes = self.along @ moved, self.squares @ moved**2
        with np.errstate(invalid="ignore", divide="ignore"):
            scores = np.where(
                along > 0, 0.5 * along**2 / (sizes + prior) - 0.5 * np.log1p(sizes), -np.inf
            )
        best = int(np.argmax(scores))
        return (float(self.onsets[best]), float(scores[best])) if scores[best] > 0 else None


def _worth_simulating(
    likelihood: ModalLikelihood,
    candidates: Sequence[Hypothesis],
    left: FloatArray,
    steps: _Steps,
) -> BoolArray:
    """Which candidates are simulated: of the places of a kind at one member or node, some.

    Slopes, which cost nothing, rank them: those that would explain most of what is left, and those
    that move most. Between kinds, and for groups, they decide nothing. Close modes are any mixture,
    and have slopes of their own together alone: by these they are ranked as well.
    """
    trials = likelihood.trials
    by_stiffness, by_mass = trials.slopes()
    model = trials.model
    members = {name: number for number, name in enumerate(model.members)}
    nodes = {name: number for number, name in enumerate(model.nodes)}
    at_once = likelihood.of_steady(np.eye(len(likelihood.readings.modes)))
    modes = np.arange(len(likelihood.readings.modes))
    alike = np.eye(len(modes))
    for close in close_modes(modes, np.log([look.near for look in likelihood.readings.looks])):
        alike[np.ix_(close, close)] = 1.0 / len(close)
    mixed = bool((alike.diagonal() < 1.0).any())
    slopes: dict[str, list[tuple[int, FloatArray]]] = {}
    for number, one in enumerate(candidates):
        place = one.place
        if isinstance(place.get("member"), str):
            slope = by_stiffness[:, members[place["member"]]]
        elif one.name == "added_mass" and isinstance(place.get("node"), str):
            # What is usual there, and not what stands there: most nodes have no mass of their own.
            slope = one.priors["mass"].value(1.0) * by_mass[:, nodes[place["node"]]]
        elif isinstance(place.get("mass"), str) and (stated := model.masses[place["mass"]]).node:
            slope = (stated.mass or 0.0) * by_mass[:, nodes[stated.node]]
        else:
            continue
        slopes.setdefault(one.name, []).append((number, slope))
    chosen = np.ones(len(candidates), dtype=bool)
    for of_kind in slopes.values():
        numbers = np.array([number for number, _ in of_kind])
        single = np.array([slope for _, slope in of_kind])
        chosen[numbers] = False
        for several in (single, single @ alike) if mixed else (single,):
            changes = several @ at_once
            sizes = (changes**2).sum(1)
            scores = (changes @ left[: changes.shape[1]]) ** 2 / (1.0 + sizes)
            if len(steps.onsets):
                late = (steps.along @ several.T) ** 2 / (1.0 + steps.squares @ several.T**2)
                scores = np.maximum(scores, late.max(0))
            chosen[numbers[np.argsort(-scores, kind="stable")[:EXPLAINING]]] = True
            chosen[numbers[np.argsort(-sizes, kind="stable")[:MOVING]]] = True
    return chosen


def _worth_exchanging(
    likelihood: ModalLikelihood, candidates: Sequence[Hypothesis], base: Prediction
) -> BoolArray:
    """Of two points that may be exchanged, the pairs that would explain most; all others.

    An exchange leaves a shape as long as it is: MAC alone tells what it explains, where every mode
    keeps its pair.
    """
    points = {name: number for number, name in enumerate(likelihood.trials.model.points)}
    gain = np.zeros((len(points), len(points)))
    for mode, look in enumerate(likelihood.readings.looks):
        own = base.at_points[mode, look.at]
        length = float(own @ own)
        if likelihood.hidden[mode] or length == 0.0:
            continue
        along = float(own @ look.shape)
        moved = along - np.subtract.outer(own, own) * np.subtract.outer(look.shape, look.shape)
        worth = (moved**2 - along**2) / length / likelihood.shape_spread(mode) ** 2
        gain[np.ix_(look.at, look.at)] += worth
    pairs = {
        number: gain[tuple(points[name] for name in one.place["points"])]
        for number, one in enumerate(candidates)
        if "points" in one.place
    }
    best = sorted(pairs, key=lambda number: -pairs[number])[:EXCHANGES]
    return np.array(
        [number not in pairs or number in best for number in range(len(candidates))], bool
    )
