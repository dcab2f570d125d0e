"""Hypotheses fitted to measured modes, and their evidence by Laplace's approximation.

As for static readings (`search.laplace`), with predictions that are made anew at every step: a
removed member, or two modes that trade places, are no matter of slopes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import effects_at
from rga.errors import InputError, UnstableStructureError
from rga.model.parameter import NORMAL_90

#: difference of a derivative by z; steps, and how often one is shortened
STEP, STEPS, SHORTENED = 1e-3, 12, 6
#: bounds of z and of a step in it, and what one must gain, by slopes and in truth, to be followed
#: by another
FARTHEST, LONGEST, PROMISED, GAINED = 8.0, 2.0, 1e-3, 0.05
#: where the data alone decide: weight of the prior, and bounds of z
UNWEIGHED, ANYWHERE = 1e-4, 60.0
#: what the loss rises by to the ends of a 90 % interval, what share of it slopes must keep, and
#: how often a distance to an end is doubled and halved
RISE, NEARLY, DOUBLED, HALVED = 0.5 * NORMAL_90**2, 0.8, 8, 4


@dataclass(frozen=True, eq=False)
class ModalFit:
    """Hypotheses fitted together.

    Attributes:
        likelihood: of the modes.
        hypotheses: those fitted.
        z: standard normal coordinates of all parameters, float[parameters].
        prediction: there; None where the model cannot be simulated.
        residual: whitened, float[k].
        signatures: derivatives of the whitened prediction by z, float[parameters, k].
        log_evidence: against no effect at all.
    """

    likelihood: ModalLikelihood
    hypotheses: tuple[Hypothesis, ...]
    z: FloatArray
    prediction: Prediction | None
    residual: FloatArray
    signatures: FloatArray
    log_evidence: float

    @property
    def likelihood_loss(self) -> float:
        """Loss of the data alone, whatever is known of parameters and places beforehand."""
        freedom = 0.0 if self.prediction is None else self.likelihood.freedom(self.prediction)
        return 0.5 * float(self.residual @ self.residual) + freedom

    @property
    def information(self) -> FloatArray:
        """Of z, prior and data together, float[parameters, parameters]."""
        return np.asarray(self.signatures @ self.signatures.T + np.eye(len(self.z)))

    @cached_property
    def interval(self) -> FloatArray:
        """Ends of the 90 % interval of each coordinate, float[parameters, 2].

        By the slopes, or where the loss has risen as much, where that is farther: where another
        pairing of modes comes into question, slopes are steep that are none.
        """
        covariance = np.linalg.inv(self.information)
        ends = np.zeros((len(self.z), 2))
        for number, along in enumerate(covariance / np.sqrt(np.diag(covariance))[:, None]):
            for side, sign in enumerate((-1.0, 1.0)):
                end = sign * NORMAL_90 * along
                ends[number, side] = self.z[number] + self._farther(end) * end[number]
        return ends

    @property
    def points(self) -> list[str]:
        """Points at which the last hypothesis acts on what is measured."""
        return self.hypotheses[-1].points if self.hypotheses else []

    def _farther(self, end: FloatArray) -> float:
        """How many times farther the end of a 90 % interval lies than the slopes have it."""
        if self.prediction is None or self._rise(end) >= NEARLY * RISE:
            return 1.0
        low, high = 1.0, 2.0
        for _ in range(DOUBLED):
            if self._rise(high * end) >= RISE:
                break
            low, high = high, 2.0 * high
        for _ in range(HALVED):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self._rise(middle * end) >= RISE else (middle, high)
        return high

    def _rise(self, move: FloatArray) -> float:
        """How much more is lost, prior and freedom of the modes included, away from the fit."""
        there = self.z + move
        other = predicted(self.likelihood, self.hypotheses, there)
        if other is None:
            return np.inf
        left = self.likelihood.residual(other)
        lost = 0.5 * float(left @ left + there @ there) + self.likelihood.freedom(other)
        return lost - self.likelihood_loss - 0.5 * float(self.z @ self.z)

    def of(self, number: int) -> slice:
        """The coordinates of one hypothesis."""
        counts = [len(one.priors) for one in self.hypotheses]
        first = sum(counts[:number])
        return slice(first, first + counts[number])


def predicted(
    likelihood: ModalLikelihood, hypotheses: Sequence[Hypothesis], z: FloatArray
) -> Prediction | None:
    """The modes with hypotheses at coordinates; None where they cannot be simulated."""
    try:
        return likelihood.trials.predict(effects_at(hypotheses, z))
    except (InputError, UnstableStructureError):
        return None


def fitted(
    likelihood: ModalLikelihood,
    hypotheses: Sequence[Hypothesis],
    start: Sequence[float] | FloatArray,
) -> ModalFit:
    """The most likely parameters of hypotheses together, by Gauss-Newton steps."""
    return _fitted(likelihood, hypotheses, start, 1.0, FARTHEST)


def least_loss(fit: ModalFit) -> float:
    """Loss of the data alone where it is least, whatever is known of parameters beforehand."""
    if fit.prediction is None:
        return np.inf
    own = _fitted(fit.likelihood, fit.hypotheses, fit.z, UNWEIGHED, ANYWHERE)
    return min(own.likelihood_loss, fit.likelihood_loss)


def shown_by(fit: ModalFit) -> ModalLikelihood:
    """The likelihood with the error of the model that its causes leave, where that is larger.

    A model that misses some modes by much may do so in those that speak for a cause.
    """
    if not fit.hypotheses or fit.prediction is None:
        return fit.likelihood
    level = fit.likelihood.likeliest_level(fit.prediction)
    return fit.likelihood.with_level(max(level, fit.likelihood.level))


def _fitted(
    likelihood: ModalLikelihood,
    hypotheses: Sequence[Hypothesis],
    start: Sequence[float] | FloatArray,
    usual: float,
    farthest: float,
) -> ModalFit:
    """The same with a prior of so much weight, and no coordinate farther than so."""
    z = np.array(start, dtype=float)
    prediction = predicted(likelihood, hypotheses, z)
    if prediction is None:
        return _impossible(likelihood, hypotheses, z)
    residual = likelihood.residual(prediction)
    loss = float(residual @ residual + usual * z @ z)
    signatures = np.zeros((len(z), len(residual)))
    for _ in range(STEPS):
        found = _signatures(likelihood, hypotheses, z, residual)
        if found is None:
            return _impossible(likelihood, hypotheses, z)
        signatures = found
        slope = signatures @ residual - usual * z
        move = np.linalg.solve(signatures @ signatures.T + usual * np.eye(len(z)), slope)
        if float(move @ slope) < PROMISED:
            break
        move *= min(1.0, LONGEST / max(float(np.abs(move).max()), 1e-12))
        for _ in range(SHORTENED):
            there = np.clip(z + move, -farthest, farthest)
            other = predicted(likelihood, hypotheses, there)
            if other is not None:
                left = likelihood.residual(other)
                cost = float(left @ left + usual * there @ there)
                if cost < loss:
                    break
            move = move / 3
        else:
            break
        gained, loss = loss - cost, cost
        z, prediction, residual = there, other, left
        if gained < GAINED:
            break
    return _weighed(likelihood, hypotheses, z, prediction, residual, signatures)


def _signatures(
    likelihood: ModalLikelihood,
    hypotheses: Sequence[Hypothesis],
    z: FloatArray,
    residual: FloatArray,
) -> FloatArray | None:
    columns = np.zeros((len(z), len(residual)))
    for number, along in enumerate(np.eye(len(z))):
        # At the edge of what can be simulated there is but one side.
        for step in (STEP, -STEP):
            beside = predicted(likelihood, hypotheses, z + step * along)
            if beside is not None:
                columns[number] = (residual - likelihood.residual(beside)) / step
                break
        else:
            return None
    return columns


def _weighed(
    likelihood: ModalLikelihood,
    hypotheses: Sequence[Hypothesis],
    z: FloatArray,
    prediction: Prediction | None,
    residual: FloatArray,
    signatures: FloatArray,
) -> ModalFit:
    nothing = likelihood.residual(likelihood.trials.predict({}))
    information = signatures @ signatures.T + np.eye(len(z))
    loss = float(residual @ residual + z @ z)
    log_evidence = 0.5 * (float(nothing @ nothing) - loss)
    log_evidence -= 0.5 * float(np.linalg.slogdet(information)[1])
    log_evidence += sum(one.log_prior for one in hypotheses)
    if prediction is not None:
        log_evidence -= likelihood.freedom(prediction)
    return ModalFit(
        likelihood, tuple(hypotheses), z, prediction, residual, signatures, log_evidence
    )


def _impossible(
    likelihood: ModalLikelihood, hypotheses: Sequence[Hypothesis], z: FloatArray
) -> ModalFit:
    residual = likelihood.residual(likelihood.trials.predict({}))
    nowhere = np.zeros((len(z), len(residual)))
    return ModalFit(likelihood, tuple(hypotheses), z, None, residual, nowhere, -np.inf)
