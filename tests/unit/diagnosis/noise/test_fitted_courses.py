"""What a fit leaves of noise with memory, against draws of such noise."""

import numpy as np
import pytest

from rga.diagnosis.noise.fitted_courses import LARGEST_MEMORY, FittedCourses

ROWS, DRAWS = 120, 4000
SLOW = np.cos(np.outer(np.arange(ROWS), np.pi / ROWS * np.arange(9)))


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.8])
def test_shares_are_those_of_draws(memory: float) -> None:
    """With a pause in the middle, over which the noise forgets more."""
    time = 600.0 * np.arange(ROWS) + 3000.0 * (np.arange(ROWS) >= 70)
    lag = memory ** (np.diff(time) / 600.0)
    noise = np.random.default_rng(1).standard_normal((ROWS, DRAWS))
    for row, own in enumerate(lag, 1):
        noise[row] = own * noise[row - 1] + np.sqrt(1 - own**2) * noise[row]
    courses, _ = np.linalg.qr(SLOW)
    left = (noise - courses @ (courses.T @ noise)) * np.sqrt(ROWS / (ROWS - 9))
    shown = (left[1:] * left[:-1]).sum() / (left[:-1] ** 2).sum()
    found = FittedCourses.of(SLOW, time)
    assert found.memory_of_noise(np.array([shown])) == pytest.approx(memory, abs=0.01)
    share = found.share_left(np.array([memory]))
    assert share == pytest.approx((left**2).mean(), rel=0.01)


def test_without_courses_nothing_is_taken() -> None:
    found = FittedCourses.of(np.zeros((ROWS, 0)), np.arange(float(ROWS)))
    memory = np.array([0.0, 0.4, 0.9, LARGEST_MEMORY])
    np.testing.assert_allclose(found.share_left(memory), 1.0)
    np.testing.assert_allclose(found.memory_of_noise(memory), memory)


def test_more_memory_than_there_can_be_is_the_largest() -> None:
    found = FittedCourses.of(SLOW, np.arange(float(ROWS)))
    assert found.memory_of_noise(np.array([-0.5, 1.0])).tolist() == [0.0, LARGEST_MEMORY]
