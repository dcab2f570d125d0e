"""A twin that goes on for ever holds the latest rows alone, and is taken up from few."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, kinds, sinking
from rga.model import Model
from rga.records import Record
from rga.twin import Settings
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository import RunView
from rga.twin.rows.recent import KEPT

ROWS, PACKET = 6000, 200


def test_what_is_in_memory_and_what_is_read_stays_bounded(
    sound: tuple[Model, Record],
    measured_record: Callable[..., Record],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model = sound[0]
    record = sinking(model, measured_record, ROWS, sinks=False)
    wanted = {"calibration_rows": 400, "packet": PACKET, "settle": 200, "arl0": 1e9}
    settings = Settings.model_validate(SETTINGS.model_dump() | wanted)
    held: list[int] = []
    read: list[int] = []
    measured = RunView.measured

    def counted(self: RunView, first: int = 0, end: int | None = None) -> Any:
        found = measured(self, first, end)
        read.append(len(found.rows))
        return found

    monkeypatch.setattr(RunView, "measured", counted)
    with rga.live(model, tmp_path, settings=settings) as twin:
        for first in range(0, ROWS, 500):
            twin.feed(record.rows(slice(first, first + 500)))
            happened = twin.play()
            running = twin._running
            assert running is not None
            held.append(len(running.calibration.ledger._table))
            assert kinds(happened) in ([], ["calibration"])
            # What was taken in does not wait in the inbox any more.
            waiting = Inbox(tmp_path).packet(running._hardware.station, 0, ROWS)
            assert len(waiting.time) < PACKET
        assert running.row == ROWS
    assert max(held) <= 3 * KEPT
    # While it goes on it reads nothing.
    assert read == []
    with rga.LiveTwin(tmp_path) as twin:
        assert twin.play() == []
        running = twin._running
        assert running is not None
        assert running.row == ROWS
        assert len(running.calibration.ledger._table) <= 3 * KEPT
        assert np.isfinite(running.gap)
    assert 0 < sum(read) <= 2 * KEPT
