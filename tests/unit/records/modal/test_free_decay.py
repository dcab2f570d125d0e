"""Modes of a free decay: those that swing are found, and of noise alone none is clear."""

from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.records.modal.free_decay import decaying_modes

STEP = 1 / 250
#: frequency [Hz], damping, phase, and shape at three sensors
SWINGING = [
    (2.60, 0.020, 0.3, (1.0, -0.8, 0.5)),
    (2.75, 0.010, 1.0, (0.1, 0.2, 1.0)),
    (5.40, 0.020, 2.0, (0.7, 1.0, 0.0)),
]


def swinging(rng: np.random.Generator, noise: float = 0.05) -> np.ndarray[Any, Any]:
    time = np.arange(2000) * STEP
    motion = noise * rng.standard_normal((len(time), 3))
    for frequency, damping, phase, shape in SWINGING:
        rate = 2 * np.pi * frequency
        course = np.exp(-damping * rate * time) * np.cos(rate * time + phase)
        motion += np.outer(course, shape)
    return motion


@pytest.mark.parametrize("seed", range(3))
def test_modes_that_lie_close_are_found_with_their_shapes(seed: int) -> None:
    motion = swinging(np.random.default_rng(seed))
    found = [one for one in decaying_modes(motion, STEP, 10.0) if not one.in_doubt]
    assert len(found) == len(SWINGING)
    for one, (frequency, damping, _, shape) in zip(found, SWINGING, strict=True):
        assert one.frequency == pytest.approx(frequency, rel=2e-3)
        assert one.damping == pytest.approx(damping, abs=2e-3)
        assert one.realness > 0.99
        np.testing.assert_allclose(one.shape, np.array(shape) / max(shape, key=abs), atol=0.05)


def test_sensors_of_other_units_change_nothing_but_the_units() -> None:
    motion = swinging(np.random.default_rng(0))
    plain = decaying_modes(motion, STEP, 10.0)
    mixed = decaying_modes(motion * [1.0, 1e-6, 1.0], STEP, 10.0)
    for one, other in zip(plain, mixed, strict=True):
        assert one.frequency == pytest.approx(other.frequency, rel=1e-9)
        expected = one.shape * [1.0, 1e-6, 1.0]
        along = float(expected @ other.shape) / float(expected @ expected)
        np.testing.assert_allclose(other.shape, along * expected, rtol=1e-6, atol=1e-12)


def test_offsets_and_a_trend_change_nothing() -> None:
    motion = swinging(np.random.default_rng(0))
    plain = decaying_modes(motion, STEP, 10.0)
    trend = np.outer(np.arange(len(motion)), [1e-3, 0.0, -1e-2])
    moved = motion + np.array([30.0, -50.0, 0.0])
    for one, other in zip(plain, decaying_modes(moved + trend, STEP, 10.0), strict=True):
        assert one.frequency == pytest.approx(other.frequency, rel=1e-6)


def test_a_decay_without_noise_is_found() -> None:
    time = np.arange(1000) * STEP
    swing = np.exp(-0.5 * time) * np.cos(2 * np.pi * 3.0 * time)
    found = decaying_modes(np.outer(swing, [1.0, 2.0]), STEP, 10.0)
    clear = [one for one in found if not one.in_doubt]
    assert min(abs(one.frequency - 3.0) for one in clear) < 0.02


@pytest.mark.parametrize("kind", ["white", "walk"])
def test_of_noise_alone_nothing_is_clear(kind: str) -> None:
    rng = np.random.default_rng(7)
    for _ in range(10):
        motion = rng.standard_normal((1500, 3))
        motion = np.cumsum(motion, axis=0) if kind == "walk" else motion
        assert all(one.in_doubt for one in decaying_modes(motion, STEP, 10.0))


@pytest.mark.parametrize(
    ("motion", "step", "words"),
    [
        (np.full((500, 1), 2.0), 0.02, "does not move"),
        (np.where(np.arange(500) == 7, np.nan, 1.0)[:, None], 0.02, "a reading is missing"),
        (np.arange(20.0)[:, None], 0.02, "lasts 0.4 s"),
        (np.zeros((100_000, 1)), 0.02, "lasts 2000 s"),
        (np.arange(500.0)[:, None], 0.2, "up to 2.5 Hz"),
    ],
)
def test_what_shows_no_decay_is_refused(
    motion: np.ndarray[Any, Any], step: float, words: str
) -> None:
    with pytest.raises(InputError, match=words):
        decaying_modes(motion, step, 10.0)


@pytest.mark.parametrize("highest", [0.0, -1.0, float("nan")])
def test_no_frequency_is_refused(highest: float) -> None:
    with pytest.raises(InputError, match="is no frequency"):
        decaying_modes(np.arange(500.0)[:, None], 0.02, highest)
