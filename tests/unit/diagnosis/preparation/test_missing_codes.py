"""Numbers that a logger writes where it has no reading are told, and real readings are not."""

import numpy as np
import pytest

from rga.diagnosis.preparation.missing_codes import missing_codes
from rga.records import Record

ROWS = 60
SIMULATED = np.outer(np.sin(0.3 * np.arange(ROWS)), [3.0, 50.0])
SOUND = SIMULATED + 0.1 * np.random.default_rng(2).standard_normal(SIMULATED.shape)


def told(readings: np.ndarray) -> list[str]:
    record = Record(np.arange(float(ROWS)), 0.0, "seconds", ("A", "B"), readings)
    return missing_codes(record, SIMULATED)


@pytest.mark.parametrize("code", [-9999.0, 9999.0, 1e30])
def test_a_number_that_repeats_far_away_is_told_with_its_channels_and_rows(code: float) -> None:
    readings = SOUND.copy()
    readings[10:14] = readings[30, 0] = code
    readings[50, 1] = np.nan
    (words,) = told(readings)
    assert words.startswith(f"{code:g} stands in 5 rows of A, B, far away")
    assert words.endswith("leave these cells empty")


@pytest.mark.parametrize(
    "far", [[-9999.0], [-9999.0, -9999.0], [900.0, 901.0, 902.0], [60.0, 60.0, 60.0, 60.0]]
)
def test_spikes_and_a_range_that_ends_are_none(far: list[float]) -> None:
    readings = SOUND.copy()
    readings[20 : 20 + len(far), 1] = far
    assert told(SOUND) == told(readings) == []
