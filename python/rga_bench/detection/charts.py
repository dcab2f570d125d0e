"""What is watched: charts, whose values alarm above a limit; any detector becomes one."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray


class Detector(Protocol):
    """A detector on a stream; `copy.deepcopy` gives an independent one in the same state."""

    def update_many(self, rows: FloatArray) -> NDArray[np.bool_]:
        """Alarms bool[n] or bool[n, sensors] of rows float[n, sensors]; any sensor counts."""


class Chart(Protocol):
    """A statistic on a stream; `copy.deepcopy` gives an independent one in the same state."""

    def values(self, rows: FloatArray) -> FloatArray:
        """The statistic after each row, float[n], of rows float[n, sensors]."""


#: baseline rows float[n, sensors], or None where the noise is known to be white, normal and of
#: variance 1; and a seed
Maker = Callable[[FloatArray | None, int], Detector]
ChartMaker = Callable[[FloatArray | None, int], Chart]


@dataclass(frozen=True)
class Method:
    """What is measured.

    Attributes:
        name: in tables.
        make: a fresh chart; can be pickled.
        limit: alarms where the value exceeds it.
        fill: rows before it can alarm, which count for no run length.
    """

    name: str
    make: ChartMaker
    limit: float
    fill: int = 0


def detecting(name: str, make: Maker, fill: int = 0) -> Method:
    """A method that is a detector."""
    return Method(name, partial(_alarms, make), 0.5, fill)


def _alarms(make: Maker, baseline: FloatArray | None, seed: int) -> Chart:
    return _Alarms(make(baseline, seed))


class _Alarms:
    """A detector as a chart: 1 for an alarm, else 0."""

    def __init__(self, detector: Detector) -> None:
        self._detector = detector

    def values(self, rows: FloatArray) -> FloatArray:
        alarms = self._detector.update_many(rows)
        return np.asarray(alarms.reshape(len(rows), -1).any(axis=1), dtype=float)
