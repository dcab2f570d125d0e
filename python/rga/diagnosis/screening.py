"""Screening: which hypotheses are worth a fit, from their signatures alone."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.diagnosis.hypothesis import LATE, Hypothesis, Profile
from rga.diagnosis.problem import Problem
from rga.diagnosis.signatures import Block, chunks, signature, signatures
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

#: an onset leaves at least this share of a signature out of reach of constant scatter
OUT_OF_REACH = 0.08
#: prospects that are judged anew, by signatures about the simulation as it stands
JUDGED = 100
#: d' below which not even the largest of a hypothesis' trial values will ever be named
HOPELESS = 1.5
PROFILES: tuple[Profile, ...] = ("step", "ramp")


@dataclass(frozen=True)
class Prospect:
    """A hypothesis with what its signature promises.

    Attributes:
        number: of the hypothesis among the candidates.
        hypothesis: with an onset where one promises more.
        z: coordinates to start a fit from.
        score: approximate log evidence.
        largest: d' of the largest of the trial values, or of two prior deviations.
        trial: coordinates of the signature that promised it.
    """

    number: int
    hypothesis: Hypothesis
    z: tuple[float, ...]
    score: float
    largest: float
    trial: tuple[float, ...]


@dataclass(frozen=True)
class Judged:
    """Signatures with their sizes under the covariance of the first screening.

    Attributes:
        block: the signatures.
        size: x' C^-1 x, float[k].
        by_row: of every row, its part of x' W' W x, float[k, rows].
    """

    block: Block
    size: FloatArray
    by_row: FloatArray


class Screening:
    """The signatures of all candidates about one simulation.

    Generalised least squares under the whole covariance gives the likelihood that the best
    amplitude of a signature gains; the prior takes off what the freedom costs. Working out
    signatures and their sizes is most of the work, and both change little when causes are added to
    the simulation. So they are kept: about another simulation they rank the candidates, and the
    best are judged anew.

    Args:
        problem: gives residual and covariance.
        simulator: the simulation to which the candidates are added.
        candidates: hypotheses without onset.
        progress: told the share that is done.

    Attributes:
        first: prospects about that simulation, the best first, each candidate once.
    """

    def __init__(
        self,
        problem: Problem,
        simulator: Simulator,
        candidates: Sequence[Hypothesis],
        progress: Callable[[float], None] = lambda done: None,
    ) -> None:
        data, covariance = problem.data, problem.covariance
        self._judged: list[Judged] = []
        done = 0
        for block in chunks(signatures(data, data.about(simulator), candidates)):
            reduced = covariance.reduce(block.values, block.channels)
            size = np.maximum(covariance.squares(reduced), 0.0)
            by_row = (reduced.white**2).sum(1).astype(np.float32)
            light = replace(block, values=block.values.astype(np.float32))
            self._judged.append(Judged(light, size, by_row))
            done = max(done, *(number + 1 for number, _, _ in block.members))
            progress(done / len(candidates))
        self.first = self.again(problem, simulator, ())
        hopeless = {one.number for one in self.first if one.largest < HOPELESS}
        self._judged = [_without(one, hopeless) for one in self._judged]

    def again(
        self,
        problem: Problem,
        simulator: Simulator,
        taken: Collection[Hypothesis],
        beginning: Hypothesis | None = None,
    ) -> list[Prospect]:
        """Prospects about another simulation of the same record, the best first.

        Args:
            problem: gives residual and covariance.
            simulator: the simulation to which the candidates are added.
            taken: hypotheses that are left out.
            beginning: a candidate acts always, or begins as this one does; None: candidates may
                begin at any time.
        """
        data = problem.data
        base = data.predict(simulator)
        weighted = problem.covariance.inverse_times(problem.residual(base))
        best: dict[tuple[int, Profile | None], Prospect] = {}
        largest: dict[int, float] = {}
        onsets = not data.belief.passing
        for judged in self._judged:
            for one in _promises(judged, weighted, data.time, onsets, beginning):
                # What an onset promises is rough, and must not hide another way to begin.
                late = one.hypothesis.onset is not None
                key = one.number, one.hypothesis.profile if late else None
                best[key] = max(best.get(key, one), one, key=lambda each: each.score)
                largest[one.number] = max(largest.get(one.number, 0.0), one.largest)
        kept = [
            replace(one, largest=largest[one.number])
            for one in best.values()
            if not any(one.hypothesis.same_place(other) for other in taken)
        ]
        kept.sort(key=_rank)
        kept = [*judged_anew(problem, simulator, kept[:JUDGED], weighted), *kept[JUDGED:]]
        first: dict[int, Prospect] = {}
        for one in sorted(kept, key=_rank):
            first.setdefault(one.number, one)
        return list(first.values())


def judged_anew(
    problem: Problem,
    simulator: Simulator,
    prospects: Sequence[Prospect],
    weighted: FloatArray,
) -> list[Prospect]:
    """Prospects by signatures about a simulation, each at the trial that promised it.

    Args:
        problem: gives the covariance.
        simulator: the simulation to which the hypotheses are added.
        prospects: the hypotheses.
        weighted: C^-1 of the residual, float[sensors, rows].
    """
    data, covariance = problem.data, problem.covariance
    about = data.about(simulator)
    largest = {one.number: one.largest for one in prospects}
    several = (signature(data, about, one.number, one.hypothesis, one.trial) for one in prospects)
    found = []
    for block in chunks(one for one in several if one is not None):
        size = covariance.squares(covariance.reduce(block.values, block.channels))
        sums = block.along(weighted).sum(1)
        prior = np.array([hypothesis.log_prior for _, hypothesis, _ in block.members])
        score, start = _scored(block, sums, np.maximum(size, 0.0), prior)
        found += [
            Prospect(number, hypothesis, _coordinates(z, s), float(points), largest[number], z)
            for (number, hypothesis, z), points, s in zip(block.members, score, start, strict=True)
        ]
    return found


def _promises(
    judged: Judged,
    weighted: FloatArray,
    time: FloatArray,
    onsets: bool,
    beginning: Hypothesis | None,
) -> list[Prospect]:
    """The prospects of every signature: from the start, and from its likeliest moment on."""
    block = judged.block
    along = block.along(weighted)
    members = block.members
    largest = np.sqrt(judged.size)
    straight = block.straight & block.free
    largest[straight] *= 2 / np.abs(block.z[straight, 0])
    before = np.array([hypothesis.log_prior for _, hypothesis, _ in members])
    later = before + LATE
    options: list[tuple[FloatArray, FloatArray]] = []
    moments: list[tuple[FloatArray | None, Profile]] = []
    white = judged.by_row.astype(float)
    share = judged.size / np.maximum(white.sum(1), 1e-300)
    options.append(_scored(block, along.sum(1), judged.size, before))
    moments.append((None, "step"))
    if beginning is not None and beginning.onset is not None:
        weight = beginning.effect([0.0] * len(beginning.priors)).weight(time)
        options.append(_scored(block, along @ weight, share * (white @ weight**2), later))
        moments.append((np.full(len(members), beginning.onset), beginning.profile))
    if beginning is None and onsets:
        margin = max(2, len(time) // 50)
        inner = slice(margin, len(time) - margin)
        share = np.maximum(share, OUT_OF_REACH)[:, None]
        every = np.arange(len(members))
        for profile in PROFILES:
            weight = _weights(time, profile)[inner]
            sums, sizes = along @ weight.T, share * (white @ (weight**2).T) + 1e-300
            row = np.argmax(sums**2 / sizes, axis=1)
            options.append(_scored(block, sums[every, row], sizes[every, row], later))
            moments.append((time[inner][row], profile))
    found = []
    for k, (number, hypothesis, z) in enumerate(members):
        for (moment, profile), (score, start) in zip(moments, options, strict=True):
            one = hypothesis
            if moment is not None:
                end = None if beginning is None else beginning.end
                one = hypothesis.beginning(float(moment[k]), profile, end)
            start_z = _coordinates(z, start[k])
            found.append(Prospect(number, one, start_z, float(score[k]), float(largest[k]), z))
    return found


def _weights(time: FloatArray, profile: Profile) -> FloatArray:
    """Shares of an effect that begins at each row, float[beginnings, rows]."""
    later = time >= time[:, None]
    if profile == "step":
        return later.astype(float)
    left = np.maximum(time[-1] - time, 1e-12)
    return np.where(later, (time - time[:, None]) / left[:, None], 0.0)


def _scored(
    block: Block, along: FloatArray, size: FloatArray, prior: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Scores of signatures with x' C^-1 r = along and x' C^-1 x = size, and z of their best.

    The latter is float[k], the value of all coordinates, or NaN: those of the trial.
    """
    first = np.where(block.free & block.straight, block.z[:, 0], 1.0)
    # A straight line in z: the evidence is exact.
    per_z = size / first**2
    straight = (along / first) ** 2 / (1 + per_z) / 2 - np.log1p(per_z) / 2
    # A curve: the amplitude may differ a little from that of the trial, not in sign.
    amplitude = np.clip(along / np.maximum(size, 1e-300), 0.0, 3.0)
    curve = amplitude * along - amplitude**2 * size / 2 - (block.z**2).sum(1) / 2
    fixed = along - size / 2
    score = np.where(block.free, np.where(block.straight, straight, curve), fixed)
    start = np.where(block.free & block.straight, along / first / (1 + per_z), np.nan)
    return np.where(size > 0, score + prior, -np.inf), start


def _coordinates(z: tuple[float, ...], start: float) -> tuple[float, ...]:
    return z if np.isnan(start) else (float(start),) * len(z)


def _rank(one: Prospect) -> tuple[float, int]:
    return -one.score, one.number


def _without(judged: Judged, hopeless: set[int]) -> Judged:
    kept = np.array([number not in hopeless for number, _, _ in judged.block.members], dtype=bool)
    block = judged.block
    few = replace(
        block,
        members=[one for one, keep in zip(block.members, kept, strict=True) if keep],
        channels=None if block.channels is None else block.channels[kept],
        values=block.values[kept],
        z=block.z[kept],
        straight=block.straight[kept],
        free=block.free[kept],
    )
    return Judged(few, judged.size[kept], judged.by_row[kept])
