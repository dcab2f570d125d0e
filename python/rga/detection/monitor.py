"""The monitor: alarms about any change of a stream, as rare without one as its user tolerates."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rga import _core
from rga.arrays import FloatArray
from rga.detection.alarm_explanation import Alarm, explain
from rga.detection.assumption_checks import assumption_warnings
from rga.detection.baseline.baseline_model import FEWEST, Reference, unwatched
from rga.detection.baseline.slow_noise import long_run_variance
from rga.detection.baseline.stationarity import watched
from rga.detection.rarity import as_arl0
from rga.detection.rows import row as row_of
from rga.detection.rows import table, within
from rga.detection.statistic import STATISTICS
from rga.detection.thresholds import StreamNoise, calibration, memory_of
from rga.errors import InputError
from rga.numerics.seeds import as_seed

#: latest rows that an alarm is explained by
ROWS_KEPT = 2048
#: sensors go together in a matrix
MOST_SENSORS = 10_000
RETURNED = "give the bytes that to_bytes() returned"
#: lengths of a baseline grow by this factor from one calibration to the next
LENGTHS = 1.25


class SyncMonitor:
    """Watches residuals, or readings, of several sensors for any change of what they are like.

    Learned from a baseline during which nothing changed: level, memory (autoregression), slow
    noise beyond it, the distribution of each sensor's readings, heavy tails included, and what
    sensors have in common.
    Statistics for steps in one, several or all sensors, for drifts and for changes of variance, on
    scales from a quarter of a standard deviation up, are each held against a threshold. Thresholds
    come from simulated streams, whose references are learned from baselines as long as the user's,
    so that an alarm without a change comes once in `arl0` rows on average. What the baseline itself
    shows, and chance does not, is usual: sensors that are off together now and then, for example.

    An alarm stands until `begin_again`. NaN is a missing reading; gaps raise no alarms.

    Args:
        baseline: float[rows, n_sensors], NaN where missing; a sensor of which it says too little
            is not watched, and `unwatched` names it. The longer, the smaller the changes
            that can be distinguished from what the baseline leaves open.
        arl0: rows between false alarms (average run length without a change), 100 to 1e12;
            `rows_between` counts them from alarms per month.
        seed: of the simulation of thresholds.
        names: of the sensors, by which warnings call them; None: by their numbers.
        fitted: numbers that were fitted to each sensor of the baseline beforehand, such as what
            temperature does to it: a baseline tells the less of each the more there are.

    Raises:
        InputError: the baseline is no table of numbers, has a number of names that is not that of
            its sensors, or no sensor with 30 readings that are not all alike; a number beyond 1e60
            in size; `arl0` below 100 or above 1e12; a seed that is none; `fitted` below 0.

    Examples:
        >>> import numpy as np
        >>> generator = np.random.default_rng(0)
        >>> monitor = SyncMonitor(generator.normal(size=(500, 3)), arl0=2000)
        >>> stream = generator.normal(size=(400, 3))
        >>> stream[300:, 1] += 2.0
        >>> int(np.argmax(monitor.update_many(stream))), monitor.alarm.sensors, monitor.alarm.kind
        (307, (1,), 'step')
    """

    def __init__(
        self,
        baseline: ArrayLike,
        *,
        arl0: float = 10_000.0,
        seed: int = 0,
        names: Sequence[str] | None = None,
        fitted: int = 0,
    ) -> None:
        given = table(baseline, "the baseline")
        within(given, 0, "the baseline")
        called = [str(column) for column in range(given.shape[1])] if names is None else names
        if len(called) != given.shape[1]:
            what = f"{len(called)} names of {given.shape[1]} sensors"
            raise InputError(what, "names", "give one for each column of the baseline")
        if not (isinstance(fitted, int) and fitted >= 0):
            raise InputError(f"fitted is {fitted!r}", "fitted", "give a whole number from 0 on")
        self._unwatched = unwatched(given)
        self._watched = np.array([one not in self._unwatched for one in range(given.shape[1])])
        if not self._watched.any():
            what = f"no sensor can be watched; as to sensor 0, {self._unwatched[0]}"
            raise InputError(what, "the baseline", "give a longer one, or other sensors")
        rows = np.ascontiguousarray(given[:, self._watched])
        reference = Reference.learn(rows)
        peaks, scores = watched(reference, rows)
        noise = StreamNoise.like(
            rows.shape[1],
            memory_of(reference.weights),
            long_run_variance(scores),
            float(np.isnan(rows).mean()),
        )
        telling = max(len(rows) / (1 + fitted), FEWEST / (1.0 - noise.missing))
        simulated = calibration(noise, _rounded(telling), as_arl0(arl0), as_seed(seed))
        thresholds = simulated.beside(peaks, len(rows), arl0)
        self._begin(reference, thresholds, arl0, seed)
        own = [called[column] for column in np.flatnonzero(self._watched).tolist()]
        self._warnings: tuple[str, ...] = assumption_warnings(reference, rows, simulated, own)

    @classmethod
    def known(cls, n_sensors: int, *, arl0: float = 10_000.0, seed: int = 0) -> Self:
        """A monitor of readings that are independent and standard normal without a change.

        Args:
            n_sensors: 1 or more.
            arl0: rows between false alarms.
            seed: of the simulation of thresholds.

        Raises:
            InputError: no sensor; `arl0` below 100 or above 1e12; a seed that is none.
        """
        if not (isinstance(n_sensors, int | np.integer) and 1 <= n_sensors <= MOST_SENSORS):
            remedy = f"give a whole number from 1 to {MOST_SENSORS}"
            raise InputError(f"{n_sensors!r} sensors", "n_sensors", remedy)
        monitor = cls.__new__(cls)
        monitor._watched, monitor._unwatched = np.ones(n_sensors, dtype=bool), {}
        simulated = calibration(StreamNoise(n_sensors), None, as_arl0(arl0), as_seed(seed))
        monitor._begin(Reference.known(n_sensors), simulated.thresholds(arl0), arl0, seed)
        return monitor

    def update(self, row: ArrayLike) -> bool:
        """Whether an alarm stands after a row, float[n_sensors], raised by it or before.

        Raises:
            InputError: another shape, or an infinite number; the row has then not entered.
        """
        return bool(self._take(row_of(row, len(self._watched)))[0])

    def update_many(self, rows: ArrayLike) -> NDArray[np.bool_]:
        """Whether an alarm stands after each of the rows float[n, n_sensors]: bool[n].

        Raises:
            InputError: another shape, or an infinite number; no row has then entered.
        """
        return self._take(table(rows, "rows"))

    @property
    def alarm(self) -> Alarm | None:
        """The alarm that stands, explained by the rows around it.

        These are the 1024 rows up to the alarm and the 1024 behind it, as far as they have come:
        the explanation gets surer with them.
        """
        raised = self._statistics.alarm
        if raised is None:
            return None
        row, statistic = raised
        scores = self._statistics.recent().astype(float)
        first = self._statistics.recent_first
        raised_by = str(STATISTICS[statistic])
        alarm = explain(scores, first, row, raised_by, self._sizes, self._signature)
        columns = np.flatnonzero(self._watched)
        return replace(alarm, sensors=tuple(columns[list(alarm.sensors)].tolist()))

    @property
    def rows(self) -> int:
        """Rows seen."""
        return self._statistics.rows

    @property
    def arl0(self) -> float:
        """Rows between false alarms."""
        return self._arl0

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why false alarms may come more often than they should."""
        return self._warnings

    @property
    def unwatched(self) -> dict[int, str]:
        """Sensors that are not watched, by their columns, and why."""
        return dict(self._unwatched)

    def begin_again(self) -> None:
        """Forget the alarm and all evidence; what was learned from the baseline stays."""
        self._statistics.begin_again()

    def to_bytes(self) -> bytes:
        """The whole state: what `from_bytes` makes of it goes on with the same bits."""
        head = {
            "arl0": self._arl0,
            "seed": self._seed,
            "warnings": self._warnings,
            "sensors": len(self._watched),
            "unwatched": list(self._unwatched.items()),
            "sizes": self._sizes.tolist(),
            "signature": self._signature.tolist(),
        }
        return json.dumps(head).encode() + b"\n" + self._statistics.to_bytes()

    @classmethod
    def from_bytes(cls, state: bytes) -> Self:
        """The monitor that `to_bytes` stored.

        Raises:
            InputError: other bytes.
        """
        if not isinstance(state, bytes | bytearray | memoryview):
            raise InputError(f"{type(state).__name__} is no state", "from_bytes", RETURNED)
        head, _, rest = bytes(state).partition(b"\n")
        monitor = cls.__new__(cls)
        monitor._statistics = _core.ChangeStatistics.from_bytes(rest)
        try:
            stored = json.loads(head)
            monitor._arl0, monitor._seed = float(stored["arl0"]), int(stored["seed"])
            monitor._warnings = tuple(stored["warnings"])
            monitor._unwatched = {int(one): str(why) for one, why in stored["unwatched"]}
            columns = np.arange(int(stored["sensors"]))
            monitor._watched = ~np.isin(columns, list(monitor._unwatched))
            monitor._sizes = np.array(stored["sizes"], dtype=float)
            monitor._signature = np.array(stored["signature"], dtype=float)
            sensors = monitor._statistics.recent().shape[1:]
            shapes = {monitor._sizes.shape, monitor._signature.shape, sensors}
            if shapes != {(monitor._watched.sum(),)}:
                raise ValueError
        except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
            raise InputError("the bytes are no such state", "from_bytes", RETURNED) from None
        return monitor

    def __reduce__(self) -> tuple[Any, tuple[bytes]]:
        return type(self).from_bytes, (self.to_bytes(),)

    def _take(self, rows: FloatArray) -> NDArray[np.bool_]:
        if rows.shape[1] != len(self._watched):
            what = f"the array has shape {list(rows.shape)}"
            raise InputError(what, "rows", f"its shape must be [n, {len(self._watched)}]")
        if not self._watched.all():
            within(rows, self.rows, "the stream")
            rows = np.ascontiguousarray(rows[:, self._watched])
        return self._statistics.update_many(rows)

    def _begin(self, reference: Reference, thresholds: FloatArray, arl0: float, seed: int) -> None:
        self._statistics = reference.statistics(thresholds, ROWS_KEPT)
        self._arl0, self._seed = float(arl0), int(seed)
        self._sizes, self._signature = reference.sizes, reference.signature
        self._warnings = ()


def _rounded(rows: float) -> int:
    """Down to lengths that thresholds are simulated for: a shorter baseline says less."""
    return int(np.ceil(LENGTHS ** np.floor(np.log(rows) / np.log(LENGTHS))))
