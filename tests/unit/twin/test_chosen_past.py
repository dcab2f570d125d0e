"""The record that a diagnosis of a long past is to see."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from made_findings import findings
from rga.model import Model, read_model
from rga.records import Record
from rga.twin.history import Event
from rga.twin.past.chosen_past import WHOLE, chosen_past, with_choice
from site_truss import content, model

ROWS, MOST, LATE = 5000, 200, 4700


def past(*measured: str) -> Record:
    draw = np.random.default_rng(0)
    contexts = {name: draw.uniform(0.0, 30.0, ROWS) for name in measured or model().context}
    readings = np.zeros((ROWS, 1))
    return Record(600.0 * np.arange(ROWS), 0.0, "seconds", ("D1",), readings, contexts)


def chosen(record: Record, of: Model, *rows: int) -> tuple[Record, str]:
    events = [Event("alarm", row, 600.0 * row, "an alarm") for row in rows]
    choice = chosen_past(of, record, events, 100, MOST, seed=0)
    return record.rows(choice.rows), choice.words


def with_law(law: str) -> Model:
    told: dict[str, Any] = content()
    told["context"]["west load"] |= {"law": law}
    if law == "linear":
        told["context"]["west load"] |= {"rate": [0.001, 0.1]}
    return read_model(told, "site")


def longest(record: Record) -> int:
    """Rows of the longest stretch without a gap."""
    row = np.round(record.time / 600.0).astype(int)
    return max(len(part) for part in np.split(row, np.flatnonzero(np.diff(row) > 1) + 1))


def test_a_short_past_is_seen_whole() -> None:
    short = past().rows(slice(0, MOST))
    seen, words = chosen(short, model(), 150)
    np.testing.assert_array_equal(seen.time, short.time)
    assert words == ""


def test_a_past_in_which_nothing_happened_is_seen_whole_unless_it_is_very_long() -> None:
    assert len(chosen(past(), model())[0]) == ROWS
    many = replace(
        past(), time=np.arange(WHOLE + 1.0), contexts={}, readings=np.zeros((WHOLE + 1, 1))
    )
    assert len(chosen(many, model())[0]) <= MOST


def test_rows_about_an_alarm_are_seen() -> None:
    record, words = chosen(past(), model(), LATE)
    assert len(record) <= MOST
    assert set(600.0 * np.arange(LATE - 4, LATE + 4)) <= set(record.time)
    assert "about row 4 700, " in words
    assert "whole stretches" not in words


def test_an_event_at_the_last_row_changes_nothing() -> None:
    _, words = chosen(past(), model(), LATE)
    assert chosen(past(), model(), LATE, ROWS - 1)[1] == words


@pytest.mark.parametrize("law", ["linear", "smooth"])
def test_what_shows_from_row_to_row_is_seen_in_whole_stretches(
    law: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    loads = with_law(law)
    assert len(chosen(past("temperature", "east load"), loads, LATE)[0]) == ROWS
    monkeypatch.setattr("rga.twin.past.chosen_past.WHOLE", ROWS - 1)
    record, words = chosen(past("temperature", "east load"), loads, LATE)
    assert "whole stretches, as west load depends on the rows before" in words
    assert len(record) <= MOST
    assert longest(record) >= MOST // 8
    # Where it is measured, nothing has to be told from other rows.
    assert "whole stretches" not in chosen(past(), loads, LATE)[1]


def test_an_effect_that_remembers_is_seen_in_whole_stretches(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("rga.twin.past.chosen_past.WHOLE", ROWS - 1)
    told = content()
    told["effects"]["late warmth"] = {"kind": "clock_lag", "time": 600.0}
    words = chosen(past(), read_model(told, "site"), LATE)[1]
    assert "as late warmth depends on the rows before" in words


def test_rows_of_the_zero_are_seen() -> None:
    zeroed = replace(past(), zero=(600.0 * 1000, 600.0 * 1011))
    record, words = chosen(zeroed, model(), LATE)
    assert set(600.0 * np.arange(1000, 1012)) <= set(record.time)
    assert "12 of the zero" in words


def test_findings_of_a_whole_past_stay_as_they_are() -> None:
    told = findings()
    assert with_choice(told, [], ROWS) is told
