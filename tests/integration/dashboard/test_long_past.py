"""A long past is read in batches: what may happen meanwhile ends in an answer or in words."""

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from rga.errors import InputError
from rga.operation.configuration import read_configuration
from rga.operation.reading import twin_reading
from rga.operation.reading.twin_reading import Series, TwinReading
from rga.operation.service import Service
from rga.records import Record
from rga.twin.repository import Repository, RunView, StoredReadings
from served.bridges import packets_of, played

START = datetime(2026, 11, 23, tzinfo=UTC)
BATCH = 5


@pytest.fixture(autouse=True)
def in_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every past is long."""
    monkeypatch.setattr(twin_reading, "MOST_ROWS", 10)
    monkeypatch.setattr(twin_reading, "BATCH", BATCH)


def reading_of(folder: Path, name: str) -> TwinReading:
    return TwinReading(name, folder / "data" / name, None)


def whole(reading: TwinReading) -> Series:
    found = reading.series(0.0, np.inf, 10_000)
    assert found is not None
    return found


def assert_same(one: Series, other: Series) -> None:
    for name in ("measured", "simulated", "gap", "inferred"):
        for part in ("time", "mean", "least", "most"):
            np.testing.assert_array_equal(
                *(getattr(getattr(which, name), part) for which in (one, other))
            )


def test_rows_that_come_faster_than_they_are_read_are_not_waited_for(
    folder: Path, lived_through: tuple[Path, Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    service = Service(read_configuration(folder / "serve.toml"))
    twin, payloads = service.twins["west"], packets_of(lived_through[1], START)

    def feed(rows: int) -> None:
        for payload in payloads[:rows]:
            twin.receive("http", [("http", payload)])
        del payloads[:rows]
        played(twin)

    feed(32)
    reading, rests = reading_of(folder, "west"), 0

    def meanwhile(_: float) -> None:
        nonlocal rests
        rests += 1
        feed(10)

    monkeypatch.setattr(twin_reading.time, "sleep", meanwhile)
    now = reading.now()
    assert now is not None
    assert len(whole(reading).measured)
    assert rests <= now.rows // BATCH
    assert payloads
    service.stop()


def test_a_batch_that_adds_nothing_is_told(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    every: Callable[..., StoredReadings] = RunView.measured

    def lacking(view: RunView, first: int = 0, end: int | None = None) -> StoredReadings:
        return every(view, first, end if first < 40 else first)

    monkeypatch.setattr(RunView, "measured", lacking)
    with pytest.raises(InputError, match="rows 40 to 44 are not all there"):
        whole(reading_of(folder, "east"))


def test_a_run_in_the_place_of_another_is_read_anew(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has as many steps, and other rows: nothing of what was read before is left."""
    reading = reading_of(folder, "east")
    whole(reading)
    every: Callable[..., StoredReadings] = RunView.measured

    def other(view: RunView, first: int = 0, end: int | None = None) -> StoredReadings:
        seen = every(view, first, end)
        return replace(seen, readings=seen.readings + 1.0)

    view = reading.view()
    assert view is not None
    again = RunView(view._source, view.identity, START)
    monkeypatch.setattr(RunView, "measured", other)
    monkeypatch.setattr(TwinReading, "_view", lambda _: again)
    assert_same(whole(reading), whole(reading_of(folder, "east")))


def test_a_copy_of_before_is_read_anew(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reading = reading_of(folder, "east")
    whole(reading)
    view = reading.view()
    assert view is not None
    earlier = view.at_step(view.steps - 3)
    monkeypatch.setattr(TwinReading, "_view", lambda _: earlier)
    found = whole(reading)
    assert_same(found, whole(reading_of(folder, "east")))


def test_what_is_forgotten_meanwhile_is_missing_and_no_fault(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reading = reading_of(folder, "east")
    view = reading.view()
    assert view is not None
    rests, first, end = 0, 60, 80

    def meanwhile(_: float) -> None:
        nonlocal rests
        rests += 1
        if rests == 2:
            with (
                Repository.open(reading.place) as repository,
                repository.run(view.identity).step() as step,
            ):
                step.forget(first, end)

    monkeypatch.setattr(twin_reading.time, "sleep", meanwhile)
    assert_same(whole(reading), whole(reading_of(folder, "east")))
    assert reading.view().is_forgotten(first)  # type: ignore[union-attr]
