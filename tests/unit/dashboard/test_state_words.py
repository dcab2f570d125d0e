"""How a twin is, in words."""

from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any

import pytest

from rga.dashboard.surroundings import Feed
from rga.dashboard.twin_health import STATES, damaged, state_of
from rga.operation.reading.twin_now import TwinNow

NOON = datetime(2026, 11, 23, 12, tzinfo=UTC)
QUIET = Feed(silence=7200.0)
PROPOSAL = SimpleNamespace(effects={"low": {"kind": "support_settlement", "support": "east"}})


def standing(**changed: Any) -> TwinNow:
    """Where a twin stands that is in step, but for what is changed."""
    calm = {
        "rows": 80, "time": NOON, "stage": "watch", "version": 1, "causes": (), "recent": 1.2,
        "learns": False, "out_of_sync": False, "is_sought": False, "undecided": None,
    }  # fmt: skip
    now: TwinNow = SimpleNamespace(**calm | changed)  # type: ignore[assignment]
    return now


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (1, "1 row has come;"),
        (18, "18 rows have come;"),
        (12_345_678, "12345678 rows have come;"),
    ],
)
def test_rows_are_counted_in_whole_numbers(rows: int, words: str) -> None:
    now = standing(rows=rows, stage="gather", learns=True)
    assert state_of(now, Feed()).words.startswith(words)


@pytest.mark.parametrize(
    ("changed", "feed", "word"),
    [
        ({}, Feed(), "in step"),
        # Rows that wait for a full packet say nothing of who sends.
        ({}, Feed(lag=5), "in step"),
        ({}, Feed(lag=5, silence=7200.0), "silent"),
        ({}, QUIET, "silent"),
        ({}, Feed(lag=51), "behind"),
        ({}, Feed(backlog=36 * 3600.0), "behind"),
        ({"recent": None}, Feed(), "not watched"),
        ({"recent": None}, QUIET, "not watched"),
        ({"recent": None, "stage": "gather", "learns": True}, Feed(), "learning"),
        ({"recent": None, "learns": True}, Feed(), "learning"),
        ({"undecided": PROPOSAL}, QUIET, "to decide"),
        ({"undecided": PROPOSAL, "out_of_sync": True}, QUIET, "to decide"),
        ({"undecided": PROPOSAL, "out_of_sync": True, "is_sought": True}, Feed(), "alarm"),
        ({"out_of_sync": True, "is_sought": True}, QUIET, "alarm"),
        ({"out_of_sync": True}, Feed(lag=60, backlog=36 * 3600.0), "alarm"),
        ({"out_of_sync": True, "recent": None}, Feed(), "alarm"),
        ({"time": None}, QUIET, "no rows yet"),
    ],
)
def test_the_most_urgent_gives_the_word(changed: dict[str, Any], feed: Feed, word: str) -> None:
    found = state_of(standing(**changed), feed)
    assert (found.word, found.word in STATES) == (word, True)
    # What is silent is told beside whatever else there is.
    is_told = feed.silence is not None and word != "no rows yet"
    assert ("nothing has come for 2\u00a0h" in found.words) == is_told
    left = "Readings have left what the model lets expect"
    assert found.words.startswith(left) == bool(changed.get("out_of_sync"))


def test_an_alarm_that_is_open_is_shown_until_it_is_cleared() -> None:
    assert state_of(standing(), Feed(), alarmed=True).word == "alarm"
    assert state_of(standing(), Feed(), alarmed=False).word == "in step"


def test_old_data_that_arrive_are_not_silent() -> None:
    found = state_of(standing(), Feed(lag=70, backlog=37 * 3600.0))
    assert found.words == (
        "It is catching up: what its sources send is 37\u00a0h old. 70 rows wait to be played."
    )


def test_what_cannot_be_read_is_a_state_too() -> None:
    assert damaged("no file").word == STATES[0]
