"""How an alarm goes on with other words, and ends with those that say what came of it."""

from datetime import timedelta
from pathlib import Path

import pytest

from rga.operation.alarms.condition import Condition, ConditionKey, Ending
from served.alarm_book import GAP, Desk, wrong
from served.service_times import NOON

PROPOSED = ConditionKey("east", "proposal", "proposal", "1")
ACCEPTED = {PROPOSED: Ending("proposal 2 was accepted by Ada", "Ada", "surveyed")}


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


def waits(number: int) -> Condition:
    return Condition(PROPOSED, f"proposal {number} waits", NOON, is_renewed=True)


def test_an_alarm_goes_on_with_newer_words_and_tells_nobody(desk: Desk) -> None:
    desk.see(waits(1))
    desk.book.acknowledge(1, "Bob")
    desk.see(waits(2))
    assert desk.states == [(1, "acknowledged")]
    assert desk.book.of(1).words == "proposal 2 waits"
    assert [one.change for one in desk.book.life(1)] == ["raised", "acknowledged", "renewed"]
    assert desk.told == [(1, "raised"), (1, "acknowledged")]
    desk.see(waits(2))
    assert len(desk.book.life(1)) == 3


def test_words_of_other_alarms_stay_as_they_were_raised(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.see(Condition(GAP, "other words", NOON))
    assert desk.book.of(1).words == wrong(GAP).words
    assert [one.change for one in desk.book.life(1)] == ["raised"]


def test_who_makes_an_end_of_it_has_acknowledged_it(desk: Desk) -> None:
    desk.see(waits(2))
    desk.see(endings=ACCEPTED)
    assert desk.states == []
    alarm = desk.book.of(1)
    assert (alarm.state, alarm.acknowledged_by) == ("closed", "Ada")
    assert alarm.words == "proposal 2 was accepted by Ada"
    assert [(one.change, one.who, one.why) for one in desk.book.life(1)][1:] == [
        ("acknowledged", "Ada", "surveyed"),
        ("cleared", None, ""),
    ]
    # An end that is known of long ago raises and clears nothing.
    desk.see(endings=ACCEPTED)
    assert len(desk.told) == 3


def test_who_acknowledged_it_before_stays_named(desk: Desk) -> None:
    desk.see(waits(2))
    desk.book.acknowledge(1, "Bob")
    desk.see(endings=ACCEPTED)
    alarm = desk.book.of(1)
    assert (alarm.state, alarm.acknowledged_by) == ("closed", "Bob")
    assert alarm.words == "proposal 2 was accepted by Ada"


def test_what_was_decided_comes_back_from_no_shelf(desk: Desk) -> None:
    desk.see(waits(2))
    desk.book.shelve(1, desk.clock.now() + timedelta(hours=1), "Bob")
    desk.see(endings=ACCEPTED)
    assert desk.book.of(1).state == "closed"
    desk.clock.pass_by(3600)
    desk.book.end_shelves()
    assert desk.states == []


def test_what_ended_by_itself_waits_for_somebody_who_has_seen_it(desk: Desk) -> None:
    desk.see(waits(1))
    desk.see(endings={PROPOSED: Ending("proposal 1 is withdrawn")})
    assert desk.states == [(1, "cleared")]
    assert desk.book.of(1).words == "proposal 1 is withdrawn"
    # Proposed again before anybody has, it is the same alarm.
    desk.see(waits(2))
    assert desk.states == [(1, "raised")]
    assert desk.book.of(1).words == "proposal 2 waits"
