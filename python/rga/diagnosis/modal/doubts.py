"""In words: why measured modes decide less than they seem to."""

from collections.abc import Sequence

import numpy as np

from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import Prediction
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.model import Model

#: modes without which nothing is said to be right
FEW_MODES = 3
#: change of a frequency that no weather makes
BEYOND_WEATHER = 0.1


def thin(readings: ModalReadings, causes: bool) -> list[str]:
    """In words: why so few modes, or modes without shapes, decide nothing."""
    words = []
    if len(readings.modes) < FEW_MODES:
        words.append(
            f"{len(readings.modes)} of the modes expected were found, and {FEW_MODES} are needed "
            "to decide"
        )
    blind = [
        name for name, look in zip(readings.modes, readings.looks, strict=True) if not len(look.at)
    ]
    if causes and blind:
        words.append(
            f"modes {', '.join(blind)} are known by their frequencies alone: which computed modes "
            "they are is a guess, and the causes hang on it"
        )
    return words


def weather(readings: ModalReadings, causes: Sequence[Hypothesis], after: Prediction) -> list[str]:
    """In words: why a small change that begins late may be the weather."""
    late = any(one.onset is not None for one in causes)
    if not late or readings.contexts:
        return []
    moved = float(np.abs(np.expm1(np.ptp(after.log_f, axis=0))).max())
    if moved >= BEYOND_WEATHER:
        return []
    words = (
        f"what begins late moves no frequency by more than {moved:.1%}, and no temperature stands "
        "beside the frequencies: it may be the weather"
    )
    return [words]


def warnings_of(model: Model, readings: ModalReadings) -> list[str]:
    """In words: what of the record says less than it could."""
    warnings = []
    without = [name for name in model.modes if name not in readings.modes]
    if without:
        warnings.append(f"modes that are in no window: {', '.join(without)}")
    by_frequency = [
        name for name, look in zip(readings.modes, readings.looks, strict=True) if not len(look.at)
    ]
    if by_frequency:
        warnings.append(
            f"paired by frequency only, without a shape: {', '.join(by_frequency)}; what trades "
            "places with another mode passes for what moves"
        )
    if readings.unnamed:
        warnings.append(f"{readings.unnamed} entries of the record are none of the modes expected")
    return warnings
