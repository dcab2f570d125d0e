"""Levels of integration: what a twin does while rows come in.

A calibrates once. B watches the gap; on an alarm rows are gathered, and it recalibrates. C stores
its states as well, and takes a stored one up without learning where that explains the rows behind
an alarm. A method infers row by row, or forward in time, so that each state infers a stream once.

What is watched is the log of the gap of each row. The residuals themselves follow the contexts in a
few patterns that all sensors have in common, and far more rows than a calibration has would be
needed to tell these from a change.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import ttest_ind

from rga.benchmark.loi.method import Calibrated
from rga.benchmark.loi.setting import Sizes
from rga.detection import SyncMonitor
from rga.model.parameter import FloatArray

LEVELS = ("A", "B", "C")
#: probability below which rows are not those of a stored state
UNLIKELY = 0.01


@dataclass(frozen=True)
class State:
    """A calibrated method, and what it leaves of measured rows.

    Attributes:
        calibrated: the method.
        ordinary: gaps of the rows of the first calibration [mm^2], float[unlabelled].
        stream: the same of the stream, float[stream].
        usual: gaps that are usual now [mm^2], float[n].
    """

    calibrated: Calibrated
    ordinary: FloatArray
    stream: FloatArray
    usual: FloatArray

    @classmethod
    def of(cls, calibrated: Calibrated, real: FloatArray, rows: FloatArray) -> "State":
        """At the end of a calibration.

        Args:
            calibrated: the method.
            real: rows of the first calibration, float[unlabelled, sensors].
            rows: of the stream, float[stream, sensors].
        """
        ordinary = gaps(calibrated, real)
        return cls(calibrated, ordinary, gaps(calibrated, rows), ordinary)

    def settled(self, latest: slice) -> "State":
        """The same, to which the gaps of the latest rows are usual."""
        return replace(self, usual=self.stream[latest])

    def monitor(self, sizes: Sizes) -> SyncMonitor:
        """Watches for gaps that are not usual."""
        return SyncMonitor(np.log(self.usual)[:, None], arl0=sizes.arl0)

    def likeness(self, gaps: FloatArray) -> float:
        """How usual gaps of rows [mm^2], float[n], are to this state, 0 to 1.

        The probability of mean logs that differ as much (Welch, Biometrika 34, 1947).
        """
        return float(ttest_ind(np.log(gaps), np.log(self.usual), equal_var=False).pvalue)

    def harms(self, before: "State", recent: slice, sizes: Sizes) -> bool:
        """Whether it leaves a larger gap than another, of the latest rows or the ordinary ones."""
        pairs = (self.ordinary, before.ordinary), (self.stream[recent], before.stream[recent])
        return any(now.mean() > sizes.harm * then.mean() for now, then in pairs)


#: a state after it has learned from rows of the stream
Learned = Callable[[State, slice], State]


@dataclass
class Life:
    """What became of a twin on a stream.

    Attributes:
        state: at the end.
        stored: states that there were, the first one included.
        alarms: rows that raised one.
        recalibrations: number of times that it learned, those that were taken back included.
        taken_back: recalibrations that did harm.
        recalled: alarms at which a stored state was taken up.
    """

    state: State
    stored: list[State]
    alarms: list[int] = field(default_factory=list)
    recalibrations: int = 0
    taken_back: int = 0
    recalled: int = 0


def live(first: State, sizes: Sizes, learned: Learned, *, stores: bool) -> Life:
    """Let a twin live through the stream.

    Args:
        first: as it was calibrated.
        sizes: by what rules.
        learned: makes a state of a state.
        stores: whether stored states are taken up (level C).
    """
    life = Life(first, [first])
    monitor, began = first.monitor(sizes), 0
    raised: int | None = None
    since = 0
    for row in range(len(first.stream)):
        if raised is None:
            if not monitor.update(np.log(life.state.stream[row, None])) or monitor.alarm is None:
                continue
            raised, since = row, began + monitor.alarm.since
            life.alarms.append(row)
        waited = row + 1 - raised
        if stores and waited == sizes.recall and _recall(life, slice(raised, row + 1)):
            pass
        elif waited == sizes.settle:
            _learn(life, slice(since, row + 1), slice(raised, row + 1), sizes, learned)
        else:
            continue
        monitor, began, raised = life.state.monitor(sizes), row + 1, None
    return life


def _recall(life: Life, recent: slice) -> bool:
    """Take up the stored state to which rows are most usual, if they are to any."""
    found = {
        number: one.likeness(one.stream[recent])
        for number, one in enumerate(life.stored)
        if one is not life.state
    }
    best = max(found, key=lambda number: found[number], default=None)
    if best is None or found[best] < UNLIKELY:
        return False
    life.state = life.stored[best]
    life.recalled += 1
    return True


def _learn(life: Life, recent: slice, latest: slice, sizes: Sizes, learned: Learned) -> None:
    """Learn from rows; where that does harm, only take for usual what the latest are like."""
    before = life.state
    after = learned(before, recent)
    if after.calibrated is not before.calibrated:
        life.recalibrations += 1
        if after.harms(before, recent, sizes):
            life.taken_back += 1
            after = before
    life.state = after.settled(latest)
    life.stored.append(life.state)


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


def gaps(calibrated: Calibrated, readings: FloatArray) -> FloatArray:
    """Mean squares of measured minus simulated at the inferred contexts [mm^2], float[n]."""
    simulated = calibrated.simulate(calibrated.infer(readings).value)
    return np.asarray(((readings - simulated) ** 2).mean(axis=1))
