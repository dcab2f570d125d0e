"""A long measurement is cut into windows, and into none that hold nothing."""

from dataclasses import replace

import numpy as np
import pytest

from rga.errors import InputError
from rga.records.modal.decay_files import Decay
from rga.records.modal.operational import windows_of

MOTION = np.random.default_rng(0).standard_normal((100, 2))
LOGGED = Decay(MOTION, 0.5, ("A1", "A2"), 25.0)


def test_what_is_left_at_the_end_is_left_out() -> None:
    assert [one.duration for one in windows_of(LOGGED, 20.0)] == [20.0, 20.0]
    assert [one.middle for one in windows_of(LOGGED, 20.0)] == [10.0, 30.0]


@pytest.mark.parametrize(
    ("seconds", "told"),
    [
        (0.0, "a window of 0 s holds no two readings, one comes every 0.5 s"),
        (0.6, "give longer windows"),
        (60.0, "the file lasts 50 s .*: give shorter windows: --minutes 0.833 at most"),
    ],
)
def test_windows_that_cannot_be_are_refused(seconds: float, told: str) -> None:
    with pytest.raises(InputError, match=told):
        windows_of(LOGGED, seconds)


@pytest.mark.parametrize(
    ("reading", "told"),
    [
        (np.nan, "20 of 40 readings are missing"),
        (1.5, "the sensor does not move: it reads 1.5 all the time"),
    ],
)
def test_a_column_that_tells_nothing_is_named_with_its_window(reading: float, told: str) -> None:
    motion = MOTION.copy()
    motion[40 : 60 if np.isnan(reading) else 80, 1] = reading
    with pytest.raises(InputError) as refused:
        windows_of(replace(LOGGED, motion=motion), 20.0)
    assert told in str(refused.value)
    assert "(sensor 'A2', window about 30.0)" in str(refused.value)
