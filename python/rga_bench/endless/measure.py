"""A long run of a live twin: what a row costs late and early, what stays on the disk, taking up."""

import json
import sqlite3
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rga.twin.repository.database import FILE_NAME
from rga_bench.endless.stream import Progress, Stream, settings

#: rows that arrive together
PACKET = 20
#: rows that are fed at a time, and that costs are compared over, by turns
FED, STRETCH, TURNS = 1_000, 200, 10
#: row behind which a row is early
EARLY = 1_000
#: rows of a year of minutes
YEAR = 525_600


@dataclass(frozen=True)
class LongRun:
    """What a long run took.

    Attributes:
        rows, sensors: of it.
        early, late: median time of a row behind the first `EARLY` rows, and at the end, measured by
            turns [s].
        stored: bytes that a step leaves on the disk, its rows among them.
        rows_stored: bytes of the rows of a step: measured, inferred, simulated, and their gaps.
        taken_up: rows behind which the run was taken up by a new process.
        take_up: time of that, without starting Python and loading rga [s].
        memory: largest memory of that process, with Python and rga [B].
        loaded: the same before the run was taken up [B].
    """

    rows: int
    sensors: int
    early: float
    late: float
    stored: float
    rows_stored: float
    taken_up: int
    take_up: float
    memory: int
    loaded: int

    @property
    def ratio(self) -> float:
        """Cost of a row at the end over that of a row at the beginning [-]."""
        return self.late / self.early


def measure(rows: int, sensors: int, panels: int, seed: int, progress: Progress) -> LongRun:
    """Play rows in which nothing happens."""
    stream = Stream(sensors, panels, settings(PACKET), seed)
    taken_up = min(rows, YEAR) // FED * FED
    end = rows - STRETCH * TURNS
    with tempfile.TemporaryDirectory() as folder:
        old, young = Path(folder) / "old", Path(folder) / "young"
        before, first = 0, 0
        for part in sorted({EARLY, min(taken_up, end), end}):
            with stream.twin(old) as twin:
                for begun in range(first, part, FED):
                    stream.play(twin, begun, min(begun + FED, part))
                    progress(begun / rows)
            first = part
            before = before or _size(old)
            if part == min(taken_up, end):
                take_up, memory, loaded = _taken_up(old)
        stored = (_size(old) - before) / ((end - EARLY) / PACKET)
        with stream.twin(old) as late, stream.twin(young) as early:
            stream.play(early, 0, EARLY)
            costs = [
                (
                    stream.play(early, EARLY + k * STRETCH, EARLY + (k + 1) * STRETCH),
                    stream.play(late, end + k * STRETCH, end + (k + 1) * STRETCH),
                )
                for k in range(TURNS)
            ]
    columns = 3 * sensors + len(stream.record.contexts) + 2 * len(stream.model.context)
    young_cost, old_cost = np.median(costs, axis=0).tolist()
    return LongRun(
        rows=rows,
        sensors=sensors,
        early=young_cost,
        late=old_cost,
        stored=stored,
        rows_stored=8.0 * PACKET * (1 + columns),
        taken_up=min(taken_up, end),
        take_up=take_up,
        memory=memory,
        loaded=loaded,
    )


def _taken_up(directory: Path) -> tuple[float, int, int]:
    """Time and memory of a new process that takes a run up."""
    command = [sys.executable, "-m", "rga_bench.endless.taking_up", str(directory)]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    read = json.loads(said)
    return read["seconds"], read["memory"], read["loaded"]


def _size(directory: Path) -> int:
    """Bytes of the repository, with what stands in its log alone."""
    connection = sqlite3.connect(directory / FILE_NAME)
    try:
        pages, bytes_of_page = (
            int(connection.execute(f"PRAGMA {name}").fetchone()[0])
            for name in ("page_count", "page_size")
        )
    finally:
        connection.close()
    return pages * bytes_of_page
