"""The life of an alarm: whatever happens, the book says what a small model of it says."""

from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from rga.errors import InputError
from rga.operation.alarms.condition import (
    ConditionKey,
    Observation,
)
from served.alarm_book import GAP, JUDGED, SILENT, Desk, wrong


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


def test_it_is_raised_acknowledged_and_closed_when_all_is_well(desk: Desk) -> None:
    desk.see(wrong(GAP))
    assert desk.states == [(1, "raised")]
    found = desk.book.acknowledge(1, "Ada", "the bearing is being greased")
    assert (found.state, found.acknowledged_by) == ("acknowledged", "Ada")
    desk.see(wrong(GAP))
    assert desk.states == [(1, "acknowledged")]
    desk.see()
    assert desk.states == []
    assert desk.book.of(1).state == "closed"
    life = [(one.change, one.who, one.why) for one in desk.book.life(1)]
    assert life == [
        ("raised", None, ""),
        ("acknowledged", "Ada", "the bearing is being greased"),
        ("cleared", None, ""),
    ]
    desk.see(wrong(GAP))
    assert desk.states == [(2, "raised")]


def test_back_to_normal_it_waits_for_somebody_who_has_seen_it(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.see()
    assert desk.states == [(1, "cleared")]
    desk.see(wrong(GAP))
    assert desk.states == [(1, "raised")]
    desk.see()
    desk.book.acknowledge(1, "Ada")
    assert desk.states == []


def test_what_lasts_for_less_than_its_delay_is_no_alarm(desk: Desk) -> None:
    for _ in range(20):
        desk.see(wrong(SILENT))
        desk.see(wrong(SILENT), after=59)
        desk.see()
    assert desk.book.all(10) == ()
    desk.see(wrong(SILENT))
    desk.see(wrong(SILENT), after=60)
    assert desk.states == [(1, "raised")]
    desk.see()
    desk.see(after=119)
    desk.see(wrong(SILENT), after=0.5)
    desk.see()
    desk.see(after=119)
    assert desk.states == [(1, "raised")]
    desk.see(after=1)
    assert desk.states == [(1, "cleared")]


def test_delays_go_by_no_clock_that_is_set(desk: Desk) -> None:
    desk.see(wrong(SILENT))
    desk.clock.at += timedelta(days=30)
    desk.see(wrong(SILENT))
    assert desk.states == []


def test_every_class_is_acknowledged_by_itself(desk: Desk) -> None:
    down = ConditionKey("east", "source", "down", "http")
    desk.see(wrong(GAP), wrong(down))
    desk.book.acknowledge(2, "Ada")
    assert desk.states == [(1, "raised"), (2, "acknowledged")]


def test_a_shelf_ends_unacknowledged_and_tells_of_nothing_before(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.book.acknowledge(1, "Ada")
    desk.book.shelve(1, desk.clock.now() + timedelta(hours=1), "Ada", "works on the deck")
    told = list(desk.told)
    desk.see()
    desk.see(wrong(GAP))
    desk.restart()
    assert desk.told == told
    assert desk.states == [(1, "shelved")]
    desk.clock.pass_by(3600)
    desk.book.end_shelves()
    assert desk.states == [(1, "raised")]
    assert desk.told == [*told, (1, "unshelved")]
    desk.book.end_shelves()
    assert desk.told == [*told, (1, "unshelved")]


def test_what_is_well_when_its_shelf_ends_waits_to_be_seen(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.book.shelve(1, desk.clock.now() + timedelta(hours=1), "Ada")
    desk.see()
    assert desk.states == [(1, "shelved")]
    desk.book.unshelve(1, "Bob", "I want to know")
    assert desk.states == [(1, "cleared")]


def test_what_occurred_is_an_alarm_of_its_own_though_it_passed(desk: Desk) -> None:
    desk.see(occurred=(wrong(GAP), wrong(GAP)))
    changes = [one.change for one in desk.book.transitions(0, 10)]
    assert changes == ["raised", "cleared", "raised"]
    desk.see()
    assert desk.states == [(1, "cleared")]


def test_what_is_found_again_leaves_its_alarm_as_it_is(desk: Desk) -> None:
    first = replace(wrong(GAP), sensors=("D1", "D2"))
    desk.see(first, occurred=(first,))
    desk.book.acknowledge(1, "Ada")
    later = replace(first, words="since row 9", since=first.since + timedelta(hours=8))
    desk.see(later, occurred=(replace(later, is_again=True, sensors=("D2",)),))
    kept = desk.book.of(1)
    assert (kept.state, kept.words, kept.since) == ("acknowledged", first.words, first.since)
    assert len(desk.told) == 2
    # Where it shows at more sensors it is to be seen anew, and has begun when it did.
    desk.see(later, occurred=(replace(later, is_again=True, sensors=("D3", "D1")),))
    grown = desk.book.of(1)
    assert (grown.state, grown.words, grown.since) == ("raised", "since row 9", first.since)
    assert grown.sensors == ("D1", "D2", "D3")
    changes = [one.change for one in desk.book.life(1)]
    assert changes == ["raised", "acknowledged", "raised"]


@pytest.mark.parametrize("is_again", [False, True])
def test_what_comes_when_all_was_well_begins_when_it_does(desk: Desk, is_again: bool) -> None:
    desk.see(occurred=(wrong(GAP),))
    desk.see()
    assert desk.states == [(1, "cleared")]
    since = wrong(GAP).since + timedelta(hours=8)
    desk.see(occurred=(replace(wrong(GAP), since=since, is_again=is_again),))
    assert desk.book.of(1).since == since


def test_what_has_doubled_is_raised_anew(desk: Desk) -> None:
    missing = ConditionKey("east", "source", "missing", "http")
    desk.see(wrong(missing, size=1))
    desk.book.acknowledge(1, "Ada")
    desk.see(wrong(missing, size=1))
    assert desk.states == [(1, "acknowledged")]
    desk.see(wrong(missing, size=2))
    assert desk.states == [(1, "raised")]
    desk.see(wrong(missing, size=3))
    assert len(desk.told) == 3


def test_of_what_nothing_is_known_nothing_changes(desk: Desk) -> None:
    down = ConditionKey("east", "source", "down", "http")
    desk.see(wrong(down))
    desk.see(after=1000, judged=frozenset({"gap"}))
    assert desk.states == [(1, "raised")]


def test_alarms_of_a_twin_that_is_gone_are_cleared(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.book.observe(None, Observation((), JUDGED))
    desk.book.clear_others(["west", "east"])
    assert desk.states == [(1, "raised")]
    desk.book.clear_others(["west"])
    assert desk.states == [(1, "cleared")]


def test_transitions_are_followed_by_their_number(desk: Desk) -> None:
    desk.see(wrong(GAP))
    desk.see()
    first = desk.book.transitions(0, 1)
    assert [one.number for one in first] == [1]
    assert [one.change for one in desk.book.transitions(1, 10)] == ["cleared"]
    assert desk.book.transitions(2, 10) == ()
    assert [one.id for one in desk.book.all(10)] == [1]


@pytest.mark.parametrize(
    ("hours", "words"), [(0, "cannot be shelved"), (-1, "cannot be shelved"), (721, "within 30")]
)
def test_a_shelf_always_ends(desk: Desk, hours: float, words: str) -> None:
    desk.see(wrong(GAP))
    with pytest.raises(InputError, match=words):
        desk.book.shelve(1, desk.clock.now() + timedelta(hours=hours), "Ada")
    assert desk.states == [(1, "raised")]


def test_what_cannot_be_done_is_told(desk: Desk) -> None:
    desk.see(wrong(GAP))
    until = desk.clock.now() + timedelta(hours=1)
    for id in (2, 0, -1, 10**30):
        with pytest.raises(InputError, match=f"there is no alarm {id} "):
            desk.book.acknowledge(id, "Ada")
    with pytest.raises(InputError, match="nobody is named"):
        desk.book.acknowledge(1, " ")
    with pytest.raises(InputError, match="too long"):
        desk.book.acknowledge(1, "Ada", "x" * 1001)
    with pytest.raises(InputError, match="the time has no zone"):
        desk.book.shelve(1, datetime(2026, 11, 28), "Ada")
    with pytest.raises(InputError, match="is not shelved"):
        desk.book.unshelve(1, "Ada")
    desk.book.shelve(1, until, "Ada")
    with pytest.raises(InputError, match="is shelved by Ada"):
        desk.book.acknowledge(1, "Bob")
    desk.book.unshelve(1, "Ada")
    desk.book.acknowledge(1, "Ada")
    with pytest.raises(InputError, match="was acknowledged by Ada at 2026-11-27 12:00 UTC"):
        desk.book.acknowledge(1, "Bob")
    desk.see()
    with pytest.raises(InputError, match="is closed"):
        desk.book.shelve(1, until, "Ada")
    assert [one.change for one in desk.book.life(1)] == [
        "raised", "shelved", "unshelved", "acknowledged", "cleared",
    ]  # fmt: skip


@dataclass
class Expected:
    """What is to be said of one condition."""

    open: bool = False
    active: bool = False
    acknowledged: bool = False
    until: datetime | None = None
    told: int = 0
    ids: list[int] = field(default_factory=list)

    def settle(self) -> None:
        self.open = self.active or not self.acknowledged or self.until is not None


KEYS = (GAP, ConditionKey("east", "proposal", "proposal", "1"))


class AlarmLife(RuleBasedStateMachine):
    """Conditions come and go, people do what they like, the service is restarted."""

    def __init__(self) -> None:
        super().__init__()
        self._folder = TemporaryDirectory()
        self.desk = Desk(Path(self._folder.name))
        self.expected = {key: Expected(acknowledged=True) for key in KEYS}

    def teardown(self) -> None:
        self.desk.file.close()
        self._folder.cleanup()

    @rule(there=st.tuples(st.booleans(), st.booleans()))
    def observe(self, there: tuple[bool, bool]) -> None:
        self.desk.see(*(wrong(key) for key, one in zip(KEYS, there, strict=True) if one))
        for key, one in zip(KEYS, there, strict=True):
            known = self.expected[key]
            if one != known.active:
                known.told += known.until is None
                known.active = one
                if one:
                    known.acknowledged = False
            known.settle()

    @rule(key=st.sampled_from(KEYS))
    def acknowledge(self, key: ConditionKey) -> None:
        known = self.expected[key]
        possible = known.open and not known.acknowledged and known.until is None
        if self._try(key, lambda id: self.desk.book.acknowledge(id, "Ada"), possible):
            known.acknowledged, known.told = True, known.told + 1
            known.settle()

    @rule(key=st.sampled_from(KEYS), hours=st.integers(1, 720))
    def shelve(self, key: ConditionKey, hours: int) -> None:
        known, until = self.expected[key], self.desk.clock.now() + timedelta(hours=hours)
        if self._try(key, lambda id: self.desk.book.shelve(id, until, "Ada"), known.open):
            known.until, known.told = until, known.told + 1

    @rule(key=st.sampled_from(KEYS))
    def unshelve(self, key: ConditionKey) -> None:
        known = self.expected[key]
        possible = known.until is not None
        if self._try(key, lambda id: self.desk.book.unshelve(id, "Ada"), possible):
            known.until, known.acknowledged, known.told = None, False, known.told + 1
            known.settle()

    @rule(hours=st.integers(0, 400))
    def wait(self, hours: int) -> None:
        self.desk.clock.pass_by(3600 * hours)
        self.desk.book.end_shelves()
        for known in self.expected.values():
            if known.until is not None and known.until <= self.desk.clock.now():
                known.until, known.acknowledged, known.told = None, False, known.told + 1
                known.settle()

    @rule()
    def restart(self) -> None:
        self.desk.restart()

    @invariant()
    def the_book_says_the_same(self) -> None:
        said = {one.key: one for one in self.desk.book.open()}
        assert {key for key, one in self.expected.items() if one.open} == set(said)
        for key, alarm in said.items():
            known = self.expected[key]
            assert alarm.is_active == known.active
            assert (alarm.acknowledged_at is not None) == known.acknowledged
            assert alarm.shelved_until == known.until
        assert len(self.desk.told) == sum(one.told for one in self.expected.values())
        numbers = [one.number for one in self.desk.book.transitions(0, 10_000)]
        assert numbers == list(range(1, len(numbers) + 1))

    def _try(self, key: ConditionKey, does: object, possible: bool) -> bool:
        """Do something about the last alarm of a condition; whether that is possible."""
        ids = [one.id for one in self.desk.book.all(1000) if one.key == key]
        if not ids:
            return False
        if possible:
            does(max(ids))  # type: ignore[operator]
        else:
            with pytest.raises(InputError):
                does(max(ids))  # type: ignore[operator]
        return possible


TestAlarmLife = AlarmLife.TestCase
TestAlarmLife.settings = settings(max_examples=20, stateful_step_count=20, deadline=None)
