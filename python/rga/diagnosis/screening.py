"""Screening: which hypotheses are worth a fit, from their signatures alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from rga.diagnosis.hypothesis import Hypothesis
from rga.diagnosis.problem import Problem
from rga.errors import InputError
from rga.model.parameter import FloatArray, Normal
from rga.simulation import Simulator

CHUNK = 128
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
    response = data.respond(simulator)
    base = data.read(simulator, response)
    residual = problem.residual(base)
    weighted = problem.covariance.inverse_times(residual)
    onsets = onsets and not data.belief.passing
    best: dict[int, Prospect] = {}
    waiting: list[tuple[int, tuple[float, ...], float | None, FloatArray]] = []

    def judge() -> None:
        if not waiting:
            return
        columns = np.stack([column for *_, column in waiting], axis=2)
        sizes = problem.covariance.squares(problem.covariance.reduce(columns))
        for (number, z, onset, column), size in zip(waiting, sizes, strict=True):
            along = float((column * weighted).sum())
            prospect = _prospect(candidates[number].beginning(onset), z, along, float(size))
            if number in best:
                better = max(best[number], prospect, key=lambda one: one.score)
                largest = max(best[number].largest, prospect.largest)
                prospect = replace(better, largest=largest)
            best[number] = prospect
        waiting.clear()

    for number, candidate in enumerate(candidates):
        for z in product(*(prior.trials for prior in candidate.priors.values())):
            try:
                trial = simulator.extended({"trial": candidate.effect(z)})
                alone = candidate.kind.on_sensors
                changed = data.read(trial, response) if alone else data.predict(trial)
            except InputError:
                continue
            signature = np.where(data.observed, changed - base, 0.0)
            waiting.append((number, z, candidate.onset, signature))
            if onsets and (row := _likely_onset(problem, signature, weighted, candidate)):
                later = signature.copy()
                later[:row] = 0.0
                waiting.append((number, z, float(data.time[row]), later))
        if len(waiting) >= CHUNK:
            judge()
            progress((number + 1) / len(candidates))
    judge()
    return sorted(best.values(), key=lambda prospect: -prospect.score)


def _likely_onset(
    problem: Problem, signature: FloatArray, weighted: FloatArray, candidate: Hypothesis
) -> int:
    """Row at which an onset of the signature promises most; 0 where none can pay.

    Sums from the last row backwards give x' C^-1 r for every onset at once, and bound x' C^-1 x.
    """
    rows = problem.covariance.rows
    white = signature.copy()
    white[1:] -= rows.memory[1:] * signature[:-1]
    white *= rows.weight
    along = np.cumsum((signature * weighted).sum(1)[::-1])[::-1]
    size = np.cumsum((white**2).sum(1)[::-1])[::-1]
    margin = max(2, len(along) // 50)
    inner = slice(margin, len(along) - margin)
    gain = along[inner] ** 2 / np.maximum(size[inner], 1e-300)
    if not len(gain):
        return 0
    row = int(np.argmax(gain)) + margin
    promise = gain[row - margin] / (2 * OUT_OF_REACH) + candidate.beginning(1.0).log_prior
    return row if promise > 0 else 0


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
