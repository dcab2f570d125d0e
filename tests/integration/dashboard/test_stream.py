"""What a stream tells: all that has happened since, or that it is too long ago."""

import asyncio
from asyncio import to_thread
from datetime import timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rga.dashboard.api import stream
from rga.dashboard.api.stream import _messages, _number
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.operation.service import Service
from rga.records import Record
from served.bridges import lived, packets_of

from .conftest import START


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


def test_a_browser_that_reads_slowly_is_told_of_all_rows_in_one_message(
    service: Service, lived_through: tuple[Path, Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stream, "LOOK", 0.0)
    seen, twin = Surroundings(service).twin("east"), service.twins["east"]
    ending = SimpleNamespace(app=SimpleNamespace(state=SimpleNamespace(is_ending=lambda: False)))
    later = packets_of(lived_through[1], START + timedelta(hours=20), "later")

    async def read() -> list[Any]:
        messages = stream.stream(seen, ending)  # type: ignore[arg-type]
        found = [await anext(messages)]
        # Nothing is read while rows come by several steps.
        for first in range(0, 60, 10):
            await to_thread(lived, twin, later[first : first + 10])
        while found[-1].event != "row" or len(found) == 1:
            found.append(await anext(messages))
        await messages.aclose()
        return found

    before = seen.reading.now()
    assert before is not None
    *_, last = asyncio.run(read())
    now = seen.reading.now()
    assert now is not None
    assert last.data.merged == now.rows - before.rows > 10
    assert last.data.now == now
