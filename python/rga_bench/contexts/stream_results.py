"""What becomes of a method in streams into which drifts come."""

from dataclasses import dataclass

from rga.arrays import FloatArray
from rga_bench.contexts.data import CalibrationData, DriftStream, stream_of
from rga_bench.contexts.evaluation import Evaluation
from rga_bench.contexts.levels import (
    LEVELS,
    CalibratedMethod,
    Learned,
    StreamRun,
    delays,
    residuals,
    run_stream,
)
from rga_bench.contexts.method import Calibrated
from rga_bench.contexts.novel import with_novel
from rga_bench.contexts.rows import METHODS
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import ContextsTask


@dataclass(frozen=True)
class StreamResult:
    """A method at a level, after it has run through a stream.

    Attributes:
        drift: that came into the stream.
        level: of integration.
        ordinary, drifted: scores of test rows under usual conditions, and under the drift.
        delays: rows from each change to its alarm, both counted; None where there was none.
        watched: rows before any change up to the first alarm.
        false_alarm: whether this alarm came before any change.
        alarms, recalibrations, taken_back, recalled: number of each.
    """

    drift: str
    level: str
    ordinary: Score
    drifted: Score
    delays: tuple[int | None, ...] = ()
    watched: int = 0
    false_alarm: bool = False
    alarms: int = 0
    recalibrations: int = 0
    taken_back: int = 0
    recalled: int = 0


def results_of_streams(
    task: ContextsTask, known: CalibrationData, calibrated: Calibrated, usual: Evaluation
) -> list[StreamResult]:
    """Every drift of a task at every level.

    Args:
        task: names the drifts, each of which comes into a stream of its own.
        known: what the method was calibrated on.
        calibrated: the method.
        usual: test rows under usual conditions.

    Raises:
        InputError: no such drift.
    """
    sizes, played = task.sizes, []
    ordinary = residuals(calibrated, known.problem.real)
    for drift in task.drifts:
        stream = stream_of(task, drift)
        rows = stream.rows.readings
        evaluation = Evaluation(stream.drifted, known.problem.ranges, sizes.settle)
        first = CalibratedMethod(calibrated, ordinary, residuals(calibrated, rows), ordinary)
        scores = usual.score(calibrated), evaluation.score(calibrated)
        played.append(StreamResult(drift, LEVELS[0], *scores))
        for level in LEVELS[1:]:
            stores = level == LEVELS[-1] and sizes.repository == "measured"
            learned = _fine_tuned(known.problem.real, rows, alone=stores)
            if level == LEVELS[-1] and not stores:
                learned = with_novel(METHODS[task.row], known, rows)
            run = run_stream(first, sizes, learned, stores=stores)
            states = run.stored if stores else [run.state]
            scores = usual.score_of_likeliest(states), evaluation.score_of_likeliest(states)
            played.append(_played(drift, level, scores, stream, run))
    return played


def _played(
    drift: str, level: str, score: tuple[Score, Score], stream: DriftStream, run: StreamRun
) -> StreamResult:
    rows = len(stream.rows.readings)
    quiet = stream.changes[0] if stream.changes else rows
    raised = run.alarms[0] if run.alarms else rows
    return StreamResult(
        drift,
        level,
        *score,
        delays=delays(run.alarms, stream.changes, rows),
        watched=min(raised + 1, quiet),
        false_alarm=raised < quiet,
        alarms=len(run.alarms),
        recalibrations=run.recalibrations,
        taken_back=run.taken_back,
        recalled=run.recalled,
    )


def _fine_tuned(real: FloatArray, rows: FloatArray, *, alone: bool) -> Learned:
    """A state that has learned from rows of a stream (T1), for rows like these alone or for all."""

    def learned(state: CalibratedMethod, recent: slice) -> CalibratedMethod:
        after = state.calibrated.recalibrated(rows[recent], alone=alone)
        return state if after is state.calibrated else CalibratedMethod.of(after, real, rows)

    return learned
