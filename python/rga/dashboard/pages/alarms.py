"""Alarms: what is raised, and the rows around each time that a twin got out of step."""

from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import Any

import numpy as np

from rga.dashboard.alarm_desk import SHELVES, alarms_of
from rga.dashboard.pages.happened import Happened, Past
from rga.dashboard.pages.heading import heading
from rga.dashboard.surroundings import SeenTwin
from rga.dashboard.svg.chart import POINTS, Column, TimeChart, Window, chart
from rga.twin.history import Event
from rga.twin.repository import RunView

#: rows on either side of an alarm that are shown, and sensors
AROUND, SENSORS = 36, 4
#: times out of step, and alarms that are closed, of the page
LISTED, CLOSED = 12, 20


@dataclass(frozen=True)
class OutOfStep:
    """A time that a twin got out of step.

    Attributes:
        event: the alarm.
        sensors: that show it.
        chart: their gaps around it; None where nothing is left of these rows.
        then: what came of it, in the order in which it happened.
    """

    event: Happened
    sensors: tuple[str, ...]
    chart: TimeChart | None
    then: list[Happened]


def alarms_page(seen: SeenTwin) -> dict[str, Any]:
    """What the page of alarms shows.

    Raises:
        InputError: the repository of the twin cannot be read.
    """
    now, view = seen.reading.now(), seen.reading.view()
    events = seen.reading.events()
    places = [place for place, one in enumerate(events) if one.kind == "alarm"]
    past = Past(seen.name, view, events)
    found = []
    for place, following in pairwise([*places, len(events)]):
        one = events[place]
        then = [later for later in events[place + 1 : following] if later.kind != "novel context"]
        found.append(
            OutOfStep(
                past.listed([one])[0],
                one.sensors,
                None if view is None else _around(seen, view, one, past),
                past.listed(then)[::-1],
            )
        )
    return {
        "heading": heading(seen, now),
        "tab": "/alarms",
        "alarms": alarms_of(seen.alarms, seen.name, CLOSED),
        "shelves": tuple(SHELVES),
        "found": found[::-1][:LISTED],
        "omitted": max(0, len(found) - LISTED),
    }


def _around(seen: SeenTwin, view: RunView, alarm: Event, past: Past) -> TimeChart | None:
    """The gaps of the sensors that show it, in the rows around an alarm."""
    first, last = max(0, alarm.row - AROUND), min(view.rows, alarm.row + AROUND + 1)
    time = view.measured(first, last).time
    twin = seen.reading.twin
    if not len(time) or twin is None:
        return None
    series = seen.reading.series(float(time[0]), float(time[-1]) + 1e-3, POINTS)
    assert series is not None  # it has begun
    start = datetime.fromisoformat(str(twin.station.start))
    window = Window(start, float(time[0]), float(time[-1]))
    columns = []
    for name in alarm.sensors[:SENSORS]:
        values = np.asarray(series.gap.mean[:, series.sensors.index(name)], dtype=float)
        columns.append(Column(name, "gap", values, values, values))
    return chart(
        "Gap of the sensors that show it first",
        "",
        series.gap.time,
        columns,
        window,
        marks=past.marks([alarm], window),
        logarithmic=True,
    )
