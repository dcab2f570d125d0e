"""A bridge: its drawing coloured by the gap, the gap over time, and its contexts."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from rga.dashboard.in_force import in_force
from rga.dashboard.pages.happened import Past
from rga.dashboard.pages.heading import heading, heading_as_of
from rga.dashboard.pages.sensors_now import farthest_first, out_of_use_words, sensor_rows
from rga.dashboard.pages.times import age_words, of_event
from rga.dashboard.pages.windows import (
    SPANS,
    NotUnderstood,
    asked_moment,
    asked_span,
    chosen_window,
)
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.dashboard.svg.chart import POINTS, Column, TimeChart, Window, chart
from rga.dashboard.svg.gap_level import LEVELS, gap_level
from rga.dashboard.svg.structure import elevations
from rga.model.schema import Model
from rga.operation.reading.twin_now import TwinNow
from rga.operation.reading.twin_reading import Series
from rga.quantities import number, quantity
from rga.report.drawing.places import Named, named_parts
from rga.report.figures.of_run.run_gap import mean

#: half of a 90 % interval [standard deviations]
HALF_WIDTH = 1.645
#: events that the page lists
LISTED = 8


@dataclass(frozen=True)
class ContextRow:
    """A context: its name, its value with its interval in words, and its path over time."""

    name: str
    value: str
    line: str


@dataclass(frozen=True)
class VersionStretch:
    """How long a version was in force: from one share of the width to another [%]."""

    number: int
    left: float
    width: float


def bridge_page(seen: SeenTwin, query: Mapping[str, str]) -> dict[str, Any]:
    """What the page of a bridge shows.

    Args:
        seen: its twin.
        query: of the address: `at` for the bridge as it stood, and what `chosen_window` takes.

    Raises:
        InputError: its repository cannot be read.
        NotUnderstood: there is no such time or stretch of it.
    """
    latest, twin = seen.reading.now(), seen.reading.twin
    found: dict[str, Any] = {"heading": heading(seen, latest), "tab": ""}
    if latest is None or twin is None or latest.time is None:
        return found | {"now": None}
    start = datetime.fromisoformat(str(twin.station.start))
    newest = seen.reading.elapsed(latest.time)
    at = asked_time(query, start)
    now = latest if at is None else seen.reading.as_of(at)
    if at is not None:
        found["heading"] = heading_as_of(seen, now, latest)
    found |= {
        "slider": {
            "most": round(newest, 3),
            "at": round(newest if at is None else min(at, newest), 3),
            "start": start,
            "moment": None if at is None else Window(start, 0, 1).moment(min(at, newest)),
        },
        "past": at is not None,
        "span": asked_span(query),
    }
    if now is None or now.time is None:
        return found | {"now": None}
    chosen = chosen_window(query, start, now.time)
    window = chosen.window
    series = seen.reading.series(window.begin, window.end, POINTS)
    assert series is not None  # it has begun
    events = [one for one in seen.reading.events() if of_event(one.time) <= now.time]
    past = Past(
        seen.name, seen.reading.view(), events, f"span={chosen.span}&" if chosen.span else ""
    )
    rows = sensor_rows(twin.given, now)
    weights = {name: one.recent or 0.0 for name, one in now.sensors.items()}
    return found | {
        "now": now,
        "gap": None if now.recent is None else number(now.recent, 2),
        "level_now": gap_level(now.recent),
        "age": age_words(now.time, Surroundings.now()),
        "out_of_use": out_of_use_words(now),
        "rows": rows,
        "sensor_of": {one.number: one for one in rows},
        "ranked": farthest_first(rows),
        "levels": LEVELS,
        "drawings": elevations(twin.given, _marked(now, twin.given), weights),
        "marked": now.undecided is not None,
        "strip": _strip(seen.name, series, window, past.marks(events, window)),
        "versions": _versions(seen, window, now),
        "contexts": _contexts(twin.given, now, series, window, twin.station.measured),
        "span": chosen.span,
        "spans_known": tuple(SPANS),
        "events": past.listed(events[-LISTED:]),
    }


def asked_time(query: Mapping[str, str], start: datetime) -> float | None:
    """Seconds from the first row to the time that an address asks for; None: it asks for none.

    Raises:
        NotUnderstood: it asks for what is neither a time nor seconds.
    """
    try:
        seconds = float(query.get("at", ""))
    except ValueError:
        moment = asked_moment(query, "at")
        return None if moment is None else max(0.0, (moment - start).total_seconds())
    if not np.isfinite(seconds):
        raise NotUnderstood("at: there is no such time")
    return max(0.0, seconds)


def context_words(value: float, spread: float, unit: str, measured: bool) -> str:
    """A context with its interval; one that is taken as it was measured has none.

    >>> context_words(21.3, 0.0, "", True), context_words(21.3, 0.0, "", False)
    ('21.3, measured', '21.3 [21.3, 21.3]')
    >>> context_words(21.3, 1.0, "", True)
    '21.3 [19.7, 22.9]'
    """
    if measured and spread == 0.0:
        return f"{quantity(value, unit)}, measured"
    half = HALF_WIDTH * spread
    return quantity(value, unit, (value - half, value + half))


def _marked(now: TwinNow, model: Model) -> Named:
    """Where the change is that waits for a decision."""
    effects = now.undecided.effects.values() if now.undecided else ()
    return named_parts(effects, model)


def _strip(twin: str, series: Series, window: Window, happened: Any) -> TimeChart:
    """The gap over time, mean over the sensors."""
    parts = [
        mean(np.asarray(one, dtype=float), axis=1)
        for one in (series.gap.mean, series.gap.least, series.gap.most)
    ]
    line = Column("gap", "gap", parts[0], parts[0], parts[0])
    return chart(
        "Gap, mean over the sensors",
        "",
        series.gap.time,
        [line],
        window,
        marks=happened,
        logarithmic=True,
    )


def _versions(seen: SeenTwin, window: Window, now: TwinNow) -> list[VersionStretch]:
    """The versions that were in force meanwhile, beside each other."""
    view = seen.reading.view()
    assert view is not None  # it has begun
    assert now.time is not None
    found = []
    last = min(seen.reading.elapsed(now.time), window.end)
    for one in in_force(view):
        ends = one.begin, one.until(last)
        left, right = (min(100.0, max(0.0, window.share(end))) for end in ends)
        if right > left:
            found.append(VersionStretch(one.version, round(left, 2), round(right - left, 2)))
    return found


def _contexts(
    model: Model, now: TwinNow, series: Series, window: Window, measured: tuple[str, ...]
) -> list[ContextRow]:
    found = []
    for place, name in enumerate(series.contexts):
        if name not in now.contexts:
            continue
        said = context_words(*now.contexts[name], model.context[name].unit, name in measured)
        values = np.asarray(series.inferred.mean[:, place], dtype=float)
        line = Column(name, "context", values, values, values)
        path = chart(name, "", series.inferred.time, [line], window).lines[0].path
        found.append(ContextRow(name, said, path))
    return found
