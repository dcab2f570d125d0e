"""What changes from a row on is no noise; what wanders, strays or follows the loads is."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.diagnosis.noise.unexplainable import unexplainable

ROWS, SENSORS = 240, 6
DRAW = np.random.default_rng(3)
NOISE = DRAW.standard_normal((ROWS, SENSORS))
SHARED = 24.0 * DRAW.standard_normal((ROWS, 1)) * np.ones(SENSORS)
STEP = 12.0 * (np.arange(ROWS) >= 150)


def left(change: FloatArray | float, *, knows_errors: bool) -> FloatArray:
    """What is left of the first channel beside the second, which has the same errors."""
    residual = NOISE + SHARED
    residual[:, 0] += change
    error = SHARED if knows_errors else 0.0
    seen = np.ones(residual.shape, dtype=bool)
    rest = unexplainable(residual, seen, np.ones((ROWS, 1)), error)
    return np.asarray(rest[:, 0] - rest[:, 1])


def test_a_step_does_not_pass_for_noise() -> None:
    noise = np.sqrt(2.0)
    assert left(STEP, knows_errors=True).std() < 1.2 * noise
    assert left(STEP, knows_errors=False).std() > 1.5 * noise


def test_without_a_step_shared_errors_make_no_difference() -> None:
    plain, beside = (left(0.0, knows_errors=knows) for knows in (False, True))
    np.testing.assert_allclose(plain, beside, atol=1e-9)


def wandering(memory: float, seed: int = 0) -> FloatArray:
    """Innovations of one with memory, float[rows, one]."""
    innovations = np.random.default_rng(seed).standard_normal(ROWS)
    values = np.zeros(ROWS)
    for row in range(1, ROWS):
        values[row] = memory * values[row - 1] + innovations[row]
    return values[:, None]


def noise_in(channel: FloatArray) -> float:
    rest = unexplainable(channel, np.ones(channel.shape, dtype=bool), np.ones((ROWS, 1)))
    return float(rest.std())


@pytest.mark.parametrize("memory", [0.0, 0.5])
def test_a_shift_below_the_size_of_a_jump_does_not_pass_for_noise(memory: float) -> None:
    noise = wandering(memory)
    shifted = noise + 3.0 * noise.std() * (np.arange(ROWS) >= 150)[:, None]
    assert noise_in(shifted) == pytest.approx(noise_in(noise), rel=0.05)


def test_the_noise_of_what_only_wanders_is_left_whole() -> None:
    for memory in (0.0, 0.9, 1.0):
        for seed in range(20):
            noise = wandering(memory, seed)
            assert noise_in(noise) > 0.99 * noise.std()


def test_a_spike_and_a_slow_wave_are_no_shift() -> None:
    row = np.arange(ROWS)
    for change in (40.0 * (row == 150), 6.0 * np.sin(2 * np.pi * row / ROWS)):
        channel = wandering(0.0) + change[:, None]
        assert noise_in(channel) > 0.99 * channel.std()
