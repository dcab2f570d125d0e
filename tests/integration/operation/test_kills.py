"""A service that is killed at any time loses nothing that it acknowledged, and doubles nothing."""

import json
import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.request import urlopen

import numpy as np

import rga
from live_streams import SETTINGS
from rga.model import read_model
from rga.operation.feeding.faults import Faults
from rga.operation.feeding.player import play
from rga.operation.feeding.senders import HttpSender
from rga.operation.feeding.sent_record import SentRecord
from rga.operation.packets.packet import MICROSECONDS
from rga.records import Record
from rga.twin.hardware.inbox import Inbox

#: `RGA_TEST_KILLS=200` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "4"))
MIDNIGHT = 1_795_392_000_000_000
CONFIGURATION = """
[service]
listen = "127.0.0.1:{port}"
[[twin]]
name = "east"
model = "model.json"
settings = "settings.json"
rows = {{ every = "10 min", lateness = "30 min" }}
[[twin.source]]
kind = "http"
clock = {{ check = false }}
"""


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


def test_nothing_is_lost_and_nothing_doubled(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    rows, draw = 100 * KILLS, random.Random(7)
    port = free_port()
    (tmp_path / "serve.toml").write_text(CONFIGURATION.format(port=port), "utf-8")
    (tmp_path / "model.json").write_text(json.dumps(measured_bridge), "utf-8")
    (tmp_path / "settings.json").write_text(SETTINGS.model_dump_json(), "utf-8")
    record = measured_record(read_model(measured_bridge, "bridge"), rows=rows)
    sent = SentRecord(
        (*record.sensors, *record.contexts),
        MIDNIGHT + np.rint(record.time * MICROSECONDS).astype(np.int64),
        np.column_stack([record.readings, *record.contexts.values()]),
        "s",
    )
    sender = HttpSender(f"http://127.0.0.1:{port}/east")
    faults = Faults(seed=1, duplicate=0.05, out_of_order=0.1, out_of_order_by="15 min")
    feeding = Thread(target=play, args=(sent, sender, 1, np.inf, faults), daemon=True)
    feeding.start()
    killed = 0
    while feeding.is_alive():
        service = subprocess.Popen(
            [sys.executable, "-m", "rga", "serve", "serve.toml"], cwd=tmp_path,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        if killed < KILLS:
            wait_for(port, service)
            time.sleep(draw.uniform(0.0, 1.0))
            service.kill()
            killed += 1
        else:
            feeding.join()
            with urlopen(f"http://127.0.0.1:{port}/api/v1/twins/east/account") as answer:
                account = json.load(answer)["http"]
            service.send_signal(signal.SIGTERM)
        service.wait()
    assert killed == KILLS
    assert account["difference"] == 0
    assert account["used"] + account["waiting"] == rows
    assert account["streams"] == {"s": {"next": rows, "missing": []}}
    # All but the rows that late samples are waited for are final.
    with rga.LiveTwin(tmp_path / "data" / "east") as twin:
        twin.play()
        found = twin.twin.record
    inbox = Inbox(tmp_path / "data" / "east")
    assert rows - 5 <= inbox.rows < rows
    np.testing.assert_array_equal(found.time, record.time[: len(found)])
    np.testing.assert_array_equal(found.readings, record.readings[: len(found)])


def wait_for(port: int, service: subprocess.Popen[bytes]) -> None:
    """Wait until a service answers."""
    while service.poll() is None:
        try:
            with urlopen(f"http://127.0.0.1:{port}/healthz", timeout=5):
                return
        except OSError:
            time.sleep(0.05)
