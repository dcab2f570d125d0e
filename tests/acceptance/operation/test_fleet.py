"""Several bridges: a diagnosis of one, however long it takes, keeps no row of another waiting."""

import json
import logging
import multiprocessing
import os
import resource
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

import rga
from live_streams import SETTINGS, history, kinds, sinking
from rga.model import read_model
from rga.operation.disk.room import DiskRoom
from rga.operation.workers import Workers
from rga.records import Record
from rga.twin.repository.database import FILE_NAME
from served.made_service import waited_for

#: bridges; `RGA_TEST_FLEET=50` is what is promised
BRIDGES = int(os.environ.get("RGA_TEST_FLEET", "8"))
#: rows that are played before, and of the others meanwhile
ROWS, LATER = 100, 20


def waits(place: Path) -> bool:
    with rga.LiveTwin(place) as twin:
        return twin.waiting[0] >= (SETTINGS.packet or 1)


def plays(place: Path, process: int | None) -> bool:
    """Whether a process holds the lease of a twin."""
    writer = place / f"{FILE_NAME}.writer"
    with suppress(OSError):
        return f"process {process} " in writer.read_text("utf-8")
    return False


def is_diagnosed(place: Path) -> bool:
    with rga.LiveTwin(place) as twin:
        return "diagnosis" in kinds(history(twin).events)


def check(folder: Path, content: dict[str, Any], measured: Any, bridges: int) -> None:
    (folder / "model.json").write_text(json.dumps(content), "utf-8")
    model = read_model(content, "bridge")
    sunk = sinking(model, measured, ROWS)
    calm = sinking(model, measured, ROWS + LATER, sinks=False)
    places = [folder / str(k) for k in range(bridges)]
    for place in places:
        with rga.live(folder / "model.json", place, settings=SETTINGS, name="bridge") as twin:
            twin.feed(sunk if place == places[0] else calm.rows(slice(ROWS)))
            # What is left of the first is its diagnosis.
            twin.play(lambda running: running.stage != "diagnose")
    workers = Workers(places, None, DiskRoom(folder, 0.0).is_enough)
    workers.start()
    (heavy,) = waited_for(
        lambda: [one for one in multiprocessing.active_children() if one.name == "heavy"]
    )
    assert heavy.pid is not None
    waited_for(lambda: plays(places[0], heavy.pid))
    # It goes on with nothing until it is told to: no diagnosis takes longer.
    os.kill(heavy.pid, signal.SIGSTOP)
    for place in places[1:]:
        with rga.LiveTwin(place) as twin:
            twin.feed(calm.rows(slice(ROWS, ROWS + LATER)))
    waited_for(lambda: not any(waits(place) for place in places[1:]))
    assert plays(places[0], heavy.pid)
    assert not is_diagnosed(places[0])
    os.kill(heavy.pid, signal.SIGCONT)
    waited_for(lambda: is_diagnosed(places[0]))
    assert workers.failed == {}
    workers.stop()


def test_rows_of_others_are_played_while_one_is_diagnosed(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    check(tmp_path, measured_bridge, measured_record, 3)


@pytest.mark.thorough
def test_rows_of_many_are_played_while_one_is_diagnosed(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    check(tmp_path, measured_bridge, measured_record, BRIDGES)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    rows = LATER * (BRIDGES - 1)
    elapsed = time.monotonic() - begun
    words = f"{BRIDGES} bridges: {spent:.1f} s of CPU in {elapsed:.0f} s, {rows} rows meanwhile"
    logging.getLogger(__name__).info(words)
