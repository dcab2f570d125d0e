"""What others see of a twin while it lives is what its repository holds."""

from datetime import UTC, datetime
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.operation.configuration import read_configuration
from rga.operation.reading import twin_reading
from rga.operation.reading.overview import BLOCK
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.service import Service
from rga.records import Record
from rga.twin import Twin
from rga.twin.repository import RunView
from served.bridges import packets_of

START = datetime(2026, 11, 23, tzinfo=UTC)


@pytest.fixture
def reading(folder: Path) -> TwinReading:
    """Of the twin that has lived through something."""
    return TwinReading("east", folder / "data" / "east", None)


def history_of(reading: TwinReading) -> rga.twin.History:
    with Twin.open(reading.place) as twin:
        return twin.history()


@pytest.mark.parametrize("rows_at_once", [3, 20_000])
def test_series_in_blocks_is_that_of_the_repository(
    reading: TwinReading, monkeypatch: pytest.MonkeyPatch, rows_at_once: int
) -> None:
    history = history_of(reading)
    as_they_are = reading.series(0.0, np.inf, 10_000)
    assert as_they_are is not None
    np.testing.assert_array_equal(as_they_are.measured.mean, history.record.readings)
    np.testing.assert_array_equal(as_they_are.simulated.mean, history.simulated)
    view = reading.view()
    assert view is not None
    inferred = view.inferred(at_the_time=True)
    np.testing.assert_array_equal(as_they_are.inferred.mean[inferred.rows], inferred.contexts)
    assert len(inferred.rows) > 50
    gaps = history.gaps / history.noise**2
    np.testing.assert_allclose(as_they_are.gap.mean, gaps, rtol=1e-12)
    monkeypatch.setattr(twin_reading, "MOST_ROWS", 10)
    monkeypatch.setattr(twin_reading, "BATCH", rows_at_once)
    blocks = TwinReading("east", reading.place, None).series(0.0, np.inf, 10_000)
    assert blocks is not None
    values = {"measured": history.record.readings, "simulated": history.simulated, "gap": gaps}
    for name, expected in values.items():
        trace = getattr(blocks, name)
        for k in range(len(expected) // BLOCK):
            rows = expected[k * BLOCK : (k + 1) * BLOCK]
            np.testing.assert_allclose(trace.mean[k], np.nanmean(rows, axis=0), rtol=1e-5)
            np.testing.assert_allclose(trace.most[k], np.nanmax(rows, axis=0), rtol=1e-6)
            np.testing.assert_allclose(trace.least[k], np.nanmin(rows, axis=0), rtol=1e-6)


def test_others_look_at_a_twin_while_its_long_past_is_read(
    reading: TwinReading, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(twin_reading, "MOST_ROWS", 10)
    monkeypatch.setattr(twin_reading, "BATCH", 20)
    seen: list[object] = []

    def others(_: float) -> None:
        other = Thread(target=lambda: seen.append(reading.now()))
        other.start()
        other.join(timeout=10.0)

    monkeypatch.setattr(twin_reading.time, "sleep", others)
    assert reading.series(0.0, np.inf, 10_000) is not None
    assert len(seen) > 3
    assert None not in seen


@pytest.mark.parametrize(("begin", "end"), [(0.0, 6000.0), (6000.0, 6001.0), (-50.0, 1.0)])
def test_a_stretch_has_its_rows_and_no_others(
    reading: TwinReading, begin: float, end: float
) -> None:
    found = reading.series(begin, end, 10_000)
    assert found is not None
    time = history_of(reading).record.time
    np.testing.assert_array_equal(found.measured.time, time[(time >= begin) & (time < end)])
    assert len(found.gap) == len(found.measured)


@pytest.mark.parametrize(("begin", "end"), [(1e9, 2e9), (-2e9, -1e9), (5.0, 5.0), (9.0, 3.0)])
def test_where_nothing_is_nothing_is_shown(
    reading: TwinReading, begin: float, end: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    for most in (twin_reading.MOST_ROWS, 0):
        monkeypatch.setattr(twin_reading, "MOST_ROWS", most)
        found = reading.series(begin, end, 100)
        assert found is not None
        assert len(found.measured) == 0


def test_a_step_that_cannot_be_read_is_not_answered_by_the_one_before(
    reading: TwinReading, monkeypatch: pytest.MonkeyPatch
) -> None:
    def damaged(*_: object) -> None:
        raise InputError("damaged", "repository", "restore it")

    assert reading.now() is not None
    monkeypatch.setattr(twin_reading, "Twin", damaged)
    monkeypatch.setattr(RunView, "steps", property(lambda view: 10**6))
    for _ in range(2):
        with pytest.raises(InputError, match="damaged"):
            reading.now()


def test_now_is_the_last_row(reading: TwinReading) -> None:
    history, now = history_of(reading), reading.now()
    assert now is not None
    assert now.rows == len(history.record)
    for k, name in enumerate(history.record.sensors):
        assert now.sensors[name].measured == history.record.readings[-1, k]
        assert now.sensors[name].noise == pytest.approx(history.noise[k])
    assert now.version == next(one.number for one in history.versions if one.in_force)
    assert reading.now() is now


def test_a_twin_that_begins_later_is_seen_then(folder: Path) -> None:
    reading = TwinReading("west", folder / "data" / "west", None)
    assert reading.now() is None
    assert reading.series(0.0, 1.0, 10) is None
    assert reading.events() == ()
    assert reading.elapsed(START) == 0.0
    west = Service(read_configuration(folder / "serve.toml"))
    rows = _fed(west, 100)
    assert reading.now() is not None
    found = reading.series(0.0, np.inf, 1000)
    assert found is not None
    assert 50 <= len(found.measured) <= rows
    west.stop()


def test_what_grows_while_it_is_looked_at_stays_whole(
    folder: Path, lived_through: tuple[Path, Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(twin_reading, "MOST_ROWS", 10)
    reading = TwinReading("west", folder / "data" / "west", None)
    service = Service(read_configuration(folder / "serve.toml"))
    writer = Thread(target=_fed, args=(service, 60))
    writer.start()
    lengths, steps = [0], [0]
    while writer.is_alive():
        now, found = reading.now(), reading.series(0.0, np.inf, 10_000)
        if now is not None and found is not None:
            lengths.append(len(found.measured))
            steps.append(now.steps)
    assert steps == sorted(steps)
    assert steps[-1] > 1
    service.stop()
    # What was put together bit by bit is what is read at once.
    grown, anew = (
        one.series(0.0, np.inf, 10_000)
        for one in (reading, TwinReading("west", folder / "data" / "west", None))
    )
    assert grown is not None
    assert anew is not None
    for name in ("measured", "simulated", "gap", "inferred"):
        for part in ("time", "mean", "least", "most"):
            one, other = (getattr(getattr(which, name), part) for which in (grown, anew))
            np.testing.assert_array_equal(one, other)


def _fed(service: Service, rows: int) -> int:
    """Let the second twin take rows of the first in, a few at a time, and play."""
    east, west = service.twins["east"], service.twins["west"]
    with Twin.open(east.directory) as twin:
        record = twin.record.rows(slice(0, rows))
    payloads = packets_of(record, START)
    for first in range(0, len(payloads), 10):
        for payload in payloads[first : first + 10]:
            west.receive("http", [("http", payload)])
        west.seal()
        with rga.LiveTwin(west.directory) as live:
            live.play()
    return len(record)
