"""Versions of the model: what each has, how large the gap was under it, and the way back."""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from rga.dashboard.in_force import InForce, SpanInForce, in_force, spans_in_force
from rga.dashboard.pages.heading import heading
from rga.dashboard.surroundings import SeenTwin
from rga.dashboard.svg.gap_level import GapLevel, gap_level
from rga.findings.phrases import effect_words
from rga.operation.reading.twin_reading import TwinReading
from rga.quantities import DASH, number
from rga.report.figures.of_run.run_gap import mean
from rga.twin.repository import ModelVersion

#: entries of which the gap under a version is a mean
ENTRIES = 64
#: by which the rows of a stretch lie behind the row at which its version came into force [s]
BEHIND = 1e-3


@dataclass(frozen=True)
class VersionRow:
    """A version of the model.

    Attributes:
        number: of it.
        spans: in which it was in force, the first first; none: it never was.
        effects: beyond the model as given, in words.
        added, removed: of these, beside the version before it in the table.
        gain: on held-out rows, with its interval, in words.
        gap, level: while it was in force last; of one that is so for no row yet, as it follows the
            latest rows.
        in_force: whether it is now.
        sha256: of its model file.
    """

    number: int
    spans: tuple[SpanInForce, ...]
    effects: tuple[str, ...]
    added: tuple[str, ...]
    removed: tuple[str, ...]
    gain: str
    gap: str
    level: GapLevel
    in_force: bool
    sha256: str


def versions_page(seen: SeenTwin) -> dict[str, Any]:
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
    last = 0.0 if now.time is None else seen.reading.elapsed(now.time)
    stretches, spans = in_force(view), spans_in_force(view, twin.station.start)
    rows: list[VersionRow] = []
    before: tuple[str, ...] = ()
    for one in view.versions():
        effects = tuple(effect_words(effect) for effect in json.loads(one.causes).values())
        own = [a for a in stretches if a.version == one.number and a.until(last) > a.begin]
        gap = _gap(seen.reading, own[-1], last) if own else None
        if not own and one.number == now.version:
            gap = now.recent
        rows.append(
            VersionRow(
                one.number,
                tuple(spans.get(one.number, ())),
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


def _gap(reading: TwinReading, stretch: InForce, last: float) -> float | None:
    """Mean of the gap over the sensors and the rows of a stretch, of which one may be the last."""
    begin = stretch.begin + BEHIND if stretch.begin else 0.0
    series = reading.series(begin, stretch.until(last) + BEHIND, ENTRIES)
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
