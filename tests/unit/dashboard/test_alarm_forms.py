"""What a form does about an alarm."""

from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest

from rga.dashboard.alarm_desk import NoAlarms, act, alarms_of
from rga.errors import InputError

NOW = datetime(2026, 11, 23, tzinfo=UTC)


@dataclass(frozen=True)
class StandingAlarm:
    """An alarm as a service has it."""

    id: int
    twin: str | None
    state: str
    raised_at: datetime = NOW
    kind: str = "gap"
    words: str = "out of sync"
    sensors: tuple[str, ...] = ()
    since: datetime = NOW
    cleared_at: datetime | None = None
    acknowledged_at: datetime | None = None
    acknowledged_by: str | None = None
    shelved_until: datetime | None = None
    shelved_by: str | None = None


@dataclass
class WrittenDesk:
    """A desk that keeps what it is asked for."""

    alarms: list[StandingAlarm]
    done: list[tuple[Any, ...]] = field(default_factory=list)

    def open(self) -> list[StandingAlarm]:
        return [one for one in self.alarms if one.state != "closed"]

    def all(self, limit: int) -> list[StandingAlarm]:
        return self.alarms[:limit]

    def acknowledge(self, id: int, who: str, why: str = "") -> None:
        self.done.append(("acknowledge", id, who, why))

    def shelve(self, id: int, until: datetime, who: str, why: str = "") -> None:
        self.done.append(("shelve", id, until, who, why))

    def unshelve(self, id: int, who: str, why: str = "") -> None:
        self.done.append(("unshelve", id, who, why))


@pytest.fixture
def desk() -> WrittenDesk:
    return WrittenDesk(
        [
            StandingAlarm(1, "east", "acknowledged"),
            StandingAlarm(2, "east", "raised", NOW - timedelta(hours=1)),
            StandingAlarm(3, "west", "raised"),
            StandingAlarm(4, None, "raised"),
            StandingAlarm(5, "east", "closed"),
        ]
    )


def test_those_that_nobody_has_seen_come_first(desk: WrittenDesk) -> None:
    assert [one.id for one in alarms_of(desk, "east")] == [2, 1]
    assert [one.id for one in alarms_of(desk, "east", 3)] == [2, 1, 5]
    assert [one.id for one in alarms_of(desk, None)] == [4]
    assert alarms_of(NoAlarms(), "east", 3) == []


def test_forms_do_what_they_say(desk: WrittenDesk) -> None:
    act(desk, "east", 2, {"do": "acknowledge", "why": "seen"}, "Ada", NOW)
    act(desk, "east", 2, {"do": "shelve", "for": "8 h", "why": "works"}, "Ada", NOW)
    act(desk, None, 4, {"do": "unshelve"}, "Ada", NOW)
    assert desk.done == [
        ("acknowledge", 2, "Ada", "seen"),
        ("shelve", 2, NOW + timedelta(hours=8), "Ada", "works"),
        ("unshelve", 4, "Ada", ""),
    ]


@pytest.mark.parametrize(
    ("twin", "number", "form"),
    [
        ("east", 3, {"do": "acknowledge"}),
        ("east", 5, {"do": "acknowledge"}),
        ("east", 2, {"do": "shelve", "for": "a year"}),
        ("east", 2, {"do": "delete"}),
        (None, 2, {"do": "acknowledge"}),
    ],
)
def test_what_cannot_be_done_is_told(
    desk: WrittenDesk, twin: str | None, number: int, form: dict[str, str]
) -> None:
    with pytest.raises(InputError):
        act(desk, twin, number, form, "Ada", NOW)
    with pytest.raises(InputError):
        act(NoAlarms(), twin, number, form, "Ada", NOW)
    assert desk.done == []
