"""What sums of scores vary more by than independent ones."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rga.detection.baseline.slow_noise import USUAL, long_run_variance

SENSORS = 12


def scores(rows: int, slow: float) -> np.ndarray:
    """Independent ones, and so much slow noise beside them."""
    fast, steps = np.random.default_rng(3).standard_normal((2, rows, SENSORS))
    beside = np.sqrt(1 - 0.9**2) * lfilter([1.0], [1.0, -0.9], steps, axis=0)
    return np.asarray(np.sqrt(1 - slow) * fast + np.sqrt(slow) * beside)


def test_many_rows_without_slow_noise_have_none() -> None:
    assert long_run_variance(scores(20_000, 0.0)) == pytest.approx(1.0, abs=0.05)


def test_many_rows_show_what_there_is() -> None:
    # Sums of the slow part vary (1 + 0.9) / (1 - 0.9) times as much.
    assert long_run_variance(scores(20_000, 0.05)) == pytest.approx(1.9, rel=0.25)


@pytest.mark.parametrize("rows", [30, 100])
def test_few_rows_cannot_tell_and_have_what_is_usual(rows: int) -> None:
    assert long_run_variance(scores(rows, 0.0)) > 1.0 + 0.7 * USUAL


def test_what_is_usual_counts_for_less_the_more_rows_there_are() -> None:
    found = [long_run_variance(scores(rows, 0.0)) for rows in (200, 480, 1500, 20_000)]
    assert found == sorted(found, reverse=True)
