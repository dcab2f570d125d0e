"""A row of the table on a split: a method learns, runs through streams, and is scored."""

import time
from dataclasses import dataclass, field, replace

from threadpoolctl import threadpool_limits

from rga.inference.networks.determinism import one_thread
from rga_bench.contexts.data import CalibrationData, calibration_of, stream_of
from rga_bench.contexts.drift import MeasuredRows
from rga_bench.contexts.evaluation import evaluated
from rga_bench.contexts.floors import FLOORS, floor
from rga_bench.contexts.rows import METHODS
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import DRIFTING, LEVELS, ContextsTask
from rga_bench.contexts.stream_results import StreamResult, results_of_streams


@dataclass(frozen=True)
class TaskOutcome:
    """What became of a task.

    Attributes:
        id, split, gap, manner, row: of the task.
        score: of test rows at level A, before any drift.
        played: every drift at every level; none where there are no drifts.
        learning: time that the method took to learn [s].
        inference: time that it took to infer a row [s].
    """

    id: str
    split: int
    gap: str
    manner: str
    row: str
    score: Score
    played: tuple[StreamResult, ...] = ()
    learning: float | None = field(default=None, compare=False)
    inference: float | None = field(default=None, compare=False)


def run_task(task: ContextsTask) -> TaskOutcome:
    """Run a task; the outcome depends on the task alone, but for the times.

    Raises:
        InputError: no such drift or manner.
    """
    with threadpool_limits(1), one_thread():
        known = calibration_of(task)
        drifts = task.drifts if task.manner == DRIFTING else ()
        if task.row in FLOORS:
            return _floors(task, known, drifts)
        begun = time.perf_counter()
        calibrated = METHODS[task.row].calibrated(known)
        learned = time.perf_counter()
        score = evaluated(calibrated, known)
        inferred = time.perf_counter()
        played = results_of_streams(task, known, METHODS[task.row].learn) if drifts else []
        return replace(
            _outcome(task, score, played),
            learning=learned - begun,
            inference=(inferred - learned) / len(known.test.readings),
        )


def _floors(task: ContextsTask, known: CalibrationData, drifts: tuple[str, ...]) -> TaskOutcome:
    def of(measured: MeasuredRows) -> Score:
        return floor(task.row, known, measured)

    ordinary = of(known.test)
    drifted = {drift: of(stream_of(task, drift).drifted) for drift in drifts}
    played = [StreamResult(drift, LEVELS[0], ordinary, one) for drift, one in drifted.items()]
    return _outcome(task, ordinary, played)


def _outcome(task: ContextsTask, score: Score, played: list[StreamResult]) -> TaskOutcome:
    return TaskOutcome(task.id, task.split, task.gap, task.manner, task.row, score, tuple(played))
