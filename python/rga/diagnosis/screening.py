"""Screening: which hypotheses are worth a fit, from their signatures alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from rga.diagnosis.hypothesis import Hypothesis
from rga.diagnosis.problem import Problem
from rga.errors import InputError
from rga.model.parameter import FloatArray, Normal
from rga.model.structure import IntArray
from rga.simulation import Simulator

#: channels that a signature may name; one that touches more is written on all
FEW = 2
#: numbers in the signatures that are judged together
CHUNK = 1 << 19
#: an onset leaves at least this share of a signature out of reach of constant scatter
OUT_OF_REACH = 0.08


@dataclass(frozen=True)
class Prospect:
    """A hypothesis with what its signature promises.

    Attributes:
        hypothesis: with an onset where one promises more.
        z: coordinates to start a fit from.
        score: approximate log evidence.
        largest: d' of the largest of the trial values, or of two prior deviations.
    """

    hypothesis: Hypothesis
    z: tuple[float, ...]
    score: float
    largest: float


@dataclass(frozen=True)
class Signature:
    """What a hypothesis changes at trial values of its parameters.

    Attributes:
        number: of the hypothesis among the candidates.
        hypothesis: with its onset.
        z: coordinates of the trial.
        channels: those that it changes, int[channels]; None: all.
        values: float[channels, rows].
    """

    number: int
    hypothesis: Hypothesis
    z: tuple[float, ...]
    channels: IntArray | None
    values: FloatArray


def screen(
    problem: Problem,
    simulator: Simulator,
    candidates: Sequence[Hypothesis],
    *,
    onsets: bool = True,
    progress: Callable[[float], None] = lambda done: None,
) -> list[Prospect]:
    """Prospects of all candidates, the best first, each candidate once.

    The signature of a candidate is the change of the simulation that it makes at trial values of
    its parameters. Generalised least squares under the whole covariance gives the likelihood that
    its best amplitude gains; the prior takes off what the freedom costs.

    Args:
        problem: gives residual and covariance.
        simulator: the simulation to which the candidates are added.
        candidates: hypotheses without onset.
        onsets: whether to try onsets too, at moments spread over the record; not where time and
            the place of a load are one.
        progress: told the share that is done.
    """
    data = problem.data
    about = data.about(simulator)
    base = data.read(simulator, about.response)
    weighted = problem.covariance.inverse_times(problem.residual(base))
    onsets = onsets and not data.belief.passing
    best: dict[int, Prospect] = {}
    waiting: dict[int, list[Signature]] = {}

    def judge(several: list[Signature]) -> None:
        for prospect, one in _judged(problem, weighted, several, onsets):
            known = best.get(one.number)
            if known is not None:
                better = max(known, prospect, key=lambda each: each.score)
                prospect = replace(better, largest=max(known.largest, prospect.largest))
            best[one.number] = prospect
        several.clear()

    for number, candidate in enumerate(candidates):
        for z in product(*(prior.trials for prior in candidate.priors.values())):
            try:
                touched, change = data.change(about, candidate.effect(z))
            except InputError:
                continue
            if len(touched) <= FEW:
                one = Signature(number, candidate, z, touched, change.T)
            else:
                values = np.zeros((len(data.sensors), len(change)))
                values[touched] = change.T
                one = Signature(number, candidate, z, None, values)
            together = waiting.setdefault(len(one.values), [])
            together.append(one)
            if len(together) * one.values.size > CHUNK:
                judge(together)
                progress((number + 1) / len(candidates))
    for together in waiting.values():
        judge(together)
    return [best[number] for number in sorted(best, key=lambda k: (-best[k].score, k))]


def _judged(
    problem: Problem, weighted: FloatArray, several: Sequence[Signature], onsets: bool
) -> list[tuple[Prospect, Signature]]:
    """Prospects of signatures on the same number of channels, and of onsets that may pay.

    Args:
        weighted: C^-1 of the residual, float[sensors, rows].
    """
    if not several:
        return []
    covariance = problem.covariance
    columns = np.stack([one.values for one in several])
    channels = None
    if several[0].channels is not None:
        channels = np.stack([one.channels for one in several if one.channels is not None])
    reduced = covariance.reduce(columns, channels)
    along = columns * (weighted if channels is None else weighted[channels])
    sizes = covariance.squares(reduced)
    judged = [
        (_prospect(one.hypothesis, one.z, float(sum_), float(size)), one)
        for one, sum_, size in zip(several, along.sum((1, 2)), sizes, strict=True)
    ]
    if onsets:
        time = problem.data.time
        likely = _likely_onsets(along.sum(1), (reduced.white**2).sum(1), several)
        later = [
            _beginning(one, row, time) for one, row in zip(several, likely, strict=True) if row
        ]
        judged += _judged(problem, weighted, later, onsets=False)
    return judged


def _beginning(one: Signature, row: int, time: FloatArray) -> Signature:
    values = one.values.copy()
    values[:, :row] = 0.0
    return replace(one, hypothesis=one.hypothesis.beginning(float(time[row])), values=values)


def _likely_onsets(along: FloatArray, size: FloatArray, several: Sequence[Signature]) -> list[int]:
    """Row at which an onset of each signature promises most; 0 where none can pay.

    Sums from the last row backwards give x' C^-1 r for every onset at once, and bound x' C^-1 x.

    Args:
        along, size: x' C^-1 r and x' W' W x of every row, float[signatures, rows].
    """
    rows = along.shape[1]
    margin = max(2, rows // 50)
    if rows <= 2 * margin:
        return [0] * len(several)
    inner = slice(margin, rows - margin)
    along = np.cumsum(along[:, ::-1], axis=1)[:, ::-1][:, inner]
    size = np.cumsum(size[:, ::-1], axis=1)[:, ::-1][:, inner]
    gain = along**2 / np.maximum(size, 1e-300)
    promise = gain.max(1) / (2 * OUT_OF_REACH)
    prior = [one.hypothesis.beginning(1.0).log_prior for one in several]
    return [int(row) for row in np.where(promise + prior > 0, gain.argmax(1) + margin, 0)]


def _prospect(hypothesis: Hypothesis, z: tuple[float, ...], along: float, size: float) -> Prospect:
    """Score of a signature with x' C^-1 r = along and x' C^-1 x = size."""
    prior = hypothesis.log_prior
    size = max(size, 0.0)
    largest = float(np.sqrt(size))
    if size == 0:
        return Prospect(hypothesis, z, -np.inf, 0.0)
    if not z:
        return Prospect(hypothesis, z, along - size / 2 + prior, largest)
    if all(isinstance(one, Normal) for one in hypothesis.priors.values()):
        # A straight line in z: the evidence is exact.
        per_z = size / z[0] ** 2
        gain = (along / z[0]) ** 2 / (1 + per_z) / 2 - np.log1p(per_z) / 2
        best = along / z[0] / (1 + per_z)
        return Prospect(hypothesis, tuple([best] * len(z)), gain + prior, 2 * largest / abs(z[0]))
    # A curve: the amplitude may differ a little from that of the trial, not in sign.
    amplitude = float(np.clip(along / size, 0.0, 3.0))
    gain = amplitude * along - amplitude**2 * size / 2
    return Prospect(hypothesis, z, gain - 0.5 * float(np.dot(z, z)) + prior, largest)
