"""How a twin is, in words."""

from datetime import UTC, datetime
from types import SimpleNamespace

import pytest

from rga.dashboard.pages.state import state_of
from rga.operation.reading.twin_now import TwinNow

NOON = datetime(2026, 11, 23, 12, tzinfo=UTC)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (1, "1 row has come;"),
        (18, "18 rows have come;"),
        (12_345_678, "12345678 rows have come;"),
    ],
)
def test_rows_are_counted_in_whole_numbers(rows: int, words: str) -> None:
    now: TwinNow = SimpleNamespace(  # type: ignore[assignment]
        rows=rows, time=NOON, stage="gather", undecided=None, out_of_sync=False
    )
    assert state_of(now, NOON, patience=60.0, lag=0).words.startswith(words)
