"""Modes that were measured beside a record."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.records.modal.read import load_modal_record
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.structures import ModalStructures


def modes_beside(model: Model, record: Record, modal: ModalRecord | str | Path) -> ModalLikelihood:
    """The likelihood of modes that were measured beside a record.

    A context that the modes lack is its mean over the record's rows within the window; without
    such rows it is taken between those about it. A window before or behind all rows is left out
    where the context drives the structure.

    Args:
        model: of both.
        record: gives contexts and the clock.
        modal: the modes, or their file.

    Raises:
        InputError: the file cannot be used, one of both has dates and the other has none, or all
            windows lie apart from every row though a context of the record drives the structure.
    """
    if not isinstance(modal, ModalRecord):
        modal = load_modal_record(modal, model)
    if isinstance(modal.start, str) != isinstance(record.start, str):
        dated = "modes" if isinstance(modal.start, str) else "record"
        raise InputError(
            f"dates stand in the {dated} alone: the two clocks cannot be compared",
            "times of record and modes",
            "write both as ISO 8601 dates, or both in seconds on one clock",
        )
    clock, at = record.origin + record.time, modal.origin + modal.time
    contexts, driving = dict(modal.contexts), ModalStructures(model).needed
    for name, column in record.contexts.items():
        if name in contexts:
            continue
        seen = np.isfinite(column)
        if seen.any():
            half = np.nan_to_num(modal.duration) / 2
            ends = zip(at - half, at + half, strict=True)
            found = np.array([_mean_over(clock[seen], column[seen], *one) for one in ends])
            # What drives nothing, and is known of some windows alone, says nothing of the others.
            if name in driving or np.isfinite(found).all():
                contexts[name] = found
    readings = ModalReadings.of(model, replace(modal, contexts=contexts))
    return ModalLikelihood(ModalTrials(model, readings))


def _mean_over(clock: FloatArray, column: FloatArray, first: float, last: float) -> float:
    within = (clock >= first) & (clock <= last)
    if within.any():
        return float(column[within].mean())
    return float(np.interp((first + last) / 2, clock, column, left=np.nan, right=np.nan))
