"""Levels of integration: what a twin does while rows come in.

A calibrates once. B watches the gap; on an alarm rows are gathered, and it recalibrates. C stores
its states as well, and takes a stored one up without learning where that explains the rows behind
an alarm. A method infers row by row, or forward in time, so that each state infers a stream once.

What is watched is the log of the gap of each row. The residuals themselves follow the contexts in a
few patterns that all sensors have in common, and far more rows than a calibration has would be
needed to distinguish these from a change. Stored states are distinguished by the residuals of each
sensor.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import t, ttest_ind

from rga.arrays import FloatArray
from rga.detection import SyncMonitor
from rga_bench.contexts.method import Calibrated
from rga_bench.contexts.setting import Sizes

LEVELS = ("A", "B", "C")
#: probability below which rows are not those of a stored state
UNLIKELY = 0.01


@dataclass(frozen=True)
class CalibratedMethod:
    """A calibrated method, and what it leaves of measured rows: measured minus simulated.

    Attributes:
        calibrated: the method.
        ordinary: of the rows of the first calibration, float[unlabelled, sensors].
        stream: of the rows of the stream, float[stream, sensors].
        usual: what is usual now, float[n, sensors].
    """

    calibrated: Calibrated
    ordinary: FloatArray
    stream: FloatArray
    usual: FloatArray

    @classmethod
    def of(cls, calibrated: Calibrated, real: FloatArray, rows: FloatArray) -> "CalibratedMethod":
        """At the end of a calibration.

        Args:
            calibrated: the method.
            real: rows of the first calibration, float[unlabelled, sensors].
            rows: of the stream, float[stream, sensors].
        """
        ordinary = residuals(calibrated, real)
        return cls(calibrated, ordinary, residuals(calibrated, rows), ordinary)

    def settled(self, latest: slice) -> "CalibratedMethod":
        """The same, to which the latest rows are usual."""
        return replace(self, usual=self.stream[latest])

    def monitor(self, sizes: Sizes) -> SyncMonitor:
        """Watches for gaps that are not usual."""
        return SyncMonitor(self.usual_gaps()[:, None], arl0=sizes.arl0)

    def usual_gaps(self) -> FloatArray:
        """Logs of gaps that are usual, float[n].

        Those of the usual rows are too small, since the method has learned from these: a new row
        has (n + 1) / (n - 1) times the variance of rows to which the mean of each sensor is fitted.
        """
        count = len(self.usual)
        return np.asarray(log_gaps(self.usual) + np.log((count + 1.0) / (count - 1.0)))

    def likely(self, rows: FloatArray) -> float:
        """Log density of residuals of rows, float[n, sensors], after the usual ones.

        Each sensor's are normal, with a mean and a deviation from the usual rows (Student's
        predictive distribution: Gelman et al., Bayesian Data Analysis, 3rd ed., section 3.2).
        """
        count = len(self.usual)
        spread = self.usual.std(axis=0, ddof=1) * np.sqrt(1.0 + 1.0 / count)
        return float(t.logpdf(rows, count - 1, self.usual.mean(axis=0), spread).sum())

    def explains(self, rows: FloatArray) -> bool:
        """Whether the gaps that it leaves of rows may be usual.

        The mean logs may not differ more than is likely (Welch, Biometrika 34, 1947).
        """
        found = ttest_ind(log_gaps(rows), self.usual_gaps(), equal_var=False)
        return bool(found.pvalue >= UNLIKELY)

    def harms(
        self, before: "CalibratedMethod", recent: slice, sizes: Sizes, *, alone: bool
    ) -> bool:
        """Whether the latest rows, or the ordinary ones, are less likely than by another.

        Deviations of sensors count by their logs, as in the likelihood of normal ones that are not
        known: a method may find that few sensors lie, and leave more of these.

        Args:
            before: the other.
            recent: the latest rows of the stream.
            sizes: by what rules.
            alone: whether it stands for rows like the latest alone.
        """
        pairs = [(self.stream[recent], before.stream[recent])]
        if not alone:
            pairs.append((self.ordinary, before.ordinary))
        return any(
            np.log((now**2).mean(axis=0) / (then**2).mean(axis=0)).mean() > np.log(sizes.harm)
            for now, then in pairs
        )


#: a state after it has learned from rows of the stream
Learned = Callable[[CalibratedMethod, slice], CalibratedMethod]


@dataclass
class StreamRun:
    """What became of a twin on a stream.

    Attributes:
        state: at the end.
        stored: states that there were, the first one included.
        alarms: rows that raised one.
        recalibrations: number of times that it learned, those that were taken back included.
        taken_back: recalibrations that did harm.
        recalled: alarms at which a stored state was taken up.
    """

    state: CalibratedMethod
    stored: list[CalibratedMethod]
    alarms: list[int] = field(default_factory=list)
    recalibrations: int = 0
    taken_back: int = 0
    recalled: int = 0


def run_stream(
    first: CalibratedMethod, sizes: Sizes, learned: Learned, *, stores: bool
) -> StreamRun:
    """Run a twin through the stream.

    Args:
        first: as it was calibrated.
        sizes: by what rules.
        learned: makes a state of a state.
        stores: whether stored states are taken up (level C).
    """
    run = StreamRun(first, [first])
    monitor, began = first.monitor(sizes), 0
    raised: int | None = None
    since = 0
    for row in range(len(first.stream)):
        if raised is None:
            seen = log_gaps(run.state.stream[row : row + 1])
            if not monitor.update(seen) or monitor.alarm is None:
                continue
            raised, since = row, began + monitor.alarm.since
            run.alarms.append(row)
        waited = row + 1 - raised
        if stores and waited == sizes.recall and _recall(run, slice(raised, row + 1)):
            pass
        elif waited == sizes.settle:
            # A state for its own rows must not learn from those before the change.
            begun = raised if stores else since
            rows = slice(begun, row + 1), slice(raised, row + 1)
            _learn(run, *rows, sizes, learned, alone=stores)
        else:
            continue
        monitor, began, raised = run.state.monitor(sizes), row + 1, None
    return run


def most_likely(states: Sequence[CalibratedMethod], rows: Sequence[FloatArray]) -> int:
    """Number of the state after which the residuals of rows are likeliest.

    Args:
        states: one or more.
        rows: what each of them leaves of the same rows, float[n, sensors].
    """
    return int(np.argmax([one.likely(own) for one, own in zip(states, rows, strict=True)]))


def _recall(run: StreamRun, recent: slice) -> bool:
    """Take up the likeliest of the stored states, if it explains the rows and is another."""
    best = run.stored[most_likely(run.stored, [one.stream[recent] for one in run.stored])]
    if best is run.state or not best.explains(best.stream[recent]):
        return False
    run.state = best
    run.recalled += 1
    return True


def _learn(
    run: StreamRun, recent: slice, latest: slice, sizes: Sizes, learned: Learned, *, alone: bool
) -> None:
    """Learn from rows; where that does harm, only take for usual what the latest are like."""
    before = run.state
    after = learned(before, recent)
    if after.calibrated is not before.calibrated:
        run.recalibrations += 1
        if after.harms(before, recent, sizes, alone=alone):
            run.taken_back += 1
            after = before
    run.state = after.settled(latest)
    run.stored.append(run.state)


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


def residuals(calibrated: Calibrated, readings: FloatArray) -> FloatArray:
    """Measured minus simulated at the inferred contexts, float[n, sensors]."""
    return readings - calibrated.simulate(calibrated.infer(readings).value)


def log_gaps(residuals: FloatArray) -> FloatArray:
    """Logs of the mean squares of rows, float[n, sensors] -> float[n]."""
    return np.asarray(np.log((residuals**2).mean(axis=1)))
