"""Whether sensors still say something, by what lies beside each row."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.model import Model
from rga.operation.alarms.condition import Condition, ConditionKey
from rga.operation.inbox.kept_cells import KeptCell
from rga.operation.inbox.packets import NEVER
from rga.operation.service_clock import moment_of

#: what can be wrong with a sensor, and how that is said of it, its value and its range
CAUSES: Mapping[str, str] = {
    "silent": "sends nothing",
    "stuck": "has stood still at {value}",
    "out of range": "reads {value}, which its range of {low} to {high} does not hold",
    "conflict": "is sent with two values for one moment",
}
#: rows one after the other after which a range is left or values conflict: one may be a spike
FEW_ROWS = 3
#: rows at the least after which a sensor is stuck, and how many times its longest standstill
STILL_ROWS, STILL_TIMES = 30, 10
#: how long a sensor is known before it can be stuck [µs]: a night and a day
KNOWN = 86_400_000_000


class SensorQuality:
    """Follows the sensors and measured contexts of a twin, row by row.

    A sensor is stuck where all its samples are one value for ten times as long as it ever stood
    still before: readings that are rounded stand still for a while, and those of a calm night for
    hours. Contexts stand still where nothing happens, and are not judged, but for those of which
    the model states a noise.

    Args:
        twin: name of it.
        names: of sensors, then measured contexts, in the order of the cells.
        model: of the twin.
        every: length of a row [s].
        patience: after which a sensor is silent [s].
        state: that `to_json` gave; None: nothing is known yet.

    Attributes:
        last: begin of the last row, microseconds since 1970 (UTC); NEVER: none was taken.
    """

    def __init__(
        self,
        twin: str,
        names: Sequence[str],
        model: Model,
        every: float,
        patience: float,
        state: str | None = None,
    ) -> None:
        self._twin, self._names = twin, tuple(names)
        context = model.context
        ranges = [context[one].range if one in context else (-np.inf, np.inf) for one in names]
        # As the cells are kept: a bound is no narrower than the reading that equals it.
        self._low, self._high = np.array(ranges, dtype=np.float32).reshape(-1, 2).T
        self._varies = np.array(
            [one not in context or context[one].noise is not None for one in names], dtype=np.bool_
        )
        self._silent_rows = max(1, int(np.ceil(patience / every)))
        stated = {name: one.unit for name, one in model.sensors.items()}
        stated |= {name: one.unit for name, one in context.items()}
        self._units = [stated.get(one, "").removeprefix("-") for one in names]
        n = len(self._names)
        #: rows one after the other, and begin of the first of them, by cause
        self._rows = {cause: np.zeros(n, np.int64) for cause in CAUSES}
        self._since = {cause: np.zeros(n, np.int64) for cause in CAUSES}
        self._value = np.full(n, np.nan, np.float32)
        #: the first value that a range does not hold, as long as there are such
        self._outside = np.full(n, np.nan, np.float32)
        self._longest = np.zeros(n, np.int64)
        self._first: int | None = None
        self.last = NEVER
        if state is not None:
            self._restore(json.loads(state))

    def take(self, cell: KeptCell) -> None:
        """Follow the sensors over one more row."""
        self._first = cell.begin if self._first is None else self._first
        self.last = cell.begin
        came = cell.count > 0
        still = came & (cell.least == cell.most) & (cell.least == self._value)
        ended = came & ~still
        longest = np.maximum(self._longest, self._rows["stuck"])
        self._longest = np.where(ended, longest, self._longest)
        self._value = np.where(came, cell.most, self._value)
        self._follow("silent", ~came, came, cell.begin)
        self._follow("stuck", still & self._varies, ended, cell.begin)
        below = came & (cell.least < self._low)
        outside = below | came & (cell.most > self._high)
        first = outside & (self._rows["out of range"] == 0)
        value = np.where(below, cell.least, cell.most)
        self._outside = np.where(first, value, self._outside).astype(np.float32)
        self._follow("out of range", outside, came & ~outside, cell.begin)
        conflicts = cell.conflicts > 0
        self._follow("conflict", conflicts, came & ~conflicts, cell.begin)

    def conditions(self) -> list[Condition]:
        """What is wrong with which sensor after the last row."""
        found = []
        for cause, words in CAUSES.items():
            rows = self._rows[cause]
            for k in np.flatnonzero(rows >= self._wanted(cause)):
                name = self._names[k]
                key = ConditionKey(self._twin, "quality", cause, name)
                since = moment_of(int(self._since[cause][k]))
                said = f"{name} {words.format(**self._values(cause, int(k)))}"
                found.append(Condition(key, said, since, (name,)))
        return found

    def _values(self, cause: str, k: int) -> dict[str, str]:
        """What a sensor reads and may read, in words."""
        value = self._outside[k] if cause == "out of range" else self._value[k]
        unit = self._units[k]
        return {
            "value": f"{value:.6g} {unit}".rstrip(),
            "low": f"{self._low[k]:.6g}",
            "high": f"{self._high[k]:.6g} {unit}".rstrip(),
        }

    def to_json(self) -> str:
        """What is known, as text."""
        known: dict[str, Any] = {
            "names": self._names,
            "first": self._first,
            "last": self.last,
            "rows": {cause: rows.tolist() for cause, rows in self._rows.items()},
            "since": {cause: since.tolist() for cause, since in self._since.items()},
            "value": _written(self._value),
            "outside": _written(self._outside),
            "longest": self._longest.tolist(),
        }
        return json.dumps(known)

    def _restore(self, known: Mapping[str, Any]) -> None:
        if tuple(known["names"]) != self._names or "outside" not in known:
            # Those of another station, or of an earlier rga: it is looked at them again.
            return
        self._first, self.last = known["first"], known["last"]
        self._rows = {cause: np.array(known["rows"][cause], np.int64) for cause in CAUSES}
        self._since = {cause: np.array(known["since"][cause], np.int64) for cause in CAUSES}
        self._value, self._outside = (
            np.array([np.nan if one is None else one for one in known[values]], np.float32)
            for values in ("value", "outside")
        )
        self._longest = np.array(known["longest"], np.int64)

    def _follow(
        self, cause: str, wrong: NDArray[np.bool_], well: NDArray[np.bool_], begin: int
    ) -> None:
        """Count rows that are wrong; where a row says neither, nothing changes."""
        rows = np.where(well, 0, self._rows[cause])
        self._since[cause] = np.where(wrong & (rows == 0), begin, self._since[cause])
        self._rows[cause] = np.where(wrong, rows + 1, rows)

    def _wanted(self, cause: str) -> NDArray[np.int64] | int:
        """Rows one after the other from which something is wrong."""
        if cause == "silent":
            return self._silent_rows
        if cause != "stuck":
            return FEW_ROWS
        if self._first is None or self.last - self._first < KNOWN:
            return np.iinfo(np.int64).max
        return np.maximum(max(STILL_ROWS, self._silent_rows), STILL_TIMES * self._longest)


def _written(values: NDArray[np.float32]) -> list[float | None]:
    """Values as JSON can say them."""
    return [None if np.isnan(one) else float(one) for one in values]
