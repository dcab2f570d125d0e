"""A detector that alarms by chance, for tests of how detectors are judged."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga_bench.detection.charts import Method, detecting
from rga_bench.detection.watch import Course, StreamWorld, WatchedCase, watched

Rows = NDArray[np.float64]


class Coin:
    """Alarms with a known probability at every row, whatever the rows are."""

    def __init__(self, probability: float) -> None:
        self.probability = probability

    def update_many(self, rows: Rows) -> NDArray[np.bool_]:
        return (1e6 * rows) % 1.0 < 1.0 - (1.0 - self.probability) ** (1.0 / rows.shape[1])


def coin(probability: float) -> Method:
    return detecting("coin", lambda baseline, seed: Coin(probability))


def courses(method: Method, streams: int, cap: int, **case: Any) -> list[Course]:
    return watched(StreamWorld(3, sensors=4), WatchedCase(streams, cap, **case), method)
