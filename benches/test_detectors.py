"""What a row costs in the detectors: `pytest benches` (needs pytest-benchmark).

`rga benchmark detector` measures the same beside memory and other packages.
"""

from typing import Any

import numpy as np
import pytest

from rga.detection import GaussianWindow, SyncMonitor

SENSORS, WINDOW = 84, 200


@pytest.mark.parametrize("missing", [0.0, 0.01])
def test_update_many(benchmark: Any, missing: float) -> None:
    draw = np.random.default_rng(1)
    rows = draw.standard_normal((20_000, SENSORS)) ** 2
    rows[draw.random(rows.shape) < missing] = np.nan
    window = GaussianWindow(SENSORS, WINDOW)
    assert benchmark(window.update_many, rows).any()


def test_update(benchmark: Any) -> None:
    row = np.random.default_rng(1).standard_normal(SENSORS) ** 2
    assert benchmark(GaussianWindow(SENSORS, WINDOW).update, row).shape == (SENSORS,)


@pytest.mark.parametrize("in_common", [0.0, 1.0])
def test_the_monitor(benchmark: Any, in_common: float) -> None:
    draw = np.random.default_rng(1)
    rows = draw.standard_normal((22_000, SENSORS))
    rows += in_common * draw.standard_normal((len(rows), 1))
    monitor = SyncMonitor(rows[:2000])
    assert benchmark(monitor.update_many, rows[2000:]).shape == (20_000,)
