"""When an effect began, and how: at once, or growing over time.

An effect that begins late takes a share of its rows. So its sums with a residual and with itself
follow, for every beginning at once, from those of its rows one by one.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.search.hypothesis import Hypothesis, Profile
from rga.diagnosis.search.laplace import Fit, extended
from rga.diagnosis.search.linearised import Problem
from rga.simulation import Simulator

#: pieces of the record whose sums are worked out, and rows about the best that stand alone
PIECES, ALONE = 60, 12
#: lengths of a ramp that are distinguished, in shares of what is left of the record
LENGTHS = (0.2, 0.4, 0.6, 0.8, 1.0)


@dataclass(frozen=True)
class Beginnings:
    """Possible onsets of a hypothesis.

    Attributes:
        moments: float[moments] [s].
        chances: of each, however the effect begins then, float[moments].
        likeliest: the hypothesis with its likeliest beginning.
    """

    moments: FloatArray
    chances: FloatArray
    likeliest: Hypothesis


def beginnings(problem: Problem, base: Simulator, current: Fit, number: int) -> Beginnings:
    """Possible onsets of a hypothesis in a fit.

    Args:
        problem: gives residual and covariance.
        base: the simulator without causes.
        current: the fit.
        number: of the hypothesis in it.
    """
    hypothesis = current.hypotheses[number]
    always = [
        one.beginning(None) if k == number else one for k, one in enumerate(current.hypotheses)
    ]
    others = [one for k, one in enumerate(current.hypotheses) if k != number]
    z = np.delete(current.z, current.slices()[number])
    data = problem.data
    simulator = extended(base, others, z)
    full, full_zero = data.untared(extended(base, always, current.z))
    bare, bare_zero = data.untared(simulator)
    without = bare - data.taken_off(bare_zero)
    change = _Change(full - bare, data.tare.shares[:, data.columns] * (full_zero - bare_zero))
    rows = len(full)
    edges = np.unique(np.linspace(0, rows, min(PIECES, rows) + 1).astype(int))
    likely = _judged(problem, change, without, edges)
    best = likely[0]
    near = [row + np.arange(-ALONE, ALONE + 1) for row in {best.first, best.last}]
    edges = np.unique(np.concatenate([edges, *near]).clip(0, rows))
    likely = _judged(problem, change, without, edges)
    time = problem.data.time
    logs = np.array([one.log_chance for one in likely])
    weights = np.exp(logs - logs.max()) * [one.width for one in likely]
    moments, place = np.unique([one.first for one in likely], return_inverse=True)
    chances = np.bincount(place, weights)
    best = likely[0]
    end = float(time[best.last]) if best.last < rows - 1 else None
    start = float(time[best.first])
    step = hypothesis.beginning(start)
    likeliest = step if best.profile == "step" else hypothesis.beginning(start, "ramp", end)
    return Beginnings(time[moments], chances / chances.sum(), likeliest)


@dataclass(frozen=True)
class _Change:
    """What the hypothesis changes if it always acts.

    Attributes:
        rows: with nothing taken off for the zero, float[rows, sensors].
        taken_off: by each zero row, float[zero rows, sensors].
    """

    rows: FloatArray
    taken_off: FloatArray

    def pieces(self, data: Data, edges: IntArray) -> FloatArray:
        """Its pieces between edges, each with what the zero rows of that time take off.

        Returns:
            float[pieces, sensors, rows].
        """
        pieces = np.zeros((len(edges) - 1, *self.rows.T.shape))
        for piece, (first, last) in zip(pieces, pairwise(edges), strict=True):
            piece[:, first:last] = self.rows[first:last].T
        # Zero rows before the first piece come before every beginning.
        of_piece = np.searchsorted(data.time[edges[:-1]], data.tare.time, side="right") - 1
        for number, taken in zip(of_piece, self.taken_off, strict=True):
            if number >= 0:
                pieces[number] -= taken[:, None]
        return np.where(data.observed.T, pieces, 0.0)


@dataclass(frozen=True)
class _Beginning:
    """A beginning at a row, full at another, with its log chance and the rows it stands for."""

    first: int
    last: int
    profile: Profile
    log_chance: float
    width: float


def _judged(
    problem: Problem, change: _Change, without: FloatArray, edges: IntArray
) -> list[_Beginning]:
    """All beginnings at the edges of pieces, the likeliest first."""
    covariance, time = problem.covariance, problem.data.time
    rows = len(time)
    reduced = covariance.reduce(change.pieces(problem.data, edges))
    product = covariance.product(reduced, reduced)
    residual = covariance.reduce(problem.residual(without).T[None])
    sums = covariance.product(reduced, residual)[:, 0]
    middle = np.array([time[a:b].mean() for a, b in pairwise(edges)])
    found = []
    margin = max(2, rows // 50)
    for number, first in enumerate(edges[:-1]):
        # What is there in a few rows only is no beginning.
        if not margin <= first <= rows - margin:
            continue
        width = float(edges[number + 1] - edges[number - 1]) / 2
        step = (np.arange(len(middle)) >= number).astype(float)
        options: list[tuple[Profile, int, FloatArray]] = [("step", int(first), step)]
        left = time[-1] - time[first]
        for length in LENGTHS if left > 0 else ():
            last = int(np.searchsorted(time, time[first] + length * left))
            weight = np.clip((middle - time[first]) / max(time[last] - time[first], 1e-12), 0, 1)
            options.append(("ramp", last, weight))
        for profile, last, weight in options:
            size = max(float(weight @ product @ weight), 1e-300)
            along = max(float(weight @ sums), 0.0)
            chance = along**2 / size / 2 - np.log1p(size) / 2
            chance -= np.log(len(LENGTHS)) if profile == "ramp" else 0.0
            found.append(_Beginning(int(first), last, profile, chance, width))
    return sorted(found, key=lambda one: -one.log_chance)
