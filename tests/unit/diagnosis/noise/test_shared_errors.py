"""A step of one channel is seen beside larger errors that all channels share."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.noise.sensor_noise import unexplainable

ROWS, SENSORS = 240, 6
DRAW = np.random.default_rng(3)
NOISE = DRAW.standard_normal((ROWS, SENSORS))
SHARED = 8.0 * DRAW.standard_normal((ROWS, 1)) * np.ones(SENSORS)
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
