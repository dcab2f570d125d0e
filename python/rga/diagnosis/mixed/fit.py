"""Hypotheses fitted to a record and to modes together.

Given what is wrong with a structure, errors of its gauges and of its modes have nothing to do with
each other: log likelihoods add. Each is known about its own most likely parameters (Laplace), and
the prior of the parameters counts once.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.diagnosis.modal.fit import ModalFit, fitted, predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Fit, extended, fit
from rga.diagnosis.search.linearised import Problem
from rga.errors import InputError
from rga.simulation import Simulator

#: what a record tells of a parameter, over its prior, that is nothing but rounding
SAYS_NOTHING = 1e-9


@dataclass(frozen=True, eq=False)
class MixedFit:
    """Hypotheses fitted together.

    Attributes:
        static: the fit to the record, of all hypotheses, about the parameters that both data have.
        modal: the fit to the modes, of those hypotheses that modes can show, about the same.
        alone: the fit to the record about those that it has by itself.
        loss: of the data alone, whatever is known of parameters and places beforehand.
        log_evidence: against no effect at all.
    """

    static: Fit
    modal: ModalFit
    alone: Fit
    loss: float
    log_evidence: float

    @property
    def hypotheses(self) -> tuple[Hypothesis, ...]:
        """Those fitted."""
        return self.static.hypotheses

    @property
    def z(self) -> FloatArray:
        """Standard normal coordinates of all parameters, float[parameters]."""
        return self.static.z


@dataclass(frozen=True, eq=False)
class MixedEvidence:
    """Fits hypotheses to a record and to modes.

    Attributes:
        problem: the record about a simulation.
        base: the simulator without causes.
        likelihood: of the modes.
    """

    problem: Problem
    base: Simulator
    likelihood: ModalLikelihood

    def hiding(self, mode: int) -> "MixedEvidence":
        """The same without one of the modes."""
        return replace(self, likelihood=self.likelihood.hiding(mode))

    def fit(
        self, hypotheses: Sequence[Hypothesis], start: Sequence[float] | FloatArray
    ) -> MixedFit:
        """The most likely parameters of hypotheses together.

        Args:
            hypotheses: fitted together.
            start: coordinates to begin with, one a parameter.
        """
        return self.beside(fit(self.problem, self.base, hypotheses, start), start)

    def beside(self, static: Fit, start: Sequence[float] | FloatArray | None = None) -> MixedFit:
        """The same, where the fit to the record is known.

        Args:
            static: that fit.
            start: coordinates from which those begin of which the record says nothing; None: from
                what is usual.
        """
        shown = self.on_modes(static.hypotheses)
        own = _coordinates(static.hypotheses, shown)
        of_modes = [static.hypotheses[number] for number in shown]
        begun = static.z
        if start is not None:
            told = np.diag(static.information) > 1.0 + SAYS_NOTHING
            begun = np.where(told, static.z, start)
        modal = fitted(self.likelihood, of_modes, begun[own])
        if not (np.isfinite(static.log_evidence) and np.isfinite(modal.log_evidence)):
            return MixedFit(static, modal, static, np.inf, -np.inf)
        alone, count = static, len(static.z)
        information, along = static.information.copy(), static.information @ static.z
        if len(own):
            information[np.ix_(own, own)] += modal.information - np.eye(len(own))
            along[own] += modal.information @ modal.z
        # Far from their middle likelihoods bend: the best of three is no worse than either's own.
        options = [np.asarray(np.linalg.solve(information, along)), static.z]
        options.append(static.z.copy())
        options[-1][own] = modal.z
        points = [one for z in options if (one := self._at(static, modal, own, z)) is not None]
        if not points:
            return MixedFit(alone, modal, alone, np.inf, -np.inf)
        static, modal, misfit = min(points, key=lambda one: one[2] + float(one[0].z @ one[0].z))
        nothing = self.problem.at_nothing[self.base] + self._nothing
        freedom = float(np.linalg.slogdet(information)[1]) if count else 0.0
        evidence = 0.5 * (nothing - misfit - float(static.z @ static.z) - freedom)
        evidence += sum(one.log_prior for one in static.hypotheses)
        static = replace(static, information=information, log_evidence=evidence)
        return MixedFit(static, modal, alone, 0.5 * misfit, evidence)

    def on_modes(self, hypotheses: Sequence[Hypothesis]) -> list[int]:
        """Numbers of the hypotheses that modes can show."""
        return [number for number, one in enumerate(hypotheses) if self._shows(one)]

    def _shows(self, one: Hypothesis) -> bool:
        kind = one.kind
        if not (kind.structural or kind.on_modes or one.at_points):
            return False
        if kind.overrides("change_values") and not self.likelihood.trials.follows_contexts:
            return False
        # Friction and play leave no mode of their own.
        return predicted(self.likelihood, [one], np.zeros(len(one.priors))) is not None

    def _at(
        self, static: Fit, modal: ModalFit, own: IntArray, z: FloatArray
    ) -> tuple[Fit, ModalFit, float] | None:
        """Both fits at coordinates, and twice what the data lose there."""
        prediction = predicted(self.likelihood, modal.hypotheses, z[own])
        if prediction is None:
            return None
        try:
            simulated = self.problem.data.predict(extended(self.base, static.hypotheses, z))
        except InputError:
            return None
        covariance = self.problem.covariance
        left = covariance.reduce(self.problem.residual(simulated).T[None])
        residual = self.likelihood.residual(prediction)
        lost = float(covariance.squares(left)[0]) + float(residual @ residual)
        lost += 2.0 * self.likelihood.freedom(prediction)
        there = replace(static, z=z, simulated=simulated)
        return there, replace(modal, z=z[own], prediction=prediction, residual=residual), lost

    @property
    def _nothing(self) -> float:
        """Squared residual of the modes without any cause."""
        residual = self.likelihood.residual(self.likelihood.trials.predict({}))
        return float(residual @ residual)


def _coordinates(hypotheses: Sequence[Hypothesis], numbers: Sequence[int]) -> IntArray:
    """Where the coordinates of some hypotheses stand among those of all."""
    ends = np.cumsum([0, *(len(one.priors) for one in hypotheses)])
    parts = [np.arange(ends[number], ends[number + 1]) for number in numbers]
    return np.concatenate([np.zeros(0, dtype=np.int64), *parts]).astype(np.int64)
