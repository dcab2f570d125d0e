"""What the causes leave of measured modes, and how they predict modes that were left out."""

from dataclasses import dataclass

import numpy as np
import scipy

from rga.arrays import FloatArray
from rga.diagnosis.modal.fit import ModalFit, fitted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction

#: deviations of a frequency, and of a shape, from which on a mode is off
OFF = 3.0
SHAPE_OFF = 2.0
#: of intervals
CONFIDENCE = 0.9
#: times what they were before, from which on modes are predicted worse in earnest
MUCH = 1.5
#: probability that all frequencies of a right model are nearer
CHANCE = 0.95


@dataclass(frozen=True)
class LeftOutModes:
    """Modes predicted without having been looked at.

    Attributes:
        before: squared deviation of each by the model as given, float[modes].
        after: the same by causes that were fitted to the other modes.
    """

    before: FloatArray
    after: FloatArray

    @property
    def surely_worse(self) -> bool:
        """Whether causes predict modes worse than the model as given, by their 90 % interval.

        They must be worse by half, and than a right model: by the means over a record, a cause
        that begins late is hardly seen.
        """
        least = max(1.0, MUCH * float(self.before.mean()))
        worse = float(self.after.mean()) > least
        return worse and gain_interval(self.before - self.after)[1] < 0.0


def gain_interval(gains: FloatArray) -> tuple[float, float]:
    """The 90 % interval of the mean of gains, float[modes], by Student's t; of one mode, itself."""
    middle, wide = float(gains.mean()), 0.0
    if len(gains) > 1:
        quantile = float(scipy.stats.t.ppf(0.5 + CONFIDENCE / 2, len(gains) - 1))
        wide = quantile * float(gains.std(ddof=1)) / np.sqrt(len(gains))
    return middle - wide, middle + wide


def squares(likelihood: ModalLikelihood, prediction: Prediction) -> FloatArray:
    """Squared deviations of the frequencies, over what noise and model may be off, float[modes].

    Those of the means over all windows; where a cause follows the temperature, in the middle of
    these and of those of single windows from the mean.
    """
    off = likelihood.mean_off(prediction)
    of_means = (off / likelihood.mean_spread(prediction)) ** 2
    if not likelihood.explains_weather:
        return np.asarray(of_means)
    readings = likelihood.readings
    single = np.nanmean((readings.log_f - prediction.log_f - off) ** 2, axis=0)
    return np.asarray(0.5 * (of_means + single / readings.scatter**2))


def left_out_modes(likelihood: ModalLikelihood, fit: ModalFit) -> LeftOutModes:
    """Every mode left out in turn, and predicted by causes that others put where they are."""
    nothing = likelihood.trials.predict({})
    before = squares(likelihood, nothing)
    after = before.copy()
    if not fit.hypotheses or len(before) < 2:
        return LeftOutModes(before, after)
    for mode in range(len(before)):
        other = fitted(likelihood.hiding(mode), fit.hypotheses, fit.z)
        if other.prediction is not None:
            after[mode] = squares(likelihood, other.prediction)[mode]
    return LeftOutModes(before, after)


def modes_off(likelihood: ModalLikelihood, prediction: Prediction) -> list[str]:
    """In words: modes whose frequency or shape a prediction does not have."""
    words = []
    off, spread = likelihood.mean_off(prediction), likelihood.mean_spread(prediction)
    for mode, name in enumerate(likelihood.readings.modes):
        if abs(off[mode]) > OFF * spread[mode]:
            words.append(
                f"mode {name} lies {np.expm1(off[mode]):+.1%} off what is simulated, "
                f"{abs(off[mode]) / spread[mode]:.1f} times what a right model leaves"
            )
        apart = likelihood.shape_off(mode, prediction)
        if float(apart @ apart) > SHAPE_OFF**2:
            words.append(
                f"the shape of mode {name} is not the simulated one "
                f"(MAC {prediction.mac[mode]:.2f})"
            )
    together = float(((off / spread) ** 2).sum())
    if not words and together > scipy.stats.chi2.ppf(CHANCE, len(off)):
        words.append(
            f"all modes together lie {np.sqrt((off**2).mean()):.1%} off what is simulated, more "
            f"than a right model leaves in {100 * CHANCE:.0f} of 100 cases"
        )
    return words


def pairs_in_doubt(likelihood: ModalLikelihood, prediction: Prediction) -> list[str]:
    """In words: measured modes that are nearly as probably another computed mode."""
    if not prediction.doubtful:
        return []
    names = likelihood.readings.modes
    pairs = ", ".join(
        f"{names[mode]} may be mode {other + 1} of the model in place of {own + 1}"
        for mode, own, other in sorted(prediction.doubtful)
    )
    return [f"another pairing of measured with computed modes is nearly as probable: {pairs}"]
