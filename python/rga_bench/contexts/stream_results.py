"""What becomes of a method in streams into which drifts come."""

from collections.abc import Sequence
from dataclasses import dataclass

from rga.twin.calibration.estimator import Learn
from rga.twin.history import History
from rga_bench.contexts.data import CalibrationData, DriftStream, stream_of
from rga_bench.contexts.score import Score, score_of_history
from rga_bench.contexts.setting import LEVELS, ContextsTask
from rga_bench.contexts.twin_run import LearnedOnce, TwinStream, lived_through


@dataclass(frozen=True)
class StreamResult:
    """A twin at a level, on a stream.

    Attributes:
        drift: that came into the stream.
        level: of integration.
        ordinary, drifted: scores of the rows behind the stream, as they were inferred at the time:
            under the drift, and then under usual conditions again.
        delays: rows from each change to its alarm, both counted; None where there was none.
        watched: rows before any change up to the first alarm.
        false_alarm: whether this alarm came before any change.
        alarms, recalibrations, recalled: number of each.
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
    recalled: int = 0


def results_of_streams(
    task: ContextsTask, known: CalibrationData, learn: Learn
) -> list[StreamResult]:
    """Every drift of a task at every level.

    Args:
        task: names the drifts, each of which comes into a stream of its own.
        known: what twins are calibrated on.
        learn: learns to infer contexts.

    Raises:
        InputError: no such drift.
    """
    played, once = [], LearnedOnce(learn)
    for drift in task.drifts:
        given = stream_of(task, drift)
        stream = TwinStream.of(known, given)
        for level in LEVELS:
            history = lived_through(known, stream, once, level)
            played.append(_result(drift, level, known, given, stream, history))
    return played


def _result(
    drift: str,
    level: str,
    known: CalibrationData,
    given: DriftStream,
    stream: TwinStream,
    history: History,
) -> StreamResult:
    ordinary, drifted = (
        score_of_history(history, stream.contexts, rows, known.ranges)
        for rows in (stream.ordinary, stream.drifted)
    )
    kinds = [event.kind for event in history.events]
    first, rows = stream.stream.start, len(given.rows.readings)
    alarms = [event.row - first for event in history.events if event.kind == "alarm"]
    quiet = given.changes[0] if given.changes else rows
    raised = min([one for one in alarms if one < quiet], default=rows)
    return StreamResult(
        drift,
        level,
        ordinary,
        drifted,
        delays=delays(alarms, given.changes, rows),
        watched=min(raised + 1, quiet) if level != LEVELS[0] else 0,
        false_alarm=raised < quiet,
        alarms=len(alarms),
        recalibrations=kinds.count("recalibration"),
        recalled=kinds.count("recall"),
    )


def delays(alarms: Sequence[int], changes: Sequence[int], rows: int) -> tuple[int | None, ...]:
    """Rows from each change to its alarm, both counted; None where none came before the next.

    >>> delays([3, 12, 14], [10, 20], 30)
    (3, None)
    """
    ends = [*changes[1:], rows]
    found = []
    for change, end in zip(changes, ends, strict=False):
        own = [one for one in alarms if change <= one < end]
        found.append(own[0] - change + 1 if own else None)
    return tuple(found)
