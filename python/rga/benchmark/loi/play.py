"""A row of the table on a split: a method learns, lives through streams, and is scored."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from rga.benchmark.loi.data import Calibration, calibration_of, stream_of
from rga.benchmark.loi.drift import Measured
from rga.benchmark.loi.floors import FLOORS, floor
from rga.benchmark.loi.levels import LEVELS, Learned, State, delays, live, residuals
from rga.benchmark.loi.method import Calibrated, Estimate
from rga.benchmark.loi.novel import with_novel
from rga.benchmark.loi.rows import METHODS
from rga.benchmark.loi.score import Score, score
from rga.benchmark.loi.setting import DRIFTING, Sizes, Task
from rga.inference.determinism import one_thread
from rga.model.parameter import FloatArray


@dataclass(frozen=True)
class Played:
    """A method at a level, after it has lived through a stream.

    Attributes:
        drift: that came into the stream.
        level: of integration.
        ordinary, drifted: scores of test rows, before the drift's kind and after it.
        delays: rows from each change to its alarm; None where there was none.
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


@dataclass(frozen=True)
class Outcome:
    """What became of a task.

    Attributes:
        id, split, gap, manner, row: of the task.
        score: of test rows at level A; None where drifts are played.
        played: every drift at every level.
        learning: time that the method took to learn [s].
        inference: time that it took to infer a row [s].
    """

    id: str
    split: int
    gap: str
    manner: str
    row: str
    score: Score | None
    played: tuple[Played, ...] = ()
    learning: float | None = field(default=None, compare=False)
    inference: float | None = field(default=None, compare=False)


def play(task: Task) -> Outcome:
    """Play a task; the outcome depends on the task alone.

    Raises:
        InputError: no such drift or manner.
    """
    with threadpool_limits(1), one_thread():
        known = calibration_of(task)
        empty = Outcome(task.id, task.split, task.gap, task.manner, task.row, None)
        if task.row in FLOORS:
            return _floors(task, known, empty)
        begun = time.perf_counter()
        calibrated = METHODS[task.row].calibrated(known)
        learning = time.perf_counter() - begun
        begun = time.perf_counter()
        calibrated.infer(known.test.readings)
        inference = (time.perf_counter() - begun) / len(known.test.readings)
        timed = replace(empty, learning=learning, inference=inference)
        if task.manner != DRIFTING:
            return replace(timed, score=_scored([calibrated], known, known.test, task.sizes))
        ordinary = residuals(calibrated, known.problem.real)
        played = [
            one
            for drift in task.drifts
            for one in _levels(task, known, calibrated, ordinary, drift)
        ]
        return replace(timed, played=tuple(played))


def _floors(task: Task, known: Calibration, empty: Outcome) -> Outcome:
    def of(measured: Measured) -> Score:
        return floor(task.row, known.problem, measured)

    if task.manner != DRIFTING:
        return replace(empty, score=of(known.test))
    streams = {drift: stream_of(task, drift) for drift in task.drifts}
    return replace(
        empty,
        played=tuple(
            Played(drift, LEVELS[0], of(stream.ordinary), of(stream.drifted))
            for drift, stream in streams.items()
        ),
    )


def _levels(
    task: Task, known: Calibration, calibrated: Calibrated, ordinary: FloatArray, drift: str
) -> list[Played]:
    """A drift at every level."""
    sizes, stream = task.sizes, stream_of(task, drift)
    rows = stream.rows.readings

    def scored(level: str, candidates: Sequence[Calibrated]) -> Played:
        return Played(
            drift,
            level,
            _scored(candidates, known, stream.ordinary, sizes),
            _scored(candidates, known, stream.drifted, sizes),
        )

    first = State.of(calibrated, ordinary, rows)
    fine_tuned = remembered(_fine_tuned(known, rows))
    quiet = stream.changes[0] if stream.changes else len(rows)
    found = [scored(LEVELS[0], [calibrated])]
    for level in LEVELS[1:]:
        stores = level == LEVELS[-1] and sizes.repository == "measured"
        learned = fine_tuned
        if level == LEVELS[-1] and not stores:
            learned = with_novel(METHODS[task.row], known, rows)
        life = live(first, sizes, learned, stores=stores)
        candidates = [one.calibrated for one in (life.stored if stores else [life.state])]
        raised = life.alarms[0] if life.alarms else len(rows)
        found.append(
            replace(
                scored(level, candidates),
                delays=delays(life.alarms, stream.changes, len(rows)),
                watched=min(raised + 1, quiet),
                false_alarm=raised < quiet,
                alarms=len(life.alarms),
                recalibrations=life.recalibrations,
                taken_back=life.taken_back,
                recalled=life.recalled,
            )
        )
    return found


def _fine_tuned(known: Calibration, rows: FloatArray) -> Learned:
    """A state that has learned from rows of a stream (T1)."""

    def learned(state: State, recent: slice) -> State:
        after = state.calibrated.recalibrated(rows[recent])
        if after is state.calibrated:
            return state
        return State.of(after, residuals(after, known.problem.real), rows)

    return learned


def remembered(learned: Learned) -> Learned:
    """The same, which does nothing twice: levels B and C learn alike up to their parting."""
    known: dict[tuple[int, int, int], tuple[Calibrated, State]] = {}

    def again(state: State, recent: slice) -> State:
        key = (id(state.calibrated), recent.start, recent.stop)
        if key not in known:
            # The method is kept, so that no other one gets its id.
            known[key] = (state.calibrated, learned(state, recent))
        return known[key][1]

    return again


def _scored(
    candidates: Sequence[Calibrated], known: Calibration, measured: Measured, sizes: Sizes
) -> Score:
    """Every block of rows is inferred by the candidate that leaves the least gap there."""
    several = {id(one): one for one in candidates}.values()
    estimates = [one.infer(measured.readings) for one in several]
    simulated = [
        one.simulate(estimate.value) for one, estimate in zip(several, estimates, strict=True)
    ]
    blocks = np.arange(len(measured.readings)) // sizes.settle
    left = [((measured.readings - one) ** 2).mean(axis=1) for one in simulated]
    left_by_block = [np.bincount(blocks, one) for one in left]
    chosen = np.argmin(left_by_block, axis=0)[blocks]
    spreads = [one.spread for one in estimates if one.spread is not None]
    estimate = Estimate(
        _picked([one.value for one in estimates], chosen),
        _picked(spreads, chosen) if spreads else None,
    )
    return score(measured, estimate, _picked(simulated, chosen), known.problem.ranges)


def _picked(several: Sequence[FloatArray], chosen: NDArray[np.intp]) -> FloatArray:
    """Each row from the array of its number."""
    return np.asarray(np.stack(several)[chosen, np.arange(len(chosen))])
