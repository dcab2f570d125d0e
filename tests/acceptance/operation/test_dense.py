"""A dense bridge, 84 sensors at 250 Hz, ten times as fast as it is measured, on one core."""

import logging
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import MICROSECONDS, Number, SensorPacket
from rga_bench.endless.stream import Stream, settings
from rga_bench.operation.broker import PROGRAM, Mosquitto
from rga_bench.operation.rates import DENSE
from rga_bench.operation.service_folder import MIDNIGHT
from served.brokers import mosquitto
from served.long_service import LongService, Mark

__all__ = ["mosquitto"]

#: length of the record; `RGA_TEST_DENSE_SECONDS=3600` is what is promised [s]
SECONDS = int(os.environ.get("RGA_TEST_DENSE_SECONDS", "450"))
FEW = 50
SPEED = 10
#: rows by which samples may be late: nothing waits in the broker for long
LATE = 5
SENSORS, SAMPLES = DENSE
#: by how much memory may grow from the first third to the end: of it, and what is freed and not
#: given back to the system; were packets held, those of half an hour would be twice as much [B]
GROWTH, ALWAYS = 0.05, 64e6
#: how long the service may need behind the last packet, of the time in which all were sent
BEHIND = 0.1
#: of what is sampled, as many times as the noise of a row
SCATTER = 3.0
STREAM = Stream(SENSORS, 10, settings(10, calibration_rows=20), seed=6)


@pytest.fixture
def service(tmp_path: Path, mosquitto: Mosquitto) -> Iterator[LongService]:
    found = LongService(tmp_path, mosquitto, STREAM, every=1, late=LATE)
    yield found
    found.stop()


def second(number: int) -> SensorPacket:
    """All samples of a second, which a logger sends with four bytes each."""
    record, draw = STREAM.rows(number, number + 1), np.random.default_rng(number)
    names = (*record.sensors, *record.contexts)
    at = np.concatenate([record.readings[0], *record.contexts.values()])
    noise = [one.noise or 0.0 for one in STREAM.model.sensors.values()]
    scatter = SCATTER * np.array([*noise, *(0.0 for _ in record.contexts)])
    values = at + scatter * draw.standard_normal((SAMPLES, len(names)))
    begun = MIDNIGHT + number * MICROSECONDS
    times = begun + np.arange(SAMPLES) * (MICROSECONDS // SAMPLES)
    return SensorPacket(Number("s", number), names, times, values)


class Fed(NamedTuple):
    """What a service took for a part of a record: how long that was sent, and played behind it."""

    sent: float
    behind: float
    mark: Mark


def fed(service: LongService, until: int) -> Fed:
    """Feed a record from where it is to a second, and wait until all is played."""
    first, begun = service.sent, time.monotonic()
    for number in range(first, until):
        payload = write_packet(second(number), binary=True, single=True)
        time.sleep(max(0.0, begun + (number - first) / SPEED - time.monotonic()))
        service.send(payload)
    sent = time.monotonic()
    mark = service.played()
    return Fed(sent - begun, time.monotonic() - sent, mark)


def check_rows(service: LongService, export: Callable[..., Any]) -> None:
    """All were made: the means of their seconds."""
    rows = service.end(export)
    for number, row in enumerate(rows.select(second(0).channels).iter_rows()):
        samples = second(number).values.astype("<f4").astype(np.float64)
        np.testing.assert_allclose(row, samples.mean(axis=0), rtol=1e-12, atol=1e-12)


@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_a_dense_minute_is_all_there(service: LongService, rga: Callable[..., Any]) -> None:
    fed(service, FEW)
    check_rows(service, rga)


@pytest.mark.thorough
@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_a_dense_hour_is_kept_up_with_in_the_same_memory(
    service: LongService, rga: Callable[..., Any]
) -> None:
    first, rest = (fed(service, seconds) for seconds in (SECONDS // 3, SECONDS))
    a, b = first.mark, rest.mark
    processor = b.usage.processor - a.usage.processor
    logging.getLogger(__name__).info(
        "%d s of data in %.1f s, and %.1f s behind; %.0f %% of a core at %d x; memory %.0f MB "
        "after a third, %.0f MB at the end; %.0f kB stored a second",
        b.rows - a.rows, rest.sent, rest.behind, 100 * SPEED * processor / (b.rows - a.rows), SPEED,
        a.usage.memory / 1e6, b.usage.memory / 1e6, (b.stored - a.stored) / (b.rows - a.rows) / 1e3,
    )  # fmt: skip
    check_rows(service, rga)
    assert b.usage.memory <= (1 + GROWTH) * a.usage.memory + ALWAYS
    assert rest.behind <= BEHIND * rest.sent
