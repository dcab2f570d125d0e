"""A record is fed while a service or a broker is killed: is all of it there, and once?"""

import json
import random
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from threading import Thread
from typing import Any, Literal

import numpy as np

import rga
from rga.errors import InputError
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender, HttpSender, Sender
from rga.records import Record
from rga.twin import Settings
from rga_bench.operation.broker import Mosquitto
from rga_bench.operation.service_folder import TOPIC, by_broker, sent_of, write_service
from rga_bench.operation.service_process import ServiceProcess

#: what is killed, and what lies between the logger and the service
Killed = Literal["service", "service behind a broker", "broker"]
#: shares of the packets that come twice and out of order, the latter by so many rows at most
TWICE, OUT_OF_ORDER, BY = 0.05, 0.1, 1.5
#: rows that late samples are waited for
LATENESS = 3
#: longest time from one kill to the next, and that a broker is away [s]
LIFE, AWAY = 1.0, 0.5
#: how long what was sent may take to be accounted for [s]
LONGEST = 300.0


@dataclass(frozen=True)
class Losses:
    """What came of a record that was fed through kills.

    Attributes:
        killed: what was killed.
        times: how often.
        packets: that were sent.
        lost, doubled: packets that were acknowledged and are not there, or are there twice.
        unaccounted: packets of which nothing is known.
        differing: rows that are not those of the record.
    """

    killed: Killed
    times: int
    packets: int
    lost: int
    doubled: int
    unaccounted: int
    differing: int


def losses(
    killed: Killed,
    times: int,
    model: dict[str, Any],
    settings: Settings,
    record: Record,
    seed: int,
    progress: Callable[[float], None] = lambda share: None,
) -> Losses:
    """Feed a record, a packet a row, and kill something so many times meanwhile.

    Args:
        killed: what is killed.
        times: how often.
        model: content of the model file of the twin.
        settings: of the twin.
        record: of rows whole seconds apart.
        seed: of the times between kills.
        progress: called with the share that is done.

    Raises:
        InputError: the service or the broker cannot be started, or does not come to an end.
    """
    draw, every = random.Random(seed), round(record.time[1] - record.time[0])
    grid = {"every": every, "lateness": LATENESS * every}
    faults = Faults(
        seed=seed, duplicate=TWICE, out_of_order=OUT_OF_ORDER, out_of_order_by=f"{BY * every} s"
    )
    with tempfile.TemporaryDirectory() as name, ExitStack() as running:
        folder, broker = Path(name), None
        source = "http"
        if killed == "service":
            address = write_service(folder, model, settings, **grid)
            sender: Sender = HttpSender(f"{address}/east")
        else:
            (folder / "broker").mkdir()
            broker = Mosquitto(folder / "broker")
            broker.start()
            running.callback(broker.kill)
            source = "mqtt"
            source_lines = by_broker(broker.url)
            address = write_service(folder, model, settings, source=source_lines, **grid)
            sender = BrokerSender(f"{broker.url}/{TOPIC}")
        service = running.enter_context(ServiceProcess(folder, address))
        feeding = Thread(
            target=play, args=(sent_of(record), sender, 1, np.inf, faults), daemon=True
        )
        feeding.start()
        for number in range(times):
            time.sleep(draw.uniform(0.0, LIFE))
            if killed == "broker" and broker is not None:
                broker.kill()
                time.sleep(draw.uniform(0.0, AWAY))
                broker.start()
            else:
                service.kill()
                service.start()
            progress(number / times)
        feeding.join()
        account = _settled(service, source, len(record))
        service.stop()
        return Losses(killed, times, len(record), *_found(folder, record, account))


def _settled(service: ServiceProcess, source: str, packets: int) -> dict[str, Any]:
    """The account of a source when all packets have come and rows were made of them."""
    until = time.monotonic() + LONGEST
    while time.monotonic() < until:
        found: dict[str, Any] = service.get("/api/v1/twins/east/account")[source]
        # Those of the last rows wait for others that may be late.
        come = found["used"] + found["waiting"] + found["late"]
        if come >= packets and found["waiting"] <= LATENESS + 2:
            return found
        time.sleep(0.1)
    raise InputError("the packets do not all come", json.dumps(found), "look at its log")


def _found(folder: Path, record: Record, account: dict[str, Any]) -> tuple[int, int, int, int]:
    """Packets that are lost, doubled and unaccounted for, and rows that differ."""
    kept = account["used"] + account["waiting"]
    missing = sum(
        last - first + 1
        for stream in account["streams"].values()
        for first, last in stream["missing"]
    )
    lost = missing + max(0, len(record) - kept) + account["late"] + account["refused"]
    with rga.LiveTwin(folder / "data" / "east") as twin:
        twin.play()
        played = twin.twin.record
    expected = record.rows(slice(0, len(played)))
    same = np.isclose(played.readings, expected.readings, rtol=0, atol=0, equal_nan=True)
    differing = int((~same.all(axis=1) | (played.time != expected.time)).sum())
    return lost, max(0, kept - len(record)), account["difference"], differing
