"""Screening: which hypotheses are worth a fit, from their signatures alone."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.noise.covariance import Covariance
from rga.diagnosis.search.hypothesis import LATE, Hypothesis, Profile
from rga.diagnosis.search.late_shares import EveryBeginning, LateShares, OneBeginning
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.scores import gained, scored
from rga.diagnosis.search.signatures import Block, chunks, signature, signatures
from rga.simulation import Simulator

#: prospects that are judged anew, by signatures about the simulation as it stands
JUDGED = 100
#: prospects behind these that are ranked with them, and behind all of them those of every kind:
#: the ones that are judged may fall back
BEHIND, OF_KIND = 50, 3
#: d' below which not even the largest of a hypothesis' trial values will ever be named
HOPELESS = 1.5
#: how an effect may begin, in the order in which they are tried
PROFILES: tuple[Profile, ...] = ("step", "ramp")


@dataclass(frozen=True)
class Prospect:
    """A hypothesis with what its signature promises.

    Attributes:
        number: of the hypothesis among the candidates.
        hypothesis: with an onset where one promises more.
        z: coordinates to start a fit from.
        score: approximate log evidence.
        largest: d' of the largest of the trial values, or of two prior deviations, of an effect
            that always acts.
        largest_late: the same of one that begins after the logger's zero, before any other row.
        trial: coordinates of the signature that promised it.
    """

    number: int
    hypothesis: Hypothesis
    z: tuple[float, ...]
    score: float
    largest: float
    largest_late: float
    trial: tuple[float, ...]


@dataclass(frozen=True)
class RankedSignatures:
    """Signatures with their sizes under the covariance of the first screening.

    The logger's zero takes a constant off each of them. One that begins after the zero keeps it:
    it is its shares of the whole. One that has a mean share m in the zero rows is m times the
    signature, and its shares less m of the whole.

    Attributes:
        block: the signatures.
        size: x' C^-1 x, float[k].
        whole_size: the same with what the zero takes off, float[k].
        by_row: of every row, its part of x' W' W x with what the zero takes off, float[k, rows].
        across: its part of x' W' W y, x without and y with it, float[k, rows]; None where they are
            the same.
        white: x' W' W x, float[k].
        open_share: share of y' W' W y that errors of the contexts leave, float[k].
    """

    block: Block
    size: FloatArray
    whole_size: FloatArray
    by_row: NDArray[np.float32]
    across: NDArray[np.float32] | None
    white: FloatArray
    open_share: FloatArray

    @classmethod
    def of(cls, block: Block, covariance: Covariance) -> "RankedSignatures":
        """Signatures, judged by a covariance."""
        reduced = whole = covariance.reduce(block.values, block.channels)
        size = whole_size = np.maximum(covariance.squares(reduced), 0.0)
        across = None
        if block.zero.any():
            whole = covariance.shifted(reduced, block.zero, block.channels)
            whole_size = np.maximum(covariance.squares(whole), 0.0)
            across = (reduced.white * whole.white).sum(1).astype(np.float32)
        by_row = (whole.white**2).sum(1)
        by_contexts = (whole.context**2).sum(0) / np.maximum(by_row.sum(1), 1e-300)
        return cls(
            block=replace(block, values=block.values.astype(np.float32)),
            size=size,
            whole_size=whole_size,
            by_row=by_row.astype(np.float32),
            across=across,
            white=np.einsum("kct,kct->k", reduced.white, reduced.white),
            open_share=1.0 - by_contexts,
        )

    def begun(
        self, along: FloatArray, weights: LateShares, at_zero: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Sums with a residual and sizes of the signatures that begin late.

        Args:
            along: products with the residual, as `Block.along` and `Block.zero_along` have them,
                float[2, k, rows].
            weights: shares of the effect in the rows.
            at_zero: mean of that share over the zero rows, float[beginnings].

        Returns:
            float[k, beginnings] each.
        """
        by_row = self.by_row.astype(float)
        whole, all_rows = along.sum(0), by_row.sum(1)[:, None]
        untouched = along[0].sum(1) - whole.sum(1)
        sums = weights.sums(whole) + untouched[:, None] * at_zero
        sizes = weights.squares(by_row)
        if at_zero.any():
            across = self.by_row if self.across is None else self.across
            crossed = across.astype(float)
            sizes += 2 * at_zero * (weights.sums(crossed) - weights.sums(by_row))
            constant = all_rows - 2 * crossed.sum(1)[:, None] + self.white[:, None]
            sizes += at_zero**2 * constant
        sizes = np.maximum(sizes, 0.0)
        # Scatter is the same in all rows. Of some rows it takes that part of what it takes of all.
        total = np.maximum(all_rows, 1e-300)
        taken = self.open_share[:, None] - self.whole_size[:, None] / total
        shares = self.open_share[:, None] - np.minimum(sizes / total, 1.0) * taken
        return sums, sizes * np.maximum(shares, 0.0)

    def largest(self, onsets: bool) -> FloatArray:
        """d' of the trial values, or of two prior deviations where a response is straight.

        Args:
            onsets: whether effects may begin late.

        Returns:
            float[2, k]: of effects that always act, and of those that begin after the zero.
        """
        block = self.block
        found = np.sqrt([self.size, self.whole_size if onsets else self.size])
        linear = block.linear & block.free
        found[:, linear] *= 2 / np.abs(block.z[linear, 0])
        return found

    def of_numbers(self, numbers: Collection[int]) -> "RankedSignatures":
        """The signatures of some of the candidates."""
        which = np.array([number in numbers for number, _, _ in self.block.members], dtype=bool)
        if which.all():
            return self
        return RankedSignatures(
            self.block.kept(which),
            self.size[which],
            self.whole_size[which],
            self.by_row[which],
            None if self.across is None else self.across[which],
            self.white[which],
            self.open_share[which],
        )


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
        progress: called with the share that is done.

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
        self._about = problem, simulator
        self._judged: list[RankedSignatures] = []
        done = 0
        for block in chunks(signatures(data, data.about(simulator), candidates)):
            self._judged.append(RankedSignatures.of(block, covariance))
            done = max(done, *(number + 1 for number, _, _ in block.members))
            progress(done / len(candidates))
        self._largest: dict[int, tuple[float, float]] = {}
        for judged in self._judged:
            sizes = judged.largest(onsets=not data.belief.passing).T.tolist()
            for (number, *_), (always, late) in zip(judged.block.members, sizes, strict=True):
                before = self._largest.get(number, (0.0, 0.0))
                self._largest[number] = max(before[0], always), max(before[1], late)
        self.first = self._ranked(problem, simulator, (), None, inf)
        hopeful = {
            one.number for one in self.first if max(one.largest, one.largest_late) >= HOPELESS
        }
        self._judged = [one.of_numbers(hopeful) for one in self._judged]

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

        Returns:
            Those that were judged anew, some behind them, and behind these the best of every kind.
        """
        return self._ranked(problem, simulator, taken, beginning, JUDGED + BEHIND)

    def _ranked(
        self,
        problem: Problem,
        simulator: Simulator,
        taken: Collection[Hypothesis],
        beginning: Hypothesis | None,
        most: float,
    ) -> list[Prospect]:
        """The same, as many as wanted and behind them the best of every kind."""
        data = problem.data
        base = data.predict(simulator)
        weighted = problem.covariance.inverse_times(problem.residual(base))
        promises: list[_Promise] = []
        for judged in self._judged:
            promises += _promises(judged, weighted, data, beginning)
        kept = self._best(promises, taken, most) if promises else []
        # About the simulation of the screening nothing is new but what onsets make of signatures.
        here = self._about == (problem, simulator)
        known = [here and one.hypothesis.onset is None for one in kept[:JUDGED]]
        nearest = list(zip(kept[:JUDGED], known, strict=True))
        anew = [one for one, judged in nearest if not judged]
        kept = [
            *judged_anew(problem, simulator, anew, weighted),
            *(one for one, judged in nearest if judged),
            *kept[JUDGED:],
        ]
        first: dict[int, Prospect] = {}
        for one in sorted(kept, key=_rank):
            first.setdefault(one.number, one)
        return list(first.values())

    def _best(
        self,
        promises: Sequence["_Promise"],
        taken: Collection[Hypothesis],
        most: float,
    ) -> list[Prospect]:
        """The best promise of each candidate for each way to begin, the best first.

        What an onset promises is rough, and must not hide another way to begin.
        """
        numbers = np.concatenate([one.block.numbers for one in promises])
        scores = np.concatenate([one.scores for one in promises])
        places = [(promise, k) for promise in promises for k in range(len(promise.scores))]
        kept: list[Prospect] = []
        known: set[tuple[int, Profile | None]] = set()
        behind: dict[str, int] = {}
        for place in np.lexsort((numbers, -scores)).tolist():
            promise, k = places[place]
            number, hypothesis, _ = promise.block.members[k]
            if (number, promise.profile) in known:
                continue
            known.add((number, promise.profile))
            if behind.get(hypothesis.name, 0) == OF_KIND:
                continue
            if any(hypothesis.same_place(other) for other in taken):
                continue
            if len(kept) >= most:
                behind[hypothesis.name] = behind.get(hypothesis.name, 0) + 1
            kept.append(promise.prospect(k, self._largest[number]))
        return kept


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
    largest = {one.number: (one.largest, one.largest_late) for one in prospects}
    several = (signature(data, about, one.number, one.hypothesis, one.trial) for one in prospects)
    found = []
    for block in chunks(one for one in several if one is not None):
        size = covariance.squares(covariance.reduce(block.values, block.channels))
        sums = block.along(weighted).sum(1)
        score, start = scored(block, sums, np.maximum(size, 0.0), block.log_prior)
        found += [
            Prospect(number, hypothesis, _coordinates(z, s), float(points), *largest[number], z)
            for (number, hypothesis, z), points, s in zip(block.members, score, start, strict=True)
        ]
    return found


@dataclass(frozen=True)
class _Promise:
    """What signatures promise that begin in one way.

    Attributes:
        block: the signatures.
        scores: float[k].
        starts: z of their best, float[k], or NaN: those of the trial.
        profile: how they begin; None: they always act.
        moments: at which they begin [s], float[k].
        end: when they are fully grown [s]; None: in the last row.
    """

    block: Block
    scores: FloatArray
    starts: FloatArray
    profile: Profile | None = None
    moments: FloatArray | None = None
    end: float | None = None

    def prospect(self, k: int, largest: tuple[float, float]) -> Prospect:
        """The prospect of a signature."""
        number, hypothesis, z = self.block.members[k]
        if self.profile is not None and self.moments is not None:
            hypothesis = hypothesis.beginning(float(self.moments[k]), self.profile, self.end)
        start = _coordinates(z, float(self.starts[k]))
        return Prospect(number, hypothesis, start, float(self.scores[k]), *largest, z)


def _promises(
    judged: RankedSignatures, weighted: FloatArray, data: Data, beginning: Hypothesis | None
) -> list[_Promise]:
    """What every signature promises: from the start, and from its likeliest moment on."""
    block, time, tare = judged.block, data.time, data.tare
    along = np.stack([block.along(weighted), block.zero_along(weighted)])
    later = block.log_prior + LATE
    found = [_Promise(block, *scored(block, along[0].sum(1), judged.size, block.log_prior))]
    if beginning is not None and beginning.onset is not None:
        weight, weight_at_zero = data.weights(beginning.effect([0.0] * len(beginning.priors)))
        at_zero = tare.mean_weight(weight_at_zero[None])
        sums, sizes = judged.begun(along, OneBeginning(weight), at_zero)
        promised = scored(block, sums[:, 0], sizes[:, 0], later)
        moments = np.full(len(later), beginning.onset)
        found.append(_Promise(block, *promised, beginning.profile, moments, beginning.end))
    if beginning is None and not data.belief.passing:
        margin = max(2, len(time) // 50)
        inner = slice(margin, len(time) - margin)
        every = np.arange(len(later))
        for profile in PROFILES:
            weights = EveryBeginning(time, time[inner], profile)
            at_zero = tare.mean_weight(weights.at(tare.time))
            sums, sizes = judged.begun(along, weights, at_zero)
            row = np.argmax(gained(sums, sizes), axis=1)
            promised = scored(block, sums[every, row], sizes[every, row], later)
            found.append(_Promise(block, *promised, profile, time[inner][row]))
    return found


def _coordinates(z: tuple[float, ...], start: float) -> tuple[float, ...]:
    return z if np.isnan(start) else (float(start),) * len(z)


def _rank(one: Prospect) -> tuple[float, int]:
    return -one.score, one.number
