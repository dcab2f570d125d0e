"""What a row costs in the window detector: `pytest benches` (needs pytest-benchmark).

`rga benchmark detector` measures the same beside memory and other packages.
"""

from typing import Any

import numpy as np
import pytest

from rga.detection import GaussianWindow

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
