"""A service that is killed at any time loses nothing that it acknowledged, and doubles nothing."""

import os
import random
import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np

import rga
from live_streams import sinking
from rga.model import read_model
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import BrokerSender, HttpSender, Sender
from rga.records import Record
from rga.twin.hardware.inbox import Inbox
from served.broker import Mosquitto, mosquitto
from served.made_service import ServiceProcess, sent_of, waited_for, write_service

__all__ = ["mosquitto"]

#: `RGA_TEST_KILLS=200` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "2"))
ROWS = 100
FAULTS = Faults(seed=1, duplicate=0.05, out_of_order=0.1, out_of_order_by="15 min")
TOPIC = "rga/v1/east/data/logger"


def fed_and_killed(
    folder: Path,
    address: str,
    source: str,
    record: Record,
    sender: Sender,
    disturb: Callable[[ServiceProcess], None],
) -> None:
    """Feed a record while something is killed again and again, and look at what is there then."""
    feeding = Thread(target=play, args=(sent_of(record), sender, 1, np.inf, FAULTS), daemon=True)
    with ServiceProcess(folder, address) as service:
        feeding.start()
        for _ in range(KILLS):
            disturb(service)
        feeding.join()

        def account() -> Any:
            found = service.get("/api/v1/twins/east/account")[source]
            # What was sent again may still be on its way; rows are made soon after.
            came = found["used"] + found["waiting"] == len(record)
            return came and found["waiting"] <= 5 and found

        found = waited_for(account)
        assert found["difference"] == 0
        assert found["late"] == found["refused"] == 0
        assert found["streams"]["s"] == {"next": len(record), "missing": []}
    # All but the rows that late samples are waited for are final.
    with rga.LiveTwin(folder / "data" / "east") as twin:
        twin.play()
        played = twin.twin.record
    inbox = Inbox(folder / "data" / "east")
    assert len(record) - 5 <= inbox.rows < len(record)
    np.testing.assert_array_equal(played.time, record.time[: len(played)])
    np.testing.assert_array_equal(played.readings, record.readings[: len(played)])


def record_of(measured_bridge: dict[str, Any], measured_record: Callable[..., Record]) -> Record:
    return sinking(read_model(measured_bridge, "bridge"), measured_record, max(ROWS, 20 * KILLS))


def killed_service(draw: random.Random) -> Callable[[ServiceProcess], None]:
    def disturb(service: ServiceProcess) -> None:
        time.sleep(draw.uniform(0.0, 1.0))
        service.kill()
        service.start()

    return disturb


def test_a_service_that_is_killed(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    address = write_service(tmp_path, measured_bridge)
    record = record_of(measured_bridge, measured_record)
    sender = HttpSender(f"{address}/east")
    fed_and_killed(tmp_path, address, "http", record, sender, killed_service(random.Random(7)))


def by_broker(broker: Mosquitto) -> str:
    return f'kind = "mqtt"\nurl = "{broker.url}"\ntopics = ["{TOPIC}"]\nclock = {{ check = false }}'


def test_a_service_behind_a_broker_that_is_killed(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    mosquitto: Mosquitto,
    tmp_path: Path,
) -> None:
    address = write_service(tmp_path, measured_bridge, source=by_broker(mosquitto))
    record = record_of(measured_bridge, measured_record)
    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    fed_and_killed(tmp_path, address, "mqtt", record, sender, killed_service(random.Random(8)))


def test_a_broker_that_is_killed(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    mosquitto: Mosquitto,
    tmp_path: Path,
) -> None:
    address = write_service(tmp_path, measured_bridge, source=by_broker(mosquitto))
    record = record_of(measured_bridge, measured_record)
    draw = random.Random(9)

    def disturb(service: ServiceProcess) -> None:
        time.sleep(draw.uniform(0.0, 1.0))
        mosquitto.kill()
        time.sleep(draw.uniform(0.0, 0.5))
        mosquitto.start()

    sender = BrokerSender(f"{mosquitto.url}/{TOPIC}")
    fed_and_killed(tmp_path, address, "mqtt", record, sender, disturb)
