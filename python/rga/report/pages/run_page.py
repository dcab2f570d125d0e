"""What stands on the page of a run, beside its diagnosis, made ready for the template."""

from itertools import groupby
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.findings import Findings
from rga.quantities import DASH, fixed, number
from rga.report.figures.of_run.contexts_over_time import draw_contexts, drawn_contexts, out_of_range
from rga.report.figures.of_run.gap_map import draw_gap_map
from rga.report.figures.of_run.growth import draw_growth
from rga.report.figures.of_run.phases import draw_phases
from rga.report.figures.of_run.run_gap import (
    CHANGES,
    mean,
    phases,
    smoothed,
    standardised,
    usual,
)
from rga.report.figures.of_run.timeline import draw_timeline
from rga.report.figures.when import when
from rga.report.pages.diagnosis_page import page
from rga.report.pages.fault_tolerant_parts import part
from rga.twin.history import Event, History

LEVELS = {
    "A": "calibrated once and then left as it was",
    "B": "recalibrated whenever it is out of sync",
    "C": "recalibrated whenever it is out of sync, its repository extended by novel contexts and "
    "by what was learned under each",
}
COUNTED = {
    "alarm": ("alarm", "alarms"),
    "recall": ("return to what was learned before", "returns to what was learned before"),
    "recalibration": ("recalibration", "recalibrations"),
    "novel context": ("novel context", "novel contexts"),
    "diagnosis": ("diagnosis", "diagnoses"),
    "version": ("new version of the model", "new versions of the model"),
    "rollback": ("return to an earlier version", "returns to an earlier version"),
    "proposal": ("proposal", "proposals"),
    "command": ("command", "commands"),
}
#: so many events of one kind in a row stand in the table by themselves
MOST_IN_A_ROW = 3
MOST_SENSORS = 8
#: kinds of events that people read one by one
DECIDED = ("proposal", "version", "rollback")


def run_page(history: History, findings: Findings) -> dict[str, Any]:
    """The variables of the template."""
    shown = page(findings)
    shown["warnings"] = list(dict.fromkeys([*shown["warnings"], *history.record.warnings]))
    return shown | {
        "lived": part("What the twin lived through", lived, history),
        "timeline": part("The figure of the run", draw_timeline, history),
        "phases": part("The phases", draw_phases, history),
        "gap_map": part("The map of the gap", draw_gap_map, history),
        "events": part("The table of events", events, history),
        "asked": part("The table of commands", asked, history),
        "contexts_figure": part("The figure of the contexts", draw_contexts, history),
        "contexts_outside": part("The contexts out of range", contexts_outside, history),
        "growth": part("The figure of the repository", draw_growth, history),
        "versions": part("The table of versions", versions, history),
    }


def lived(history: History) -> str:
    """What the twin lived through, in a few sentences."""
    rows = len(history.record)
    if not rows:
        return "The record has no rows: nothing happened to the twin."
    first, last = (_when(history, row) for row in (0, -1))
    used = min(history.calibration_rows, rows)
    began = f"calibrated on the first {fixed(used, 0)} of them" if used < rows else "calibrated"
    said = [
        f"The run spans {fixed(rows, 0)} row{'s' if rows > 1 else ''}, from {first} to {last}.",
        f"The twin was {began}; level of integration {history.level}: {LEVELS[history.level]}.",
    ]
    counts = [
        f"{fixed(count, 0)} {words[count > 1]}"
        for kind, words in COUNTED.items()
        if (count := sum(event.kind == kind for event in history.events))
    ]
    if not any(event.kind == "alarm" for event in history.events):
        counts.insert(0, "no alarm")
    said.append(f"It saw {_listed(counts)}.")
    gaps = standardised(history)
    if np.isfinite(gaps).any():
        said.append(_gap_words(history, mean(gaps, axis=1)))
    if history.growth:
        stored = [fixed(history.growth[place][1], 0) for place in (0, -1)]
        grew = "did not change" if stored[0] == stored[1] else f"grew to {stored[1]}"
        said.append(f"Its repository began with {stored[0]} simulations and {grew}.")
    if len(history.versions) > 1:
        held = [str(one.number) for one in history.versions if one.in_force]
        said += [f"Version {held[0]} of the model is in force."] if held else []
    return " ".join(said)


