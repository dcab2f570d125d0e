"""Noise is estimated with the tails that it has, and what they add is drawn in."""

import numpy as np
import pytest

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance
from rga.diagnosis.noise.sensor_noise import estimate_noise

ROWS, SENSORS, MEMORY = 240, 24, 0.6


def noise_of(
    values: FloatArray, observed: BoolArray | None = None, row: FloatArray | None = None
) -> tuple[Noise, FloatArray]:
    rows, sensors = values.shape
    seen = np.ones(values.shape, dtype=bool) if observed is None else observed
    deviation = np.where(seen, values, 0.0).std(0)
    start = Noise(deviation, np.full(sensors, 0.3), np.zeros(0), deviation)
    jacobian = np.zeros((rows, sensors, 0))
    known, floor = np.zeros(0, dtype=bool), np.full(sensors, 1e-9)
    time = 600.0 * (np.arange(rows) if row is None else row)
    return estimate_noise(values, time, seen, jacobian, start, known, floor)


def with_memory(innovations: FloatArray) -> FloatArray:
    values = innovations.copy()
    for row in range(1, len(values)):
        values[row] = MEMORY * values[row - 1] + np.sqrt(1 - MEMORY**2) * innovations[row]
    return values


def heavy(seed: int, sensors: int = SENSORS) -> FloatArray:
    return np.random.default_rng(seed).standard_t(3.0, (ROWS, sensors))


@pytest.mark.parametrize("memory", [False, True])
def test_heavy_tails_are_distinguished_from_gaussian_noise(memory: bool) -> None:
    light = np.random.default_rng(0).standard_normal((ROWS, SENSORS))
    for values, heavy_tailed in ((heavy(0), True), (light, False)):
        noise, tails = noise_of(with_memory(values) if memory else values)
        assert noise.phi.mean() == pytest.approx(MEMORY if memory else 0.0, abs=0.06)
        if heavy_tailed:
            assert 2.3 < noise.freedom < 4.0
            # Student's t of scale one tells as much as Gaussian noise of variance 6 / 4.
            assert noise.sigma.mean() == pytest.approx(np.sqrt(1.5), rel=0.06)
            assert noise.deviation.mean() == pytest.approx(np.sqrt(3.0), rel=0.1)
        else:
            assert np.isinf(noise.freedom)
            assert not tails.any()
            assert (noise.sigma == noise.deviation).all()


@pytest.mark.parametrize("on_end", [3, 4, ROWS])
def test_runs_of_rows_far_apart_show_the_memory_within_them(on_end: int) -> None:
    runs = ROWS // on_end
    light = np.random.default_rng(4).standard_normal((runs, on_end, SENSORS))
    values = np.concatenate([with_memory(run) for run in light])
    row = np.add.outer(5000.0 * np.arange(runs), np.arange(on_end)).ravel()
    assert noise_of(values, row=row)[0].phi.mean() == pytest.approx(MEMORY, abs=0.04)


def test_means_of_readings_drawn_in_are_as_sure_as_they_say() -> None:
    values = heavy(1, 400)
    noise, tails = noise_of(values)
    believed = float((noise.sigma**2 * (1 + noise.phi) / (1 - noise.phi)).mean()) / ROWS
    drawn_in, whole = (values - tails).mean(0), values.mean(0)
    assert 0.75 * believed < drawn_in.var() < 1.15 * believed
    assert drawn_in.var() < 0.65 * whole.var()


def test_a_spike_is_a_tail_and_a_shift_is_none() -> None:
    values = heavy(2)
    spike, shift = values.copy(), values.copy()
    spike[100, 3] += 30.0
    shift[-10:, 3] += 8.0
    assert noise_of(spike)[1][100, 3] > 25.0
    _, tails = noise_of(shift)
    assert np.abs(tails[-10:, 3] - noise_of(values)[1][-10:, 3]).mean() < 2.0


def test_tails_of_readings_are_those_of_their_innovations() -> None:
    observed = np.ones((ROWS, 2), dtype=bool)
    observed[5, 1] = observed[9, 0] = False
    noise = Noise(np.array([0.5, 2.0]), np.array([0.0, 0.7]), np.zeros(0), np.array([0.5, 2.0]))
    rows = RowCovariance(noise, np.arange(ROWS, dtype=float), observed, np.zeros((ROWS, 2, 0)))
    innovations = np.where(observed.T, heavy(3, 2).T, 0.0)
    np.testing.assert_allclose(rows.whiten(rows.coloured(innovations)), innovations, atol=1e-12)
