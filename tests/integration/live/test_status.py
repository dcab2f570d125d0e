"""What a twin says of where it stands: what waits for it, and what waits for somebody."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import rga as rga_package
from live_streams import SETTINGS
from rga.model import Model
from rga.records import Record
from rga.twin import Note, Reject, carry_out

Given = tuple[Model, Record]


def test_it_says_what_waits(sound: Given, tmp_path: Path, rga: Callable[..., Any]) -> None:
    model, record = sound
    with rga_package.live(model, tmp_path, settings=SETTINGS) as twin:
        twin.feed(record.rows(slice(0, 5)))
        twin.ask(Note(who="Ada"))
        assert twin.waiting == (5, 1)
        said = rga("status", tmp_path, "--json")
        assert (said.code, said.out) == (2, "")
        assert "no twin has been played here" in said.err
        twin.feed(record.rows(slice(0, 44)))
        twin.play()
        twin.ask(Note(who="Ada"))
        assert twin.waiting == (4, 1)
        assert "4 rows and 1 command wait to be played." in rga("status", tmp_path).out
        twin.feed(record.rows(slice(0, 50)))
        twin.play()
        assert twin.waiting == (0, 0)
        assert "wait" not in rga("status", tmp_path).out


def test_it_says_what_is_to_be_decided(
    sinks: Given, taken_in: Callable[..., Path], rga: Callable[..., Any]
) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    assert "To be decided: proposal 1, a model with support settlement" in rga("status", place).out
    carry_out(place, Reject(who="Ada"))
    assert "To be decided" not in rga("status", place).out
