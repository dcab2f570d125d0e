"""How plainly modes show what is hidden, in the measures of a diagnosis.

The judge knows what is hidden: the change is that of the same campaign without it.
"""

from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from rga.diagnosis.modal.candidates import modal_hypotheses
from rga.diagnosis.modal.fit import predicted
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.errors import InputError
from rga.model import Model
from rga.records.modal.record import ModalRecord
from rga_bench.diagnosis.hidden import Truth


@dataclass(frozen=True)
class ModalSize:
    """d' of a hidden effect, and d' once its nearest rival has imitated all it can."""

    d_prime: float
    d_perp: float
    nearest: dict[str, Any] | None = None


def modal_size(
    model: Model, record: ModalRecord, healthy: ModalRecord, truth: Truth
) -> ModalSize | None:
    """The size of what is hidden; None where the two campaigns cannot be compared.

    Rivals imitate it by one of their trial values, drawn out as a line.

    Args:
        model: of the case.
        record: of its modes.
        healthy: of the same modes with nothing hidden.
        truth: what is hidden.
    """
    try:
        readings, other = ModalReadings.of(model, record), ModalReadings.of(model, healthy)
    except InputError:
        return None
    if readings.modes != other.modes:
        return None
    both = np.isfinite(readings.log_f) & np.isfinite(other.log_f)
    seen = [replace(one, log_f=np.where(both, one.log_f, np.nan)) for one in (readings, other)]
    plain = replace(
        seen[1], scatter=seen[0].scatter, memory=seen[0].memory, shape_noise=seen[0].shape_noise
    )
    likelihood = ModalLikelihood(ModalTrials(model, plain))
    nothing = predicted(likelihood, [], np.zeros(0))
    if nothing is None or any(
        len(one.at) != len(two.at) for one, two in zip(readings.looks, other.looks, strict=True)
    ):
        return None
    left = likelihood.residual(nothing)
    hidden = ModalLikelihood(ModalTrials(model, seen[0]))
    change = hidden.residual(nothing) - left
    size = least = float(change @ change)
    nearest = None
    for one in modal_hypotheses(likelihood.trials):
        place = {"kind": one.name, **one.place}
        if truth.is_at(place):
            continue
        late = one if truth.onset is None else one.beginning(truth.onset)
        for trial in product(*(prior.trials for prior in one.priors.values())):
            there = predicted(likelihood, [late], np.array(trial))
            if there is None:
                continue
            own = left - likelihood.residual(there)
            square = float(own @ own)
            rest = size - float(own @ change) ** 2 / square if square > 0.0 else size
            if rest < least:
                least, nearest = rest, place
    return ModalSize(float(np.sqrt(size)), float(np.sqrt(max(least, 0.0))), nearest)
