"""Floors of the levels of integration: what no method can beat, in their order."""

import pytest

from context_tasks import task
from rga_bench.contexts.data import calibration_of
from rga_bench.contexts.floors import BEST_CONTEXT, FLOORS, NOISE, TRUE_CONTEXT, floor


def test_floors_are_in_order() -> None:
    known = calibration_of(task("same"))
    rg = {name: floor(name, known, known.test).rg for name in FLOORS}
    assert 0.0 < rg[BEST_CONTEXT] < rg[TRUE_CONTEXT]
    assert rg[NOISE] == pytest.approx(0.09, rel=0.2)
    clean = calibration_of(task("same", gap="noise only"))
    rg = {name: floor(name, clean, clean.test).rg for name in FLOORS}
    # The model is right, and contexts explain as many readings as there are contexts.
    assert rg[TRUE_CONTEXT] == pytest.approx(rg[NOISE], rel=0.01)
    assert rg[BEST_CONTEXT] == pytest.approx(rg[NOISE] * (1.0 - 8.0 / 84.0), rel=0.08)
