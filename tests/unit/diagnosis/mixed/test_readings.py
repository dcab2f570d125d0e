"""Modes beside a record: one clock, and contexts of the record where the modes lack them."""

from dataclasses import replace

import numpy as np
import pytest

from independent.mixed_bridge import mixed
from independent.modal_bridge import Hidden
from rga.diagnosis.mixed.readings import modes_beside
from rga.errors import InputError


def test_contexts_are_means_over_the_window() -> None:
    model, record, modal = mixed(0, Hidden())
    inside = replace(modal, time=np.full(len(modal), 1800.0), duration=np.full(len(modal), 600.0))
    readings = modes_beside(model, record, inside).readings
    within = (record.time >= 1500.0) & (record.time <= 2100.0)
    expected = record.contexts["west load"][within].mean()
    np.testing.assert_allclose(readings.contexts["west load"], expected)


def test_contexts_of_windows_beside_the_record_are_not_known() -> None:
    model, record, modal = mixed(0, Hidden())
    assert modes_beside(model, record, modal).readings.contexts == {}


def test_dates_beside_seconds_are_refused() -> None:
    model, record, modal = mixed(0, Hidden())
    with pytest.raises(InputError, match="dates stand in the modes alone"):
        modes_beside(model, record, replace(modal, start="2026-01-01T00:00:00"))
    with pytest.raises(InputError, match="dates stand in the record alone"):
        modes_beside(model, replace(record, start="2026-01-01T00:00:00"), modal)
