"""What a stream tells: all that has happened since, or that it is too long ago."""

from typing import Any

import pytest

from rga.dashboard.api import stream
from rga.dashboard.api.stream import _messages, _number
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.operation.service import Service


@pytest.fixture
def seen(service: Service) -> SeenTwin:
    return Surroundings(service).twin("east")


def told(seen: SeenTwin, since: int | None) -> tuple[list[tuple[str | None, Any]], int | None]:
    messages, step = _messages(seen, since)
    return [(one.event, one.data) for one in messages], step


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
    for since in (1, now.steps // 2, now.steps - 1):
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
    monkeypatch.setattr(stream, "MOST_STEPS", 3)
    assert told(seen, now.steps - 3)[0][0][0] != "reload"
    assert told(seen, now.steps - 4)[0][0][0] == "reload"


@pytest.mark.parametrize(
    ("given", "step"),
    [(None, None), ("12", 12), ("", -1), ("-3", -1), ("٣", -1), ("9" * 40, -1), ("x", -1)],
)
def test_what_a_browser_sends_is_a_step_or_none(given: str | None, step: int | None) -> None:
    assert _number(given) == step
