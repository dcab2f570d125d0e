"""A long measurement is cut into windows, and into none that hold nothing."""

import numpy as np
import pytest

from rga.errors import InputError
from rga.records.modal.decay_files import Decay
from rga.records.modal.operational import windows_of

LOGGED = Decay(np.zeros((100, 2)), 0.5, ("A1", "A2"), 25.0)


def test_what_is_left_at_the_end_is_left_out() -> None:
    assert [one.duration for one in windows_of(LOGGED, 20.0)] == [20.0, 20.0]
    assert [one.middle for one in windows_of(LOGGED, 20.0)] == [10.0, 30.0]


@pytest.mark.parametrize(
    ("seconds", "told"),
    [
        (0.0, "a window of 0 s holds no two readings, one comes every 0.5 s"),
        (0.6, "give longer windows"),
        (60.0, "the file lasts 50 s"),
    ],
)
def test_windows_that_cannot_be_are_refused(seconds: float, told: str) -> None:
    with pytest.raises(InputError, match=told):
        windows_of(LOGGED, seconds)
