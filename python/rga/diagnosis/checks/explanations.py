"""Explanations compared: alone and together, on the channels fitted and on channels left out.

Free gains on every channel fit better than most causes and explain nothing. What explains must
also hold for channels that were not fitted: whole groups of them are left out in turn.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.diagnosis.search.laplace import Fit, fit, refit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.screening import Prospect, Screening
from rga.diagnosis.search.stepwise import Found, evidence
from rga.model.schema import Model
from rga.simulation import Simulator

#: kinds that are tried alone, by whether causes were found: more is dear, and not read
KINDS = {True: 14, False: 5}
#: what is tried in the place of a cause, and beside all causes: for the same reason
PARTNERS = 4
#: log evidence below which a fit has gone astray: no effect at all is this much likelier
POOR = -15.0


class OnUnseen(NamedTuple):
    """How an explanation predicts channels that it was not fitted to.

    Attributes:
        gap: mean squared residual over the variance of the prediction; nan where none is left out.
        log_odds: by which these channels speak for it and against no effect at all, given the
            others: a prediction that says little is not wrong, and earns little.
    """

    gap: float
    log_odds: float


@dataclass(frozen=True)
class Tried:
    """An explanation as it came out.

    Attributes:
        fit: its hypotheses with their parameters; None for a free gain on every channel.
        gap: mean squared residual over variance on the fitted rows.
        unseen: the same on groups of channels that were left out in turn.
    """

    fit: Fit | None
    gap: float
    unseen: OnUnseen


def sensor_groups(model: Model, sensors: Sequence[str]) -> dict[str, list[str]]:
    """Groups of like sensors: their own group, else kind and first group of the member."""
    groups: dict[str, list[str]] = {}
    for name in sensors:
        sensor = model.sensors[name]
        of = model.members[sensor.member].groups if sensor.member is not None else []
        word = sensor.groups[0] if sensor.groups else " ".join([sensor.kind, *of[:1]])
        groups.setdefault(word, []).append(name)
    return groups


def groups_left_out(model: Model, sensors: Sequence[str]) -> list[list[str]]:
    """Groups of like sensors that can be left out in turn: none where they all are one group."""
    groups = list(sensor_groups(model, sensors).values())
    return groups if len(groups) > 1 else []


def compare(
    found: Found, prospects: Sequence[Prospect], progress: Callable[[float], None]
) -> list[Tried]:
    """The best of every kind alone, the causes found, and the causes with others beside them.

    Args:
        found: the search's end.
        prospects: of the first screening, the best first.
        progress: called with the share that is done.
    """
    problem, base = found.problem, found.base
    causes = found.fit
    chosen: list[tuple[list[Hypothesis], list[float]]] = [([], [])]
    best = _best_of_kinds(prospects)[: KINDS[bool(causes.hypotheses)]]
    chosen += [([p.hypothesis], list(p.z)) for p in best]
    for number, cause in enumerate(causes.hypotheses):
        z = causes.z[causes.slices()[number]]
        chosen.append(([cause], list(z)))
        chosen += [
            ([alternative.hypothesis], list(alternative.fit.z[alternative.fit.slices()[-1]]))
            for alternative in found.alternatives[number][:PARTNERS]
        ]
    if causes.hypotheses:
        chosen.append((list(causes.hypotheses), list(causes.z)))
        taken = {one.kind for one in causes.hypotheses}
        partners = [p for p in best if p.hypothesis.kind not in taken]
        chosen += [
            ([*causes.hypotheses, p.hypothesis], [*causes.z, *p.z]) for p in partners[:PARTNERS]
        ]
        chosen += _off_axis(problem, base, best)
    fits = []
    for number, (together, start) in enumerate(_each_once(chosen)):
        first = together[: len(causes.hypotheses)]
        more = len(together) > len(first) and first == list(causes.hypotheses)
        one = _in_the_place_of_a_cause(found, together) or fit(
            problem, base, together, start, beside=causes if more else None
        )
        if len(together) == 1 and one.log_evidence < POOR:
            # The signature of a kind that slips or opens misleads: begin from every trial value.
            trials = product(*(prior.trials for prior in together[0].priors.values()))
            one = max((fit(problem, base, together, z) for z in trials), key=evidence)
        fits.append(one)
        progress((number + 1) / (len(chosen) + 1))
    unseen = on_unseen(problem, base, fits)
    progress(1.0)
    tried = [
        Tried(one, _gap(problem, one.simulated), own) for one, own in zip(fits, unseen, strict=True)
    ]
    gained = _free_gains(problem, tried[0])
    return [*tried, Tried(None, _gap(problem, gained), tried[0].unseen)]


def _in_the_place_of_a_cause(found: Found, together: Sequence[Hypothesis]) -> Fit | None:
    """The fit that the search has made of a hypothesis alone, the sole cause left out."""
    if len(together) != 1:
        return None
    for ranked in found.alternatives:
        for one in ranked:
            known = one.fit.exact and one.fit.problem is found.problem
            if known and _same(one.fit.hypotheses, together):
                return one.fit
    return None


def _same(one: Sequence[Hypothesis], other: Sequence[Hypothesis]) -> bool:
    """Whether two explanations are of the same places and beginnings."""
    return len(one) == len(other) and all(
        a.same_place(b) and (a.onset, a.profile, a.end) == (b.onset, b.profile, b.end)
        for a, b in zip(one, other, strict=True)
    )


def hiding(problem: Problem, sensors: Sequence[str]) -> Problem:
    """The same problem with some channels unseen; it is kept."""
    key = tuple(sensors)
    if key not in problem.hiding:
        problem.hiding[key] = _hiding(problem, key)
    return problem.hiding[key]


def _hiding(problem: Problem, sensors: Sequence[str]) -> Problem:
    data = problem.data.without(set(sensors))
    hidden = np.array([data.sensors.index(name) for name in sensors], dtype=np.int64)
    return replace(problem, data=data, covariance=problem.covariance.without(hidden))


def variance(problem: Problem) -> FloatArray:
    """Variance of each reading about a faultless simulation, float[rows, sensors].

    Noise, that of the logger's zero too, and the errors of the contexts that were measured.
    """
    belief = problem.data.belief
    measured = [k for k, name in enumerate(belief.spread) if name not in belief.latent]
    jacobian = problem.covariance.rows.context_jacobian[:, :, measured]
    contexts = (jacobian**2) @ problem.noise.context_sigma[measured] ** 2
    return np.asarray(problem.noise.deviation**2 + problem.zero_variance + contexts)


def left_open(fit: Fit, columns: Sequence[int]) -> FloatArray:
    """Variance of a simulation by what is left open of its parameters.

    Args:
        fit: it.
        columns: sensors.

    Returns:
        float[rows, columns].
    """
    signatures = fit.signatures[:, list(columns)]
    if not len(signatures):
        return np.zeros((len(fit.simulated), len(columns)))
    moved = np.linalg.solve(fit.information, signatures.reshape(len(signatures), -1))
    return np.asarray((signatures * moved.reshape(signatures.shape)).sum(0).T)


def _off_axis(
    problem: Problem, base: Simulator, best: Sequence[Prospect]
) -> list[tuple[list[Hypothesis], list[float]]]:
    """Stiff joints, with the gauge off the axis of its member that then explains most."""
    stiff = [p for p in best if p.hypothesis.name == "joint_rigidity"]
    found = []
    for prospect in stiff:
        stiffened = base.extended({"stiff joints": prospect.hypothesis.effect(prospect.z)})
        gauges = [
            one
            for one in hypotheses(stiffened.model, problem.data.sensors, ())
            if one.name == "gauge_position"
        ]
        gauge = Screening(problem, stiffened, gauges).first[:1]
        found += [([prospect.hypothesis, one.hypothesis], [*prospect.z, *one.z]) for one in gauge]
    return found


def _gap(problem: Problem, simulated: FloatArray) -> float:
    left = problem.data.readings - problem.with_contexts(simulated)
    square = left**2 / variance(problem)
    return float(square[problem.data.observed].mean())


def on_unseen(
    problem: Problem,
    base: Simulator,
    fits: Sequence[Fit],
    groups: Iterable[Sequence[str]] | None = None,
) -> list[OnUnseen]:
    """How explanations predict groups of channels, each left out of the fit in turn.

    Args:
        problem: with all channels.
        base: the simulator without causes.
        fits: the explanations, as fitted to all channels.
        groups: those left out; None: all of them, of which there must be two.
    """
    if groups is None:
        groups = groups_left_out(base.model, problem.data.sensors)
    squares: list[list[FloatArray]] = [[] for _ in fits]
    odds = np.zeros(len(fits))
    for names in groups:
        part = hiding(problem, names)
        columns = [problem.data.sensors.index(name) for name in names]
        seen, readings = problem.data.observed[:, columns], problem.data.readings[:, columns]
        spread = unseen_variance(problem, part, columns)
        for number, one in enumerate(refit(part, base, fits)):
            square = (readings - problem.with_contexts(one.simulated, part)[:, columns]) ** 2
            squares[number].append((square / (spread + left_open(one, columns)))[seen])
            odds[number] += fits[number].log_evidence - one.log_evidence
    return [
        OnUnseen(float(np.concatenate(own).mean()) if own else np.nan, float(each))
        for own, each in zip(squares, odds, strict=True)
    ]


def unseen_variance(problem: Problem, part: Problem, columns: Sequence[int]) -> FloatArray:
    """Variance of channels about a faultless simulation, by what others leave open of contexts.

    Args:
        problem: with all channels.
        part: the same with these channels unseen.
        columns: of the channels.

    Returns:
        float[rows, columns].
    """
    return (variance(problem) + problem.unsure_contexts(part))[:, columns]


def _free_gains(problem: Problem, nothing: Tried) -> FloatArray:
    assert nothing.fit is not None  # the explanation by nothing is a fit of no hypotheses
    simulated = nothing.fit.simulated
    seen = problem.data.observed
    target = np.where(seen, problem.data.readings - problem.shift, 0.0)
    own = np.where(seen, simulated, 0.0)
    gains = (target * own).sum(0) / np.maximum((own**2).sum(0), 1e-300)
    return np.asarray(simulated * gains)


def _best_of_kinds(prospects: Sequence[Prospect]) -> list[Prospect]:
    best: dict[str, Prospect] = {}
    for prospect in prospects:
        if prospect.hypothesis.onset is None and np.isfinite(prospect.score):
            best.setdefault(prospect.hypothesis.name, prospect)
    return list(best.values())


def _each_once(
    chosen: Sequence[tuple[list[Hypothesis], list[float]]],
) -> list[tuple[list[Hypothesis], list[float]]]:
    kept: list[tuple[list[Hypothesis], list[float]]] = []
    for together, z in chosen:
        if not any(_same(others, together) for others, _ in kept):
            kept.append((together, z))
    return kept