def _gap_words(history: History, by_row: FloatArray) -> str:
    calibration = usual(by_row[: history.calibration_rows])
    if len(phases(history)) == 1:
        return f"The gap was {number(usual(by_row))}."
    line, last = smoothed(history, by_row), phases(history)[-1]
    most = int(np.nanargmax(line))
    return (
        f"The gap was {number(calibration)} on the rows of the calibration, at most "
        f"{number(float(line[most]))} (smoothed, at {_when(history, most)}), and "
        f"{number(usual(by_row[last.first : last.last]))} on the last rows{_mended(history)}; "
        "noise alone gives 1."
    )


def _mended(history: History) -> str:
    """What the last change of the twin made of the gap, where nothing was measured after it."""
    changes = [one for one in history.events if one.kind in CHANGES and one.gap_after is not None]
    if not changes or changes[-1].row < len(history.record) - 1:
        return ""
    last = changes[-1]
    assert last.gap_after is not None
    return f" as they came in, {number(last.gap_after)} after the {last.kind} at the end"


def _when(history: History, row: int) -> str:
    return when(history.record.time_label(float(history.record.time[row])))


def _listed(parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def events(history: History) -> list[dict[str, str]]:
    """The table of events without commands; a long series of one kind stands on one line."""
    found = []
    happened = (event for event in history.events if event.kind != "command")
    for kind, series in groupby(happened, key=lambda event: event.kind):
        several = list(series)
        if len(several) <= MOST_IN_A_ROW or kind in DECIDED:
            found += [_event(event) for event in several]
            continue
        first, last = several[0], several[-1]
        one = _event(first)
        one["until"] = when(last.time)
        one["words"] = f"{fixed(len(several), 0)} {COUNTED.get(kind, (kind, kind))[1]}; the first: "
        one["words"] += first.words
        one["sensors"] = _names(dict.fromkeys(name for e in several for name in e.sensors))
        one["gap"] = _change(first.gap_before, last.gap_after)
        found.append(one)
    return found


def asked(history: History) -> list[dict[str, str]]:
    """The table of what people asked for."""
    return [_event(event) for event in history.events if event.kind == "command"]


def _event(event: Event) -> dict[str, str]:
    return {
        "kind": event.kind,
        "time": when(event.time),
        "row": fixed(event.row, 0),
        "until": "",
        "words": event.words,
        "sensors": _names(dict.fromkeys(event.sensors)),
        "gap": _change(event.gap_before, event.gap_after),
    }


def _names(names: dict[str, None]) -> str:
    more = len(names) - MOST_SENSORS
    said = ", ".join(list(names)[:MOST_SENSORS])
    return f"{said} and {more} more" if more > 0 else said


def _change(before: float | None, after: float | None) -> str:
    if before is None and after is None:
        return ""
    return " → ".join(DASH if gap is None else number(gap) for gap in (before, after))


def contexts_outside(history: History) -> list[str]:
    """Contexts that left the range that the model states, in words."""
    found = []
    for column in drawn_contexts(history):
        outside = np.flatnonzero(out_of_range(history, column))
        if len(outside):
            first, last = (_when(history, row) for row in outside[[0, -1]])
            span = f"at {first}" if len(outside) == 1 else f"from {first} to {last}"
            count = f"{fixed(len(outside), 0)} row{'s' if len(outside) > 1 else ''}"
            found.append(f"{history.contexts[column]} on {count}, {span}")
    return found


def versions(history: History) -> list[dict[str, Any]]:
    """The table of model versions."""
    found = []
    for one in history.versions:
        gain = DASH if one.gain is None else number(one.gain)
        if one.gain is not None and one.gain_ci90 is not None:
            gain += f" [{number(one.gain_ci90[0])}, {number(one.gain_ci90[1])}]"
        found.append(
            {
                "number": one.number,
                "time": when(one.time),
                "causes": one.causes,
                "gain": gain,
                "in_force": one.in_force,
            }
        )
    return found
