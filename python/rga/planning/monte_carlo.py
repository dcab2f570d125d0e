"""Whether chosen measurements do separate: readings are drawn, and both explanations fitted."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.experiments.explanation import CandidateModel
from rga.experiments.separation import covariance
from rga.experiments.site import Site

#: draws with either explanation true
DRAWS = 50
#: steps of a fit, how often one is shortened, how far an unknown may go and how far derivatives
#: hold [standard deviations], and the loss worth another step
STEPS, SHORTENED, FARTHEST, STRAIGHT, ENOUGH = 6, 4, 8.0, 1.0, 0.05


@dataclass(frozen=True)
class Checked:
    """How often the true explanation won.

    Attributes:
        draws: half with the one, half with the other true.
        won: share in which the true one was likelier.
        clearly: share in which it was likelier by the log-odds asked for.
    """

    draws: int
    won: float
    clearly: float


class Judge:
    """One explanation, fitted to measurements.

    Args:
        site: of the measurements.
        one: the explanation.
        present: mask of the measurements that are taken, float[measurements, sensors].
        factor: of their covariance, lower, float[n, n].
    """

    def __init__(self, site: Site, one: CandidateModel, present: FloatArray, factor: FloatArray):
        self._site, self._one, self._present, self._factor = site, one, present > 0, factor
        self._precision = one.spread**-2.0
        self._start = np.zeros(len(one.unknowns))
        self._at_start = self.predicted(self._start)
        self._slope_at_start = self._slope(self._start)

    def predicted(self, steps: FloatArray) -> FloatArray:
        """The measurements that are taken, float[n]."""
        return self._site.measurements(self._one.at(steps))[self._present]

    def log_evidence(self, measured: FloatArray) -> float:
        """Of measurements float[n], up to what all explanations share (Laplace)."""
        steps, predicted, slope = self._start, self._at_start, self._slope_at_start
        residual = self._white(measured - predicted)
        loss = float(residual @ residual)
        about = steps
        for _ in range(STEPS if len(steps) else 0):
            if np.abs(steps - about).max() > STRAIGHT:
                slope, about = self._slope(steps), steps
            move = np.linalg.solve(
                self._information(slope), slope.T @ residual - steps * self._precision
            )
            for _ in range(SHORTENED):
                trial = np.clip(steps + move, -FARTHEST, FARTHEST)
                there = self._white(measured - self.predicted(trial))
                lower = float(there @ there + trial @ (trial * self._precision))
                if lower < loss:
                    break
                move = move / 3
            else:
                break
            gained, loss, steps, residual = loss - lower, lower, trial, there
            if gained < ENOUGH:
                break
        information = float(np.linalg.slogdet(self._information(slope))[1])
        return -0.5 * (loss + information - float(np.log(self._precision).sum()))

    def _information(self, slope: FloatArray) -> FloatArray:
        return np.asarray(slope.T @ slope + np.diag(self._precision))

    def _slope(self, steps: FloatArray) -> FloatArray:
        """Whitened derivatives by the unknowns, float[n, unknowns]."""
        rates = self._site.derivatives(self._one, steps)[:, self._present]
        return self._white(rates.T)

    def _white(self, columns: FloatArray) -> FloatArray:
        return np.asarray(solve_triangular(self._factor, columns, lower=True))


def checked(
    site: Site,
    cause: CandidateModel,
    rival: CandidateModel,
    present: FloatArray,
    odds: float,
    seed: int,
) -> Checked:
    """Draw measurements with either explanation true, and fit both.

    Unknowns are drawn from their intervals, errors from their covariance about the true one; the
    judge takes the covariance about the cause.

    Args:
        site: of the measurements.
        cause, rival: the explanations.
        present: mask of the measurements that are taken, float[measurements, sensors].
        odds: log-odds by which an explanation wins clearly.
        seed: of the draws.
    """
    if not present.any():
        return Checked(0, 0.0, 0.0)
    draw = np.random.default_rng(seed)
    both = (cause, rival)
    errors = [site.errors(one.effects) for one in both]
    factors = [np.asarray(np.linalg.cholesky(covariance(one, present)), float) for one in errors]
    judges = [Judge(site, one, present, factors[0]) for one in both]
    ahead = []
    for number, one in enumerate(both):
        for _ in range(DRAWS):
            steps = draw.standard_normal(len(one.unknowns))
            off = factors[number] @ draw.standard_normal(len(factors[number]))
            try:
                measured = judges[number].predicted(steps) + off
            except InputError:  # no structure has a value so far out
                continue
            log = [judge.log_evidence(measured) for judge in judges]
            ahead.append(log[number] - log[1 - number])
    if not ahead:
        return Checked(0, 0.0, 0.0)
    won = np.array(ahead)
    return Checked(len(won), float((won > 0).mean()), float((won >= odds).mean()))
