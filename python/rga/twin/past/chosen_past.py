"""A past of more rows than a diagnosis analyses: a record of chosen ones, and the choice told."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rga.findings import Findings
from rga.model import Model
from rga.records import Record
from rga.records.zero import rows_within, zeros_of
from rga.twin.history import Event
from rga.twin.past.chosen_rows import ON_END, ChosenRows, chosen_rows

#: rows that a diagnosis can be given as they are
WHOLE = 50_000
#: stretches of a past whose rows cannot be told one without the other
STRETCHES = 8
#: what happened to the twin because something may have begun
BEGINNINGS = ("alarm", "version", "rollback")


def chosen_past(
    model: Model,
    past: Record,
    events: Sequence[Event],
    calibrated: int,
    most: int,
    seed: int,
    forgotten: Sequence[tuple[int, int]] = (),
) -> ChosenRows:
    """The rows of a past that a diagnosis is to see: all, or at most a number.

    Nothing is chosen of a past that is not very long where nothing happened, or where a row tells
    only with those before it: a diagnosis takes rows evenly then.

    Args:
        model: as it was given.
        past: all rows so far; their readings are not looked at.
        events: that happened in it.
        calibrated: rows of the first calibration.
        most: rows that a diagnosis analyses.
        seed: of the choice.
        forgotten: first row of, and row behind, stretches whose readings are forgotten.

    Raises:
        InputError: a channel was zeroed outside the times of the record.
    """
    rows = len(past)
    names = [name for name in model.context if name in past.contexts]
    zeros = [rows_within(past.time, zero) for zero in zeros_of(model, past) if zero is not None]
    # What a diagnosis of the last row finds marks that row itself, and must not change its rows.
    marks = [one.row for one in events if one.kind in BEGINNINGS and one.row < rows - 1]
    together = _together(model, past)
    gone = np.zeros(rows, dtype=bool)
    for first, behind in forgotten:
        gone[first:behind] = True
    told = []
    if gone.any():
        first, last = np.flatnonzero(gone)[[0, -1]]
        told.append(f"readings of {gone.sum()} rows from {first} to {last} are forgotten")
    left = rows - int(gone.sum())
    if left <= most or (left <= WHOLE and (together or not marks)):
        return ChosenRows(np.flatnonzero(~gone), "; ".join(told))
    choice = chosen_rows(
        rows,
        np.column_stack([np.zeros((rows, 0)), *(past.contexts[name] for name in names)]),
        np.array([model.context[name].range for name in names]).reshape(-1, 2),
        [calibrated, *marks],
        calibrated,
        most,
        seed,
        zero=np.unique(np.concatenate(zeros)) if zeros else None,
        gone=gone,
        on_end=max(ON_END, most // STRETCHES) if together else ON_END,
    )
    told.insert(0, f"diagnosed were {choice.words}")
    if together:
        looking_back = ", ".join(together)
        told.insert(1, f"these are whole stretches, as {looking_back} depends on the rows before")
    return replace(choice, words="; ".join(told))


def with_choice(findings: Findings, words: Sequence[str], rows: int) -> Findings:
    """Findings that tell of which rows and readings they are.

    Args:
        findings: of a record of chosen rows.
        words: how they were chosen, and what is not used of them; empty where they are all.
        rows: of the past that they were chosen of.
    """
    if not words:
        return findings
    told = findings.model_copy(update={"warnings": [*findings.warnings, *words]})
    told._account = replace(findings.account, recorded=rows)
    return told


def _together(model: Model, past: Record) -> list[str]:
    """Names of contexts and effects that show from row to row only."""
    moving = [
        name
        for name, one in model.context.items()
        if one.law in ("linear", "smooth") and name not in past.contexts
    ]
    return [*moving, *(name for name, one in model.effects.items() if one.remembers)]
