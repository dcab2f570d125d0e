"""What is killed at any time loses nothing that it acknowledged, and doubles nothing."""

import os
from collections.abc import Callable
from typing import Any

import pytest

from live_streams import SETTINGS, sinking
from rga.model import read_model
from rga.records import Record
from rga_bench.operation.broker import PROGRAM
from rga_bench.operation.kills import Killed, Losses, losses

#: `RGA_TEST_KILLS=200` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "2"))
ROWS = max(100, 20 * KILLS)
NEEDS_BROKER = pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")


@pytest.mark.parametrize(
    "killed",
    [
        "service",
        pytest.param("broker", marks=NEEDS_BROKER),
        pytest.param("service behind a broker", marks=[NEEDS_BROKER, pytest.mark.thorough]),
    ],
)
def test_all_is_there_once(
    killed: Killed, measured_bridge: dict[str, Any], measured_record: Callable[..., Record]
) -> None:
    record = sinking(read_model(measured_bridge, "bridge"), measured_record, ROWS)
    found = losses(killed, KILLS, measured_bridge, SETTINGS, record, seed=7)
    assert found == Losses(killed, KILLS, ROWS, lost=0, doubled=0, unaccounted=0, differing=0)
