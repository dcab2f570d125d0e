"""What a cause changes of measured modes."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.fit import ModalFit, predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.findings.phrases import place_words

#: change of a MAC that is worth telling
LIKENED = 0.005
#: change of every frequency, over the error that a model makes, by which a cause shows in none
UNMOVED = 0.25
#: share of the largest change, within which modes are again as they were before it
AS_BEFORE = 0.3
#: change of a frequency that is worth telling, as a share of it
WORTH_TELLING = 5e-4


def change(likelihood: ModalLikelihood, fit: ModalFit, number: int) -> FloatArray:
    """What a cause changes of the whitened residual, beside the others."""
    others = [one for k, one in enumerate(fit.hypotheses) if k != number]
    z = np.delete(fit.z, fit.of(number))
    without, after = predicted(likelihood, others, z), fit.prediction
    if without is None or after is None:
        return np.zeros_like(fit.residual)
    return np.asarray(likelihood.residual(without) - likelihood.residual(after))


def moved_modes(likelihood: ModalLikelihood, fit: ModalFit, number: int) -> str:
    """In words: the modes in which a cause shows most; nothing where it shows in none."""
    others = [one for k, one in enumerate(fit.hypotheses) if k != number]
    without = predicted(likelihood, others, np.delete(fit.z, fit.of(number)))
    after = fit.prediction
    if without is None or after is None:
        return ""
    if fit.hypotheses[number].at_points:
        return _likened_modes(likelihood, without, after)
    moved = np.expm1(after.log_f - without.log_f)
    moved = moved[np.argmax(np.abs(moved).sum(axis=1))]
    if np.abs(moved).max() < WORTH_TELLING:
        return ""
    most = np.argsort(-np.abs(moved))[:5]
    names = likelihood.readings.modes
    shown = [
        f"{names[k]} ({moved[k]:+.1%})" for k in most if abs(moved[k]) > 0.1 * abs(moved).max()
    ]
    return f"it moves {', '.join(shown)}"


def _likened_modes(likelihood: ModalLikelihood, without: Prediction, after: Prediction) -> str:
    """In words: the modes whose measured shapes are likest to the simulated ones by a cause."""
    gained = np.nan_to_num(after.mac - without.mac)
    names = likelihood.readings.modes
    told = [
        f"{names[k]} (MAC {without.mac[k]:.2f} without it, {after.mac[k]:.2f} with it)"
        for k in np.argsort(-gained)[:5]
        if gained[k] > max(LIKENED, 0.1 * gained.max())
    ]
    return f"with it these shapes are the simulated ones: {', '.join(told)}" if told else ""


def passing(likelihood: ModalLikelihood, fit: ModalFit) -> list[str]:
    """In words: that causes which come one after the other leave the modes as they were before."""
    onsets = sorted({one.onset for one in fit.hypotheses if one.onset is not None})
    if len(onsets) < 2 or fit.prediction is None:
        return []
    readings = likelihood.readings
    changes = fit.prediction.log_f - likelihood.trials.predict({}).log_f
    stage = np.searchsorted(onsets, readings.time, side="right")
    stages = [changes[stage == number].mean(axis=0) for number in np.unique(stage)]
    before, last = stages[0], stages[-1]
    farthest = max(float(np.abs(one - before).max()) for one in stages)
    if float(np.abs(last - before).max()) >= AS_BEFORE * farthest:
        return []
    first, end = readings.label(onsets[0]), readings.label(onsets[-1])
    words = (
        f"from {end} on the modes are again as they were before {first}: what came and went may "
        "be one thing, a load or ice, in place of several"
    )
    return [words]


def moving_nothing(likelihood: ModalLikelihood, fit: ModalFit) -> list[str]:
    """In words: causes of the structure that leave all modes as they were.

    What is held for always shows against the error that a model makes anyway.
    """
    after, words = fit.prediction, []
    for number, one in enumerate(fit.hypotheses):
        others = [other for k, other in enumerate(fit.hypotheses) if k != number]
        without = predicted(likelihood, others, np.delete(fit.z, fit.of(number)))
        if one.at_points or one.onset is not None or without is None or after is None:
            continue
        moved = float(np.abs(after.log_f - without.log_f).max())
        likened = float(np.nan_to_num(after.mac - without.mac).max(initial=0.0))
        if moved < UNMOVED * likelihood.level and likened < LIKENED:
            words.append(
                f"{place_words([one.kind.title, *one.place.values()])} moves no frequency by more "
                f"than {moved:.2%} and makes no shape more alike"
            )
    return words
