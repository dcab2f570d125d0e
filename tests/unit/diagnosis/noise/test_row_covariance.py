"""The covariance row by row: whitening of noise with memory, and errors of contexts."""

import numpy as np
import pytest

from rga.diagnosis.noise.row_covariance import Noise, RowCovariance

ROWS = 12
TIME = 60.0 * np.arange(ROWS)
SIGMA, PHI = np.array([0.5, 2.0]), np.array([0.6, 0.0])


def rows(observed: np.ndarray, jacobian: np.ndarray | None = None, time: np.ndarray = TIME):
    if jacobian is None:
        jacobian = np.zeros((ROWS, 2, 0))
    noise = Noise(SIGMA, PHI, np.full(jacobian.shape[2], 3.0), SIGMA)
    return RowCovariance(noise, time, observed, jacobian)


ALL = np.ones((ROWS, 2), dtype=bool)


def autoregression(sensor: int, time: np.ndarray = TIME) -> np.ndarray:
    lag = np.abs(time[:, None] - time) / 60.0
    return np.asarray(SIGMA[sensor] ** 2 * PHI[sensor] ** lag)


@pytest.mark.parametrize("time", [TIME, np.where(np.arange(ROWS) > 5, TIME + 90.0, TIME)])
def test_whitening_is_the_inverse_root_of_an_autoregression(time: np.ndarray) -> None:
    covariance = rows(ALL, time=time)
    columns = np.random.default_rng(0).standard_normal((3, 2, ROWS))
    white = covariance.whiten(columns)
    for sensor in (0, 1):
        inverse = np.linalg.inv(autoregression(sensor, time))
        expected = columns[:, sensor] @ inverse @ columns[:, sensor].T
        assert white[:, sensor] @ white[:, sensor].T == pytest.approx(expected)
        back = covariance.unwhiten(white)[:, sensor]
        assert back == pytest.approx(columns[:, sensor] @ inverse)


def test_coloured_is_the_inverse_of_whiten() -> None:
    covariance = rows(ALL)
    columns = np.random.default_rng(1).standard_normal((2, ROWS))
    assert covariance.coloured(covariance.whiten(columns)) == pytest.approx(columns)


def test_a_gap_ends_the_memory() -> None:
    observed = ALL.copy()
    observed[4, 0] = False
    covariance = rows(observed)
    assert covariance.weight[0, 4] == 0
    assert covariance.weight[0, 5] == pytest.approx(1 / SIGMA[0])
    assert covariance.weight[0, 6] == pytest.approx(1 / (SIGMA[0] * np.sqrt(1 - PHI[0] ** 2)))


def test_variances_of_whitened_readings() -> None:
    covariance = rows(ALL)
    variance = np.full((2, ROWS), 4.0)
    draw = np.random.default_rng(2)
    many = covariance.whiten(2.0 * draw.standard_normal((20_000, 2, ROWS)))
    assert covariance.whitened_variance(variance) == pytest.approx(many.var(0), rel=0.05)


def test_errors_of_contexts_are_those_of_least_squares() -> None:
    """Without memory each row stands alone: a ridge regression on its derivatives."""
    draw = np.random.default_rng(3)
    jacobian, residual = draw.standard_normal((ROWS, 2, 1)), draw.standard_normal((ROWS, 2))
    noise = Noise(SIGMA, np.zeros(2), np.array([3.0]), SIGMA)
    found = RowCovariance(noise, TIME, ALL, jacobian).context_error(residual)
    slope = jacobian[:, :, 0] / SIGMA
    expected = (slope * residual / SIGMA).sum(1) / ((slope**2).sum(1) + 1 / 9)
    assert found[:, 0] == pytest.approx(expected)
