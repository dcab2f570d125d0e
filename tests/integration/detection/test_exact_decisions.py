"""Decisions of the Gaussian window on hard streams, in fractions."""

import numpy as np
import pytest

from exact_window import exact_alarms, hard_streams
from rga.detection import GaussianWindow


@pytest.mark.parametrize("inclusive", [False, True])
@pytest.mark.parametrize("frozen", [False, True])
def test_decisions_are_exact(inclusive: bool, frozen: bool) -> None:
    rows = hard_streams()
    found = GaussianWindow(3, 30, 2.5, inclusive=inclusive, frozen=frozen).update_many(rows)
    expected = exact_alarms(rows, 30, 2.5, inclusive=inclusive, frozen=frozen)
    assert expected.any(axis=0).all()
    assert np.array_equal(found, expected)
