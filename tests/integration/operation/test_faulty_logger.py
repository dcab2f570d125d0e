"""A logger with faults that were drawn: what becomes of its packets is as they were scripted."""

import random
from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.operation.configuration import TwinSettings
from rga.operation.feeding.faults import Faults, script
from rga.operation.feeding.player import play
from rga.operation.feeding.sent_record import SentRecord
from rga.operation.inbox.account import Account
from rga.operation.packets.packet import MICROSECONDS, Number
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock
from served.made_service import MIDNIGHT, write_service

#: seconds of the record, and of a row
SECONDS, ROW, LATENESS = 7_200, 60, 600
FAULTS = Faults(
    duplicate=0.01,
    out_of_order=0.05,
    out_of_order_by="5 min",
    late=0.01,
    late_by="1 h",
    garbage=0.02,
)


class Straight:
    """Sends to a twin without anything between, some payloads at a time."""

    def __init__(self, twin: ServedTwin, seed: int) -> None:
        self._twin, self._draw = twin, random.Random(seed)
        self._waiting: list[tuple[str, bytes]] = []

    def send(self, payload: bytes, number: Number | None) -> None:
        self._waiting.append(("test", payload))
        if self._draw.random() < 0.02:
            self._twin.receive("http", self._waiting)
            self._waiting = []
            # However often rows are made meanwhile.
            if self._draw.random() < 0.5:
                self._twin.seal()

    def finish(self) -> None:
        self._twin.receive("http", self._waiting)
        self._twin.seal()


def predicted(faults: Faults) -> tuple[Counter[str], list[int]]:
    """What becomes of the packets, and the seconds of those that come in time."""
    told, used, latest, come = Counter[str](), list[int](), -np.inf, set[int]()
    for one in script([float(k) for k in range(SECONDS)], faults):
        told["received"] += 1
        if one.kind == "garbage":
            told["refused"] += 1
        elif one.packet in come:
            told["duplicate"] += 1
        elif one.packet < (latest - LATENESS) // ROW * ROW:
            told["late"] += 1
            come.add(one.packet)
        else:
            come.add(one.packet)
            used.append(one.packet)
            latest = max(latest, one.packet)
    return told, used


@pytest.mark.parametrize(
    "seed", [1, 2, *(pytest.param(k, marks=pytest.mark.thorough) for k in range(3, 21))]
)
@pytest.mark.parametrize("faults", [FAULTS, Faults()], ids=["faults", "none"])
def test_counts_are_as_scripted(
    seed: int, faults: Faults, measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    faults = faults.model_copy(update={"seed": seed})
    write_service(tmp_path, measured_bridge)
    settings = TwinSettings.model_validate(
        {
            "name": "east",
            "model": tmp_path / "model.json",
            "settings": tmp_path / "settings.json",
            "rows": {"every": f"{ROW} s", "lateness": f"{LATENESS} s"},
            "source": [{"kind": "http", "clock": {"check": False}}],
        }
    )
    twin = ServedTwin(settings, tmp_path / "east", ServiceClock())
    values = np.random.default_rng(seed).normal(size=(SECONDS, 2))
    times = MIDNIGHT + MICROSECONDS * np.arange(SECONDS)
    record = SentRecord(("D1", "temperature"), times, values, "s")
    play(record, Straight(twin, seed), 1, np.inf, faults)

    told, used = predicted(faults)
    account = sum(twin.packets.account().values(), Account())
    assert (account.received, account.refused) == (told["received"], told["refused"])
    assert (account.duplicate, account.late) == (told["duplicate"], told["late"])
    assert account.used + account.waiting == len(used)
    assert account.difference == 0
    assert twin.numbers("http")["s"].gaps == []
    if faults.late:
        assert told["late"] > 30
        assert told["duplicate"] > 30
    else:
        assert told == Counter(received=SECONDS)
    # Rows are the means of what came in time.
    there = np.zeros(SECONDS, dtype=bool)
    there[used] = True
    rows = (SECONDS - 1 - LATENESS) // ROW
    expected = [
        values[k * ROW : (k + 1) * ROW][there[k * ROW : (k + 1) * ROW]].mean(axis=0)
        for k in range(rows)
    ]
    station = twin.inbox.station
    assert station is not None
    packet = twin.inbox.packet(station, 0, SECONDS)
    np.testing.assert_array_equal(packet.time, ROW * np.arange(rows))
    column = station.channels.index("D1")
    # Of numbers about 1, added up in another order: a mean near 0 has their rounding.
    close = partial(np.testing.assert_allclose, rtol=1e-12, atol=1e-14)
    close(packet.readings[:, column], [one[0] for one in expected])
    close(packet.contexts[:, 0], [one[1] for one in expected])
    twin.close()
