"""Payloads that nothing can read among those of a logger: does one keep the others waiting?"""

import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rga.errors import InputError
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender
from rga.twin.versions import written
from rga_bench.endless.stream import EVERY, Stream
from rga_bench.operation.broker import Mosquitto
from rga_bench.operation.service_folder import TOPIC, by_broker, sent_of, write_service
from rga_bench.operation.service_process import ServiceProcess

#: of all that is sent
SHARE = 0.02
#: how long what was sent may take to be kept [s]
LONGEST = 300.0


@dataclass(frozen=True)
class Unreadable:
    """What came of payloads some of which cannot be read.

    Attributes:
        packets: that can be read.
        garbage: payloads that cannot.
        kept: of the packets.
        aside: payloads that were kept apart, with the reason.
        unaccounted: payloads of which nothing is known.
    """

    packets: int
    garbage: int
    kept: int
    aside: int
    unaccounted: int


def unreadable(packets: int, stream: Stream, seed: int) -> Unreadable:
    """Send packets through a broker, and what cannot be read between them.

    Args:
        packets: how many.
        stream: what they hold, a row each.
        seed: of the payloads that cannot be read.

    Raises:
        InputError: there is no broker, or not all that was sent comes.
    """
    model, every = json.loads(written(stream.model)[0]), round(EVERY)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "broker").mkdir()
        broker = Mosquitto(folder / "broker")
        broker.start()
        try:
            source = by_broker(broker.url)
            address = write_service(
                folder, model, stream.settings, source=source, every=every, lateness=every
            )
            with ServiceProcess(folder, address) as service:
                sender = BrokerSender(f"{broker.url}/{TOPIC}")
                record = sent_of(stream.rows(0, packets))
                faults = Faults(seed=seed, garbage=SHARE)
                sent = play(record, sender, 1, np.inf, faults)
                return _settled(service, sent["packet"], sent["garbage"])
        finally:
            broker.kill()


def _settled(service: ServiceProcess, packets: int, garbage: int) -> Unreadable:
    """What became of them when all have come."""
    until = time.monotonic() + LONGEST
    while time.monotonic() < until:
        account = service.get("/api/v1/twins/east/account")["mqtt"]
        if account["received"] >= packets + garbage:
            return Unreadable(
                packets=packets,
                garbage=garbage,
                kept=account["used"] + account["waiting"],
                aside=account["refused"],
                unaccounted=account["difference"],
            )
        time.sleep(0.1)
    raise InputError("the payloads do not all come", json.dumps(account), "look at its log")
