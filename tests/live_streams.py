"""What tests of a live twin share: streams in pieces, and runs that are the same bit for bit."""

from collections.abc import Iterable, Iterator
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from time import sleep
from typing import Any

import numpy as np

from rga import LiveTwin, load_model, load_record
from rga.model import Model, read_effect
from rga.records import Record
from rga.simulation import Simulator
from rga.twin import Settings
from rga.twin.hardware.inbox import Inbox
from rga.twin.history import Event, History
from rga.twin.repository import Repository, StoredCommand
from rga.twin.runner import Running

#: of a twin whose contexts are all measured
SETTINGS = Settings(level="C", calibration_rows=40, packet=10, settle=12)
#: a bearing that is lower from a row on
LOW = {"kind": "support_settlement", "support": "east", "dof": "uz", "displacement": -0.002}
SINKS_AT = 75
#: rows that a feeder in a process of its own sends at once, and how long it rests then [s]
FED, PAUSE = 3, 0.01


def sinking(model: Model, measured: Any, rows: int, *, sinks: bool = True) -> Record:
    """A record in which a bearing sinks, or the same one in which nothing happens."""
    record: Record = measured(model, rows=rows)
    if not sinks:
        return record
    low = model.extended({"low": read_effect(LOW | {"onset": 600.0 * SINKS_AT}, "low")})
    contexts = {"time": record.time, **record.contexts}
    shift = Simulator(low).predict(contexts) - Simulator(model).predict(contexts)
    return with_readings(record, record.readings + shift)


def with_readings(record: Record, readings: np.ndarray[Any, Any]) -> Record:
    """The record with other readings."""
    given = {one.name: getattr(record, one.name) for one in fields(record)}
    return Record(**given | {"readings": readings, "sha256": "altered"})


def pieces(record: Record, cuts: Iterable[int]) -> Iterator[Record]:
    """The record in pieces, cut before these rows."""
    for first, end in pairwise([0, *sorted(cuts), len(record)]):
        if end > first:
            yield record.rows(slice(first, end))


def assert_same(found: History, expected: History) -> None:
    """All that two runs left behind is the same, bit for bit."""
    for name in ("events", "versions", "growth", "contexts", "calibration_rows", "level"):
        assert getattr(found, name) == getattr(expected, name), name
    for name in ("inferred", "spread", "simulated", "gaps", "noise"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    one, other = found.record, expected.record
    assert (one.start, one.time_format, one.sensors) == (
        other.start,
        other.time_format,
        other.sensors,
    )
    np.testing.assert_array_equal(one.time, other.time)
    np.testing.assert_array_equal(one.readings, other.readings)
    assert one.contexts.keys() == other.contexts.keys()
    for name, column in one.contexts.items():
        np.testing.assert_array_equal(column, other.contexts[name], name)


def history(twin: LiveTwin) -> History:
    """What a live twin left behind so far."""
    with twin.twin as stored:
        return stored.history()


def kinds(events: Iterable[Event]) -> list[str]:
    """What happened, in its order."""
    return [one.kind for one in events]


def commands(place: Any) -> tuple[StoredCommand, ...]:
    """What people asked a twin for, as its repository has it."""
    with Repository.open(place, read_only=True) as repository:
        return repository.latest().commands()


def feed_from(folder: Path) -> None:
    """Feed the record of a folder from where nobody knows whether it was kept."""
    model = load_model(folder / "model.json")
    record = load_record(folder / "record.csv", model)
    with LiveTwin(folder) as twin, (folder / "acknowledged").open("a", encoding="utf-8") as told:
        for first in range(acknowledged(folder), len(record), FED):
            part = record.rows(slice(first, first + FED))
            twin.feed(part)
            told.write(f"{first + len(part)}\n")
            told.flush()
            sleep(PAUSE)


def acknowledged(folder: Path) -> int:
    """Rows of which `feed` has said that they are kept."""
    path = folder / "acknowledged"
    said = path.read_text(encoding="utf-8").split() if path.exists() else []
    return int(said[-1]) if said else 0


def play_until(folder: Path, rows: int) -> None:
    """Play until so many rows have arrived and all that is due is done."""
    with LiveTwin(folder) as twin:
        arrived = 0
        while arrived < rows:
            arrived = arrived_in(folder)
            twin.play()
            sleep(PAUSE)


def arrived_in(folder: Path) -> int:
    """Rows that have ever arrived."""
    inbox = Inbox(folder)
    try:
        return inbox.rows
    finally:
        inbox.close()


def play_step_by_step(place: Path) -> None:
    """Play to the end of what is due, each step by a twin of its own."""
    happened = steps = 1
    while happened or steps:
        seen: list[int] = []

        def once(running: Running, seen: list[int] = seen) -> bool:
            seen.append(running.row)
            return len(seen) < 2

        with LiveTwin(place) as twin:
            happened = len(twin.play(once))
            steps = len(seen) - 1
