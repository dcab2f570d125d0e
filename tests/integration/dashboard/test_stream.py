"""What a stream tells: all that has happened since, or that it is too long ago."""

import asyncio
from datetime import UTC, datetime
from typing import Any

import pytest

from rga.dashboard.api import following
from rga.dashboard.api.following import FollowedTwin, StreamPlace, TwinLook
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service import Service


@pytest.fixture
def seen(service: Service) -> SeenTwin:
    return Surroundings(service).twin("east")


def told(seen: SeenTwin, since: int | None) -> tuple[list[tuple[str | None, Any]], int]:
    """What is told behind a step, and the step up to which it is told."""
    look = TwinLook.at(seen)
    messages, place = look.since(None if since is None else StreamPlace(since, look.change))
    assert {one.id for one in messages[:-1]} <= {None}
    assert [one.id for one in messages[-1:]] in ([], [str(place)])
    return [(one.event, one.data) for one in messages], place.step


def raise_alarm(service: Service, twin: str) -> int:
    """Raise an alarm of a twin; its number."""
    key = ConditionKey(twin, "gap", "alarm", "twin")
    there = Condition(key, f"{twin} is out of step", datetime.now(UTC))
    service.alarms.observe(twin, Observation((there,), frozenset({"gap"})))
    return service.alarms.open()[-1].id


def test_a_new_stream_begins_with_the_newest_row(seen: SeenTwin) -> None:
    now = seen.reading.now()
    assert now is not None
    (only,), step = told(seen, None)
    assert (only[0], only[1].now, step) == ("row", now, now.steps)
    assert told(seen, step) == ([], step)


def test_what_was_missed_is_told_in_order(seen: SeenTwin) -> None:
    now, view = seen.reading.now(), seen.reading.view()
    assert now is not None
    assert view is not None
    rows, events = 0, 0
    for since in (0, now.steps // 2, now.steps - 1):
        before = view.at_step(since)
        messages, step = told(seen, since)
        assert step == now.steps
        words = [data.words for kind, data in messages if kind == "event"]
        assert words == [one.words for one in view.events()][len(before.events()) :]
        assert messages[-1][0] == "row"
        assert messages[-1][1].merged == now.rows - before.rows
        rows, events = rows + messages[-1][1].merged, events + len(words)
    assert rows > 50
    assert events > 3


def test_a_proposal_is_told_once(seen: SeenTwin) -> None:
    now = seen.reading.now()
    assert now is not None
    kinds = [kind for kind, _ in told(seen, 1)[0]]
    assert kinds.count("proposal") == 1
    assert "proposal" not in [kind for kind, _ in told(seen, now.steps - 1)[0]]


@pytest.mark.parametrize("since", [-1, 10**9])
def test_what_is_no_step_of_the_twin_is_to_be_read_anew(seen: SeenTwin, since: int) -> None:
    assert [kind for kind, _ in told(seen, since)[0]] == ["reload", "row"]


def test_who_was_away_for_long_is_to_read_anew(
    seen: SeenTwin, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = seen.reading.now()
    assert now is not None
    monkeypatch.setattr(following, "MOST_MISSED", 3)
    assert told(seen, now.steps - 3)[0][0][0] != "reload"
    assert told(seen, now.steps - 4)[0][0][0] == "reload"


@pytest.mark.parametrize("given", ["", "12", "-3.1", "٣.1", f"{'9' * 40}.1", "1.2.3", "x"])
def test_what_a_browser_sends_that_is_no_place_is_to_be_read_anew(
    seen: SeenTwin, given: str
) -> None:
    assert TwinLook.at(seen).since(StreamPlace.of(given))[0][0].event == "reload"


def test_changes_of_alarms_of_the_twin_are_told(seen: SeenTwin, service: Service) -> None:
    before = TwinLook.at(seen).place
    raise_alarm(service, "west")
    number = raise_alarm(service, "east")
    service.alarms.acknowledge(number, "Ada", "seen")
    look = TwinLook.at(seen)
    messages, place = look.since(before)
    assert [(one.event, one.data.alarm, one.data.change) for one in messages] == [
        ("alarm", number, "raised"),
        ("alarm", number, "acknowledged"),
    ]
    assert messages[-1].id == str(place) == str(look.place)
    assert look.since(StreamPlace.of(str(place))) == ([], place)
    # A twin that has not begun has alarms too.
    west = TwinLook.at(Surroundings(service).twin("west"))
    assert [one.event for one in west.since(StreamPlace(0, 0))[0]] == ["alarm"]


def test_one_look_serves_all_who_follow(
    seen: SeenTwin, service: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[TwinLook] = []

    def look_at(seen: SeenTwin) -> TwinLook:
        looks.append(TwinLook(seen, seen.reading.now(), seen.alarms.last()))
        return looks[-1]

    monkeypatch.setattr(TwinLook, "at", look_at)
    monkeypatch.setattr(following, "LOOK", 3600.0)
    followed = FollowedTwin(seen)

    async def follow() -> list[Any]:
        return await asyncio.gather(*(followed.since(None) for _ in range(50)))

    answers = asyncio.run(follow())
    assert len(looks) == 1
    assert all(one == answers[0] for one in answers)
    raise_alarm(service, "east")
    monkeypatch.setattr(following, "LOOK", 0.0)
    place = answers[0][1]
    messages, later = asyncio.run(followed.since(place))
    assert [one.event for one in messages] == ["alarm"]
    assert asyncio.run(followed.since(later)) == ([], later)
