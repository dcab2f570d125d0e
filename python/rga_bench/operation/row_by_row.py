"""A service to which rows are sent one at a time, each of which its twin takes in by itself."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from rga.errors import InputError
from rga.operation.feeding.senders import HttpSender
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import MICROSECONDS
from rga.twin.versions import written
from rga_bench.endless.stream import EVERY, Stream, settings
from rga_bench.operation.service_folder import sent_of, write_service
from rga_bench.operation.service_process import ServiceProcess

#: rows of a calibration, and how long they may take [s]
CALIBRATION, LONGEST = 100, 600.0
TWIN = "/api/v1/twins/east"


class RowByRow:
    """A service whose twin is calibrated.

    Args:
        service: that runs.
        stream: what its bridge reads.
        rows: that may be sent.
    """

    def __init__(self, service: ServiceProcess, stream: Stream, rows: int) -> None:
        self.service, self._sender = service, HttpSender(f"{service.address}/east")
        sent = sent_of(stream.rows(0, rows))
        # In the middle of its cell a row is beyond the end of the one before.
        self._record = replace(sent, times=sent.times + round(EVERY / 2 * MICROSECONDS))
        self._sent = 0

    def send(self) -> int:
        """Send a row; gives how many are final with it: all before it."""
        packet = self._record.packet(self._sent, self._sent, self._sent + 1)
        self._sender.send(write_packet(packet), packet.number)
        self._sent += 1
        return self._sent - 1

    def calibrate(self) -> None:
        """Send rows until the twin is calibrated.

        Raises:
            InputError: it does not come to it.
        """
        final = max(self.send() for _ in range(CALIBRATION + 2))
        until = time.monotonic() + LONGEST
        while time.monotonic() < until:
            now = self.service.get(TWIN)["now"]
            if now is not None and now["rows"] >= final:
                return
            time.sleep(0.1)
        raise InputError("the twin is not calibrated", self.service.address, "look at its log")


@contextmanager
def row_by_row(folder: Path, sensors: int, panels: int, rows: int, seed: int) -> Iterator[RowByRow]:
    """A service with a calibrated twin while it is needed.

    Args:
        folder: of its files.
        sensors, panels: of its bridge.
        rows: that may be sent behind the calibration.
        seed: of what is drawn.
    """
    stream = Stream(sensors, panels, settings(1, calibration_rows=CALIBRATION), seed)
    model = json.loads(written(stream.model)[0])
    address = write_service(folder, model, stream.settings, every=round(EVERY), lateness=1)
    with ServiceProcess(folder, address) as service:
        found = RowByRow(service, stream, CALIBRATION + 2 + rows)
        found.calibrate()
        yield found
