"""A year of minutes: a row costs what it cost at the beginning, and a restart reads no past."""

import logging
import os
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.operation.packets.native import write_packet
from rga.records import Record
from rga_bench.endless.stream import DRAWN, Stream, settings
from rga_bench.operation.broker import PROGRAM, Mosquitto
from rga_bench.operation.service_folder import sent_of
from served.brokers import mosquitto
from served.long_service import LongService, Mark

__all__ = ["mosquitto"]

#: `RGA_TEST_YEAR_ROWS=525600` is what is promised
ROWS = int(os.environ.get("RGA_TEST_YEAR_ROWS", "20000"))
#: rows of the short form, and before those that are early ones
FEW, BEFORE = 400, 600
#: rows that a twin takes in together, and length of one [s]
PACKET, EVERY = 20, 60
#: rows by which samples may be late: of what waits in mosquitto one packet may overtake as many as
#: are on their way to the service at once
LATE = 120
#: what a row may cost late, as many times as early
MOST = 1.2
#: by how much a restart may cost more at the end than at the beginning: time of the processor [s],
#: and what is read: of what is stored, and of modules that have been read by then or not [B]
MORE, SHARE, MODULES = 1.0, 0.05, 20e6
STREAM = Stream(12, 10, settings(PACKET), seed=5)


@pytest.fixture
def service(tmp_path: Path, mosquitto: Mosquitto) -> Iterator[LongService]:
    found = LongService(tmp_path, mosquitto, STREAM, EVERY, LATE)
    yield found
    found.stop()


def parts(first: int, until: int) -> Iterator[Record]:
    """Rows from one to before another, cut where those that are drawn come again."""
    inner = range(first - first % DRAWN + DRAWN, until, DRAWN)
    yield from (STREAM.rows(*edges) for edges in pairwise([first, *inner, until]))


def fed(service: LongService, until: int) -> Mark:
    """Send rows before one, at full speed."""
    for part in parts(service.sent, until):
        sent, first = sent_of(part), service.sent
        for row in range(len(part)):
            service.send(write_packet(sent.packet(first + row, row, row + 1)))
    return service.played()


def restarted(service: LongService) -> Mark:
    """Kill the service: the next goes on where it was; gives what its first rows took."""
    before = service.now
    service.kill()
    service.start()
    assert service.now == before
    return fed(service, service.sent + PACKET)


def check_rows(service: LongService, export: Callable[..., Any]) -> None:
    """All were made, with the readings that were sent."""
    rows = service.end(export)
    found = rows.select(tuple(STREAM.model.sensors)).to_numpy()
    sent = np.concatenate([part.readings for part in parts(0, len(rows))])
    np.testing.assert_array_equal(found, sent)


@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_rows_are_all_there_and_a_restart_goes_on(
    service: LongService, rga: Callable[..., Any]
) -> None:
    fed(service, FEW)
    restarted(service)
    check_rows(service, rga)


@pytest.mark.thorough
@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_a_row_costs_what_it_did_and_a_restart_reads_no_past(
    service: LongService, rga: Callable[..., Any]
) -> None:
    fed(service, BEFORE)
    young = restarted(service)
    quarters = [young, *(fed(service, ROWS * k // 4) for k in range(1, 5))]
    early, late = (quarters[k + 1].cost_since(quarters[k]) for k in (0, 3))
    old = restarted(service)
    more = old.usage.processor - young.usage.processor
    read = old.usage.read - young.usage.read
    logging.getLogger(__name__).info(
        "%d rows: %.2f ms a row early, %.2f late; %d bytes stored for each; a restart takes %.2f s "
        "more of the processor, and reads %d bytes more",
        service.sent, 1e3 * early, 1e3 * late, old.stored / service.sent, more, read,
    )  # fmt: skip
    check_rows(service, rga)
    assert late <= MOST * early
    assert more <= MORE
    assert read <= SHARE * old.stored + MODULES
