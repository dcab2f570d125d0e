"""The gain by readings of held-out rows: interval, null twin, and what it may hang on."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rga.diagnosis.data.held_out import gain, held_out_rows
from rga.errors import InputError

ROWS, SENSORS = 300, 6
HELD_OUT = held_out_rows(ROWS)


def effect(rng: np.random.Generator) -> np.ndarray:
    """What a cause does: it follows a load with a memory, float[rows, sensors]."""
    load = lfilter([1.0], [1.0, -0.8], rng.normal(size=ROWS))
    return np.outer(load, rng.normal(size=SENSORS))


def noise(rng: np.random.Generator, memory: float) -> np.ndarray:
    """Noise of variance one, float[rows, sensors]."""
    white = rng.normal(size=(ROWS + 50, SENSORS)) * np.sqrt(1 - memory**2)
    return lfilter([1.0], [1.0, -memory], white, axis=0)[50:]


def test_every_record_that_is_long_enough_has_rows_held_out() -> None:
    for rows in range(10, 120):
        chosen = held_out_rows(rows)
        assert np.count_nonzero(np.diff(chosen, prepend=False, append=False)) >= 4
        assert 0.1 < chosen.mean() < 0.3


@pytest.mark.parametrize("memory", [0.0, 0.6])
def test_nine_intervals_in_ten_hold_the_gain_over_the_whole_record(memory: float) -> None:
    covered = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        true = effect(rng)
        # The cause was fitted a little wrong, as ever.
        simulated = true * rng.normal(1.0, 0.05)
        left = true - simulated + noise(rng, memory)
        low, high = gain(left, simulated, HELD_OUT, seed).interval
        covered.append(low <= (true**2 - (true - simulated) ** 2).mean() <= high)
    assert abs(np.mean(covered) - 0.9) < 0.06


def test_without_a_cause_there_is_no_gain() -> None:
    left = noise(np.random.default_rng(1), 0.3)
    found = gain(left, np.zeros_like(left), HELD_OUT, 0)
    assert found.interval == (0.0, 0.0)
    assert found.before == found.after == pytest.approx((left[HELD_OUT] ** 2).mean())


def test_a_change_that_is_no_cause_makes_the_gap_larger() -> None:
    readings = noise(np.random.default_rng(2), 0.3)
    simulated = np.ones_like(readings)
    low, high = gain(readings - simulated, simulated, HELD_OUT, 0).interval
    assert low < -1 < high < 0


def test_an_effect_between_the_held_out_blocks_counts_in_full() -> None:
    rng = np.random.default_rng(3)
    true = np.where(HELD_OUT[:, None], 0.0, 3.0) * np.ones(SENSORS)
    found = gain(noise(rng, 0.0), true, HELD_OUT, 0)
    assert found.before - found.after == pytest.approx((true**2).mean())


@pytest.mark.parametrize(("size", "sure"), [(0.5, False), (15.0, True)])
def test_what_no_held_out_reading_feels_is_sure_only_where_it_is_large(
    size: float, sure: bool
) -> None:
    """It begins behind the last held-out block: no reading that no step saw speaks for it."""
    left = noise(np.random.default_rng(3), 0.0)
    late = np.arange(ROWS) > np.flatnonzero(HELD_OUT)[-1]
    low, high = gain(left, size * late[:, None] * np.ones(SENSORS), HELD_OUT, 0).interval
    assert (low > 0) == sure
    assert low < size**2 * late.mean() < high


def test_no_reading_but_the_held_out_is_looked_at() -> None:
    rng = np.random.default_rng(4)
    left, simulated = noise(rng, 0.3), effect(rng)
    other = np.where(HELD_OUT[:, None], left, 2 * left)
    assert gain(left, simulated, HELD_OUT, 5) == gain(other, simulated, HELD_OUT, 5)


def test_missing_readings_have_no_part() -> None:
    rng = np.random.default_rng(5)
    left, simulated = noise(rng, 0.3), effect(rng)
    absent = np.where(rng.random(left.shape) < 0.5, np.nan, left)
    absent[:, 0] = np.nan
    found = gain(absent, simulated, HELD_OUT, 0)
    assert found.before - found.after == pytest.approx(
        (simulated[np.isfinite(absent)] ** 2).mean(), rel=0.2
    )


def test_too_few_held_out_blocks_are_reported() -> None:
    left = np.full((ROWS, SENSORS), np.nan)
    left[np.flatnonzero(HELD_OUT)[:3]] = 1.0
    with pytest.raises(InputError, match="fewer than two held-out blocks"):
        gain(left, np.zeros_like(left), HELD_OUT, 0)
