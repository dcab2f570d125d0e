"""The fleet: a card for every bridge, those that need somebody first."""

from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from rga.dashboard.alarm_desk import SHELVES, UNSEEN, alarms_of
from rga.dashboard.pages.heading import Heading, heading, heading_of_damaged
from rga.dashboard.pages.sensors_now import out_of_use_words
from rga.dashboard.pages.times import DAY, age_words
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.dashboard.svg.chart import Window, sparkline
from rga.dashboard.svg.gap_level import GapLevel, gap_level
from rga.dashboard.svg.structure import Elevation, outline
from rga.errors import InputError
from rga.operation.alarms.operator_alarm import OperatorAlarm
from rga.quantities import number
from rga.report.figures.of_run.run_gap import mean

#: need of attention from which on a bridge can be left alone
CALM = 4
#: what the small line of a card shows [s], and its entries
SHOWN, ENTRIES = 30 * DAY, 120


@dataclass(frozen=True)
class BridgeCard:
    """A bridge of the fleet.

    Attributes:
        heading: its name and how it is.
        drawing: of the structure.
        gap, level: of the last rows, in words.
        line: path of the gap over 30 days.
        out_of_use: how many sensors are not watched, in words; empty: all are.
        version: of the model that is in force; 0: none.
        alarms: that are open, as the page of alarms lists them.
        unseen: those of them that nobody has acknowledged or put on a shelf.
        newest: time of the newest row.
        age: of it, in words.
    """

    heading: Heading
    drawing: Elevation
    gap: str
    level: GapLevel
    line: str
    out_of_use: str
    version: int
    alarms: int
    unseen: int
    newest: datetime | None
    age: str

    @property
    def needs_somebody(self) -> bool:
        """Whether somebody has to look: for how the bridge is, or for an alarm."""
        return self.heading.state.need < CALM or self.unseen > 0


def fleet_page(surroundings: Surroundings) -> dict[str, Any]:
    """What the page of the fleet shows."""
    cards = [_card(surroundings.twin(name)) for name in surroundings.names]
    cards.sort(key=_place)
    return {
        "cards": cards,
        "need": sum(one.needs_somebody for one in cards),
        "open_alarms": sum(one.alarms for one in cards),
        "alarms": alarms_of(surroundings.alarms, None),
        "shelves": tuple(SHELVES),
    }


def _place(card: BridgeCard) -> tuple[bool, int, str, str]:
    top = card.heading
    return not card.needs_somebody, top.state.need, top.structure.casefold(), top.twin


def _card(seen: SeenTwin) -> BridgeCard:
    try:
        return _readable(seen)
    except InputError as error:
        return _empty(seen, heading_of_damaged(seen, error))


def _readable(seen: SeenTwin) -> BridgeCard:
    now, twin = seen.reading.now(), seen.reading.twin
    if now is None or twin is None:
        return _empty(seen, heading(seen, now))
    line = ""
    if now.time is not None:
        last = seen.reading.elapsed(now.time)
        begin = max(0.0, last - SHOWN)
        series = seen.reading.series(begin, last + 1.0, ENTRIES)
        assert series is not None  # it has begun
        gap = mean(np.asarray(series.gap.mean, dtype=float), axis=1)
        start = datetime.fromisoformat(str(twin.station.start))
        line = sparkline(series.gap.time, gap, Window(start, begin, last + 1.0))
    alarms = alarms_of(seen.alarms, seen.name)
    return BridgeCard(
        heading=heading(seen, now),
        drawing=outline(seen.served.model),
        gap="" if now.recent is None else number(now.recent, 2),
        level=gap_level(now.recent),
        line=line,
        out_of_use=out_of_use_words(now),
        version=now.version,
        alarms=len(alarms),
        unseen=_unseen(alarms),
        newest=now.time,
        age="" if now.time is None else age_words(now.time, Surroundings.now()),
    )


def _empty(seen: SeenTwin, top: Heading) -> BridgeCard:
    alarms = alarms_of(seen.alarms, seen.name)
    return BridgeCard(
        heading=top,
        drawing=outline(seen.served.model),
        gap="",
        level=gap_level(None),
        line="",
        out_of_use="",
        version=0,
        alarms=len(alarms),
        unseen=_unseen(alarms),
        newest=None,
        age="",
    )


def _unseen(alarms: list[OperatorAlarm]) -> int:
    return sum(one.state in UNSEEN for one in alarms)
