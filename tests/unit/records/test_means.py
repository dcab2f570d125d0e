"""Means about rows: exact for a signal that grows evenly, and missing rather than biased."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.records.means import means_about

HOURS = np.arange(0, 24 * 3600, 3600.0)


def every(step: float, until: float = 23 * 3600.0) -> FloatArray:
    return np.arange(0.0, until + step / 2, step)


@pytest.mark.parametrize("step", [1.0, 60.0, 600.0, 700.0, 3600.0])
def test_a_signal_that_grows_evenly_keeps_its_value(step: float) -> None:
    times = every(step)
    means, _ = means_about(times, times / 3600, HOURS, 3600.0)
    np.testing.assert_allclose(means[1:-1], HOURS[1:-1] / 3600, rtol=1e-10)


def test_so_it_does_at_uneven_times_and_with_readings_missing() -> None:
    random = np.random.default_rng(1)
    times = np.sort(random.uniform(0, 23 * 3600, 400))
    values = 5 - 2 * times / 3600
    values[random.choice(400, 60, replace=False)] = np.nan
    means, _ = means_about(times, values, HOURS, 3600.0)
    there = np.isfinite(means)
    assert there.sum() >= 21
    np.testing.assert_allclose(means[there], (5 - 2 * HOURS / 3600)[there], atol=1e-9)


def test_a_signal_that_stands_still_keeps_its_value() -> None:
    times = every(600.0)
    means, counts = means_about(times, np.full(len(times), 1e6 + 0.1), HOURS, 3600.0)
    np.testing.assert_allclose(means[1:-1], 1e6 + 0.1, rtol=1e-15)
    assert set(counts[1:-1].tolist()) == {7}


def test_noise_shrinks_with_the_number_of_readings() -> None:
    times = every(60.0, 400 * 3600.0)
    rows = np.arange(3600.0, 400 * 3600.0, 3600.0)
    noise = np.random.default_rng(0).normal(size=len(times))
    means, counts = means_about(times, noise, rows, 3600.0)
    assert set(counts.tolist()) == {61}
    assert np.std(means) == pytest.approx(1 / np.sqrt(60), rel=0.1)


def test_a_mean_is_missing_where_half_of_its_window_is_empty() -> None:
    times = every(600.0)
    outage = (times > 9.6 * 3600) & (times < 12.9 * 3600)
    values = np.where(outage, np.nan, times / 3600)
    means, counts = means_about(times, values, HOURS, 3600.0)
    assert np.flatnonzero(np.isnan(means)).tolist() == [0, 10, 11, 12, 13, 23]
    np.testing.assert_allclose(means[[9, 14]], [9, 14], rtol=1e-12)
    assert (counts == 0).tolist() == np.isnan(means).tolist()


def test_a_window_that_reaches_a_little_beyond_the_file_is_narrowed_on_both_sides() -> None:
    times = every(1.0, 3599.0)
    means, counts = means_about(times, times, np.array([1800.0]), 3600.0)
    np.testing.assert_allclose(means, [1800.0], rtol=1e-12)
    assert counts.tolist() == [3599]


def test_one_reading_is_no_mean() -> None:
    means, counts = means_about(np.array([0.0]), np.array([1.0]), np.array([0.0]), 60.0)
    assert np.isnan(means).all()
    assert counts.tolist() == [0]
