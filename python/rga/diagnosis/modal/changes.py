"""What a cause changes of measured modes."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.fit import ModalFit, predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood

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
    moved = np.expm1((after.log_f - without.log_f)[-1])
    if np.abs(moved).max() < WORTH_TELLING:
        return ""
    most = np.argsort(-np.abs(moved))[:5]
    names = likelihood.readings.modes
    shown = [
        f"{names[k]} ({moved[k]:+.1%})" for k in most if abs(moved[k]) > 0.1 * abs(moved).max()
    ]
    return f"it moves {', '.join(shown)}"
