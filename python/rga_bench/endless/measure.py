"""A long run of a twin, the time of every step, and what it leaves on the disk."""

import sqlite3
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rga.twin import Settings
from rga.twin.runner import Running, taken_up
from rga_bench.speed.sized_case import SizedCase

#: rows that arrive together, and those of the first calibration
PACKET, CALIBRATION = 20, 200
#: rows over which costs are compared, and where the first of them begin
STRETCH, EARLY = 1_000, 1_000


@dataclass(frozen=True)
class LongRun:
    """What a long run took.

    Attributes:
        case: its record.
        early, late: median time of a row behind the first `EARLY` rows, and at the end [s].
        stored: bytes that a step leaves on the disk, its rows among them.
        rows_stored: bytes of the rows of a step: measured, inferred, simulated, and their gaps.
        take_up: time to take the run up again [s].
    """

    case: SizedCase
    early: float
    late: float
    stored: float
    rows_stored: float
    take_up: float

    @property
    def ratio(self) -> float:
        """Cost of a row at the end over that of a row at the beginning [-]."""
        return self.late / self.early


def measure(case: SizedCase, progress: Callable[[float], None]) -> LongRun:
    """Play the record of a case; nothing is hidden in it, and no false alarm is waited for."""
    model, record = case.draw()
    settings = Settings(packet=PACKET, calibration_rows=CALIBRATION, arl0=1e12)
    costs: list[tuple[int, float]] = []
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "twin.sqlite"
        with taken_up(model, record, place, settings, case.seed) as running:
            early = _played(running, EARLY + STRETCH, costs, progress)
            before = _size(place)
            steps = _played(running, len(record), costs, progress) - early
            stored = (_size(place) - before) / steps
        begun = time.perf_counter()
        with taken_up(model, record, place, settings, case.seed):
            take_up = time.perf_counter() - begun
    row, cost = np.array(costs).T
    columns = 3 * len(record.sensors) + len(record.contexts) + 2 * len(model.context)
    return LongRun(
        case=case,
        early=float(np.median(cost[(row >= EARLY) & (row < EARLY + STRETCH)])) / PACKET,
        late=float(np.median(cost[row >= len(record) - STRETCH])) / PACKET,
        stored=stored,
        rows_stored=8.0 * PACKET * (1 + columns),
        take_up=take_up,
    )


def _played(
    running: Running,
    end: int,
    costs: list[tuple[int, float]],
    progress: Callable[[float], None],
) -> int:
    """Play to a row, and note row and time of every step that watches.

    Returns:
        How many steps were noted so far.
    """
    while running.row < end and running.stage not in ("close", "report", "done"):
        stage, row, begun = running.stage, running.row, time.perf_counter()
        running.step()
        if stage == "watch":
            costs.append((row, time.perf_counter() - begun))
        progress(running.row / running.rows)
    return len(costs)


def _size(place: Path) -> int:
    """Bytes of a database, with what stands in its log alone."""
    connection = sqlite3.connect(place)
    try:
        pages, bytes_of_page = (
            int(connection.execute(f"PRAGMA {name}").fetchone()[0])
            for name in ("page_count", "page_size")
        )
    finally:
        connection.close()
    return pages * bytes_of_page
