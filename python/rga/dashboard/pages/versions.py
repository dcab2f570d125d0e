"""Versions of the model: what each has, how large the gap was under it, and the way back."""

import json
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from rga.dashboard.pages.heading import heading
from rga.dashboard.pages.surroundings import Seen
from rga.dashboard.svg.gap_level import GapLevel, gap_level
from rga.findings.phrases import effect_words
from rga.operation.reading.twin_now import moment
from rga.operation.reading.twin_reading import TwinReading
from rga.quantities import DASH, number
from rga.report.figures.of_run.run_gap import mean
from rga.twin.repository import ModelVersion, RunView

#: entries of which the gap under a version is a mean
ENTRIES = 64


@dataclass(frozen=True)
class VersionRow:
    """A version of the model.

    Attributes:
        number: of it.
        time: from when on it was first in force; None: it never was.
        effects: beyond the model as given, in words.
        added, removed: of these, beside the version before it in the table.
        gain: on held-out rows, with its interval, in words.
        gap, level: while it was in force last.
        in_force: whether it is now.
        sha256: of its model file.
    """

    number: int
    time: datetime | None
    effects: tuple[str, ...]
    added: tuple[str, ...]
    removed: tuple[str, ...]
    gain: str
    gap: str
    level: GapLevel
    in_force: bool
    sha256: str


def versions_page(seen: Seen) -> dict[str, Any]:
    """What the page of versions shows.

    Raises:
        InputError: the repository of the twin cannot be read.
    """
    now, view, twin = seen.reading.now(), seen.reading.view(), seen.reading.twin
    found: dict[str, Any] = {
        "heading": heading(seen, now),
        "tab": "/versions",
        "version": 0 if now is None else now.version,
        "versions": [],
    }
    if now is None or view is None or twin is None:
        return found
    stretches = _stretches(seen.reading, view)
    rows: list[VersionRow] = []
    before: tuple[str, ...] = ()
    for one in view.versions():
        effects = tuple(effect_words(effect) for effect in json.loads(one.causes).values())
        own = [stretch for stretch in stretches if stretch[0] == one.number]
        gap = _gap(seen.reading, *own[-1][1:]) if own else None
        rows.append(
            VersionRow(
                one.number,
                moment(twin.station.start, own[0][1]) if own else None,
                effects,
                tuple(words for words in effects if words not in before),
                tuple(words for words in before if words not in effects),
                _gain_words(one),
                DASH if gap is None else number(gap, 2),
                gap_level(gap),
                one.number == now.version,
                one.model_sha256,
            )
        )
        before = effects
    return found | {"versions": rows[::-1]}


def _stretches(reading: TwinReading, view: RunView) -> list[tuple[int, float, float]]:
    """Version, and from when to when it was in force [s since the first row]."""
    begun = []
    for row, version in view.in_force():
        time = view.measured(row, row + 1).time
        begun.append((float(time[0]) if len(time) and row else 0.0, version))
    now = reading.now()
    last = 0.0 if now is None or now.time is None else reading.elapsed(now.time) + 1e-3
    ends = [*(first for first, _ in begun[1:]), last]
    return [(version, first, end) for (first, version), end in zip(begun, ends, strict=True)]


def _gap(reading: TwinReading, begin: float, end: float) -> float | None:
    """Mean of the gap over the sensors and a time."""
    series = reading.series(begin, end, ENTRIES)
    if series is None:
        return None
    found = float(mean(np.asarray(series.gap.mean, dtype=float)))
    return found if np.isfinite(found) else None


def _gain_words(one: ModelVersion) -> str:
    if one.gain is None:
        return DASH
    interval = ""
    if one.gain_ci90 is not None:
        interval = f" [{number(one.gain_ci90[0])}, {number(one.gain_ci90[1])}]"
    return f"{number(one.gain)}{interval}"
