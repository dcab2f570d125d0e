"""What a form does about an alarm."""

from datetime import timedelta
from pathlib import Path

import pytest

from rga.dashboard.alarm_desk import act, alarms_of
from rga.errors import InputError
from rga.operation.alarms import tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service_file import service_file
from served.service_times import NOON, SetClock

EVERY_KIND = frozenset({"gap", "quality", "source", "service", "proposal"})
AT_ONCE = dict.fromkeys(EVERY_KIND, (0.0, 0.0))


def wrong(twin: str | None, sensor: str) -> Condition:
    return Condition(ConditionKey(twin, "quality", "silent", sensor), f"{sensor} is silent", NOON)


@pytest.fixture
def clock() -> SetClock:
    return SetClock()


@pytest.fixture
def book(tmp_path: Path, clock: SetClock) -> AlarmBook:
    """Alarms 1, 2 and 5 of a twin, of which 1 is acknowledged and 5 closed, 3 and 4 of others."""
    found = AlarmBook(service_file(tmp_path, tables.metadata), AT_ONCE, clock)  # type: ignore[arg-type]
    shown: dict[str | None, list[Condition]] = {"east": [], "west": [], None: []}

    def see(twin: str | None, *conditions: Condition) -> None:
        found.observe(twin, Observation(conditions, EVERY_KIND))
        clock.pass_by(60)

    for twin, sensor in (("east", "D1"), ("east", "D2"), ("west", "D1"), (None, "disk")):
        shown[twin].append(wrong(twin, sensor))
        see(twin, *shown[twin])
    see("east", *shown["east"], wrong("east", "D3"))
    found.acknowledge(1, "Bo")
    found.acknowledge(5, "Bo")
    see("east", *shown["east"])
    return found


def test_those_that_nobody_has_seen_come_first(book: AlarmBook) -> None:
    assert [one.id for one in alarms_of(book, "east")] == [2, 1]
    assert [one.id for one in alarms_of(book, "east", 3)] == [2, 1, 5]
    assert [one.id for one in alarms_of(book, None)] == [4]
    assert alarms_of(book, "north", 3) == []


def test_forms_do_what_they_say(book: AlarmBook, clock: SetClock) -> None:
    act(book, "east", 2, {"do": "acknowledge", "why": "seen"}, "Ada", clock.now())
    assert (book.of(2).state, book.of(2).acknowledged_by) == ("acknowledged", "Ada")
    act(book, "east", 2, {"do": "shelve", "for": "8 h", "why": "works"}, "Ada", clock.now())
    assert book.of(2).shelved_until == clock.now() + timedelta(hours=8)
    act(book, None, 4, {"do": "shelve", "for": "1 h"}, "Ada", clock.now())
    act(book, None, 4, {"do": "unshelve"}, "Ada", clock.now())
    assert book.of(4).state == "raised"
    assert [one.why for one in book.life(2)][-2:] == ["seen", "works"]


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
    book: AlarmBook, clock: SetClock, twin: str | None, number: int, form: dict[str, str]
) -> None:
    before = book.all(10)
    with pytest.raises(InputError):
        act(book, twin, number, form, "Ada", clock.now())
    assert book.all(10) == before
