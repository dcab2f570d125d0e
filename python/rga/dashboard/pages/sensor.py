"""A sensor: what was measured and simulated over a time, what is missing, and why."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.dashboard.pages.happened import Past
from rga.dashboard.pages.heading import heading
from rga.dashboard.pages.sensors_now import (
    SensorRow,
    farthest_first,
    out_of_use_words,
    sensor_rows,
)
from rga.dashboard.pages.times import utc_words
from rga.dashboard.pages.windows import SPANS, ChosenWindow, chosen_window
from rga.dashboard.surroundings import SeenTwin
from rga.dashboard.svg.chart import POINTS, ChartMark, Column, TimeChart, chart, column
from rga.operation.reading.twin_now import RECENT, TwinNow
from rga.operation.reading.twin_reading import Series
from rga.quantities import scale
from rga.twin.repository import RunView
from rga.twin.restore import standing_of

#: rows of a window that are counted at most, the latest
COUNTED = 20_000


@dataclass(frozen=True)
class Quality:
    """How much came of a sensor within a time: rows, those without a reading, in words."""

    rows: int
    missing: int
    share: str


def sensors_page(seen: SeenTwin) -> dict[str, Any]:
    """What the table of all sensors shows.

    Raises:
        InputError: the repository of the twin cannot be read.
    """
    now, twin = seen.reading.now(), seen.reading.twin
    rows = [] if now is None or twin is None else sensor_rows(twin.given, now)
    return {
        "heading": heading(seen, now),
        "tab": "/sensors",
        "rows": farthest_first(rows),
        "version": 0 if now is None else now.version,
        "out_of_use": "" if now is None else out_of_use_words(now),
    }


def sensor_page(seen: SeenTwin, name: str, query: Mapping[str, str]) -> dict[str, Any]:
    """What the page of a sensor shows.

    Args:
        seen: its twin.
        name: of the sensor.
        query: of the address, as of `chosen_window`.

    Raises:
        KeyError: the twin has no such sensor.
        InputError: the repository of the twin cannot be read.
        NotUnderstood: there is no such stretch of time.
    """
    now, twin, view = seen.reading.now(), seen.reading.twin, seen.reading.view()
    if now is None or twin is None or view is None or name not in now.sensors:
        raise KeyError(name)
    row = next(one for one in sensor_rows(twin.given, now) if one.name == name)
    found: dict[str, Any] = {
        "heading": heading(seen, now),
        "tab": "/sensors",
        "row": row,
        "version": now.version,
        "charts": [],
        "spans_known": tuple(SPANS),
        "span": "",
        "quality": None,
        "out_of_use": _out_of_use(view, name),
    }
    if now.time is None:
        return found
    start = datetime.fromisoformat(str(twin.station.start))
    chosen = chosen_window(query, start, now.time)
    series = seen.reading.series(chosen.window.begin, chosen.window.end, POINTS)
    assert series is not None  # it has begun
    events = seen.reading.events()
    happened = Past(seen.name, view, events).marks(events, chosen.window)
    unit = twin.given.sensors[name].unit
    return found | {
        "charts": _charts(series, row, unit, now, chosen, happened),
        "span": chosen.span,
        "begin": start + timedelta(seconds=chosen.window.begin),
        "end": start + timedelta(seconds=chosen.window.end),
        "quality": _quality(view, twin.station.channels.index(name), chosen),
        "recent": RECENT,
        "newest": now.time,
    }


def _charts(
    series: Series,
    row: SensorRow,
    unit: str,
    now: TwinNow,
    chosen: ChosenWindow,
    happened: list[ChartMark],
) -> list[TimeChart]:
    place = series.sensors.index(row.name)
    known = np.asarray(series.measured.mean[:, place], dtype=float)
    factor, shown = scale(unit, float(np.nanmax(np.abs(known), initial=0.0)))
    measured = _scaled(column("measured", "measured", series.measured, place), factor)
    simulated = _scaled(column("simulated", "simulated", series.simulated, place), factor)
    apart = _on_times(series.measured.time, measured.mean, series.simulated.time, simulated.mean)
    residual = Column("difference", "residual", apart, apart, apart)
    window, time = chosen.window, series.measured.time
    both = [measured, _moved(simulated, series.simulated.time, time)]
    gap = column("gap", "gap", series.gap, place)
    return [
        chart("Measured and simulated", shown, time, both, window, marks=happened),
        chart("Measured less simulated", shown, time, [residual], window),
        chart(
            "Gap: square of the difference over the variance of the noise",
            "",
            series.gap.time,
            [gap],
            window,
            logarithmic=True,
        ),
    ]


def _scaled(one: Column, factor: float) -> Column:
    mean = one.mean * factor
    if one.least is one.mean or np.array_equal(one.least, one.most, equal_nan=True):
        return Column(one.name, one.look, mean, mean, mean)
    return Column(one.name, one.look, mean, one.least * factor, one.most * factor)


def _on_times(time: FloatArray, values: Any, other: FloatArray, others: Any) -> FloatArray:
    """Differences of values, where both have an entry of one time."""
    found = np.full(len(time), np.nan)
    _, here, there = np.intersect1d(time, other, return_indices=True)
    found[here] = np.asarray(values)[here] - np.asarray(others)[there]
    return found


def _moved(one: Column, time: FloatArray, onto: FloatArray) -> Column:
    """A column at the entries of others."""
    nothing = np.zeros(len(onto))
    mean, least, most = (
        -_on_times(onto, nothing, time, part) for part in (one.mean, one.least, one.most)
    )
    same = one.least is one.mean
    return Column(one.name, one.look, mean, mean if same else least, mean if same else most)


def _quality(view: RunView, place: int, chosen: ChosenWindow) -> Quality:
    last = view.row_at(chosen.window.end) + 1
    first = max(0, view.row_at(chosen.window.begin), last - COUNTED)
    readings = view.measured(first, last).readings
    missing = int(np.isnan(readings[:, place]).sum()) if len(readings) else 0
    share = f"{100 * missing / len(readings):.1f} %" if len(readings) else "–"
    return Quality(len(readings), missing, share)


def _out_of_use(view: RunView, name: str) -> list[str]:
    """Why a sensor is not used, or was not for a time."""
    standing = standing_of(view)
    found = []
    if name in standing.stuck:
        found.append("It is not watched: its readings stood still while the twin was calibrated.")
    for sensor, since, until in standing.excluded:
        if sensor == name:
            end = "on" if until is None else f"to {_clock(until)}"
            found.append(f"It is out of use from {_clock(since)} {end}{_asked_by(view, name)}.")
    return found


def _clock(seconds: float) -> str:
    return f"{utc_words(datetime.fromtimestamp(seconds, UTC))} UTC"


def _asked_by(view: RunView, name: str) -> str:
    """Who asked for it last, and why."""
    asked = [
        one for one in view.commands() if one.kind == "exclude" and one.body.get("sensor") == name
    ]
    if not asked:
        return ""
    why = f": {asked[-1].why}" if asked[-1].why else ""
    return f", as {asked[-1].who} asked{why}"
