"""Memory of noise is found where values are missing, and steps are none of it."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.numerics.noise_with_memory import noise_with_memory

ROWS, SERIES = 60, 6


def noise(seed: int, memory: float, missing: float) -> FloatArray:
    """Of variance one, some of it not measured."""
    draw = np.random.default_rng(seed)
    own = draw.normal(size=(ROWS, SERIES))
    for row in range(1, ROWS):
        own[row] = memory * own[row - 1] + np.sqrt(1.0 - memory**2) * own[row]
    own[draw.random(own.shape) < missing] = np.nan
    return own


@pytest.mark.parametrize("missing", [0.0, 0.4])
@pytest.mark.parametrize("memory", [0.0, 0.3, 0.6])
def test_memory_is_that_of_the_noise_however_much_is_missing(memory: float, missing: float) -> None:
    found = [noise_with_memory(noise(seed, memory, missing)) for seed in range(40)]
    assert np.mean([one for _, one in found]) == pytest.approx(memory, abs=0.08)
    assert np.mean([spreads for spreads, _ in found]) == pytest.approx(1.0, abs=0.12)


def test_a_step_is_hardly_any_noise() -> None:
    several = [noise(seed, 0.0, 0.1) for seed in range(20)]
    for one in several:
        one[ROWS // 2 :] += 10.0
    spreads = [noise_with_memory(one)[0] for one in several]
    assert np.mean(spreads) == pytest.approx(1.0, abs=0.35)


def test_too_few_values_tell_nothing() -> None:
    spreads, memory = noise_with_memory(np.ones((3, 2)))
    assert np.isnan(spreads).all()
    assert memory == 0.0
