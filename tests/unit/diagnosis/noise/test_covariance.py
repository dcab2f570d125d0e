"""Products under the covariance of a record are those of the whole matrix, written out."""

import numpy as np
import pytest

from rga.diagnosis.noise.covariance import Covariance, RandomEffects
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance

ROWS, SENSORS, CONTEXTS, EFFECTS, COURSES = 14, 4, 2, 5, 3
DRAW = np.random.default_rng(8)
NOISE = Noise(
    sigma=np.array([0.5, 1.0, 2.0, 0.8]),
    phi=np.array([0.0, 0.6, 0.9, 0.3]),
    context_sigma=np.array([0.7, 1.3]),
    deviation=np.array([0.5, 1.0, 2.0, 0.8]),
)
TIME = 600.0 * np.arange(ROWS)
JACOBIAN = DRAW.standard_normal((ROWS, SENSORS, CONTEXTS))
SCATTER = RandomEffects(
    DRAW.standard_normal((ROWS, COURSES)), DRAW.standard_normal((EFFECTS, SENSORS, COURSES))
)
SPREAD = np.array([0.1, 0.5, 1.0, 2.0, 0.3])


def written_out() -> np.ndarray:
    """The covariance as a matrix over sensors times rows: AR(1), contexts, scatter."""
    lag = np.abs(np.arange(ROWS)[:, None] - np.arange(ROWS))
    whole = np.zeros((SENSORS, ROWS, SENSORS, ROWS))
    for sensor in range(SENSORS):
        whole[sensor, :, sensor] = NOISE.sigma[sensor] ** 2 * NOISE.phi[sensor] ** lag
    for row in range(ROWS):
        jacobian = JACOBIAN[row] * NOISE.context_sigma
        whole[:, row, :, row] += jacobian @ jacobian.T
    for effect, spread in enumerate(SPREAD):
        column = SCATTER.at(np.eye(EFFECTS)[effect]).T
        whole += spread**2 * np.multiply.outer(column, column)
    return whole.reshape(SENSORS * ROWS, SENSORS * ROWS)


@pytest.fixture(scope="module")
def covariance() -> Covariance:
    observed = np.ones((ROWS, SENSORS), dtype=bool)
    return Covariance(RowCovariance(NOISE, TIME, observed, JACOBIAN), SCATTER, SPREAD)


def test_products_are_those_of_the_matrix(covariance: Covariance) -> None:
    a, b = DRAW.standard_normal((2, 3, SENSORS, ROWS))
    inverse = np.linalg.inv(written_out())
    expected = a.reshape(3, -1) @ inverse @ b.reshape(3, -1).T
    one, other = covariance.reduce(a), covariance.reduce(b)
    assert covariance.product(one, other) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    own = np.diag(a.reshape(3, -1) @ inverse @ a.reshape(3, -1).T)
    assert covariance.squares(one) == pytest.approx(own, rel=1e-9)


def test_columns_on_few_channels_are_columns_with_zeros(covariance: Covariance) -> None:
    channels = np.array([[0, 2], [3, 1], [1, 2]])
    few = DRAW.standard_normal((3, 2, ROWS))
    whole = np.zeros((3, SENSORS, ROWS))
    whole[np.arange(3)[:, None], channels] = few
    expected = covariance.squares(covariance.reduce(whole))
    assert covariance.squares(covariance.reduce(few, channels)) == pytest.approx(expected)


def test_inverse_and_estimates_are_those_of_the_matrix(covariance: Covariance) -> None:
    residual = DRAW.standard_normal((ROWS, SENSORS))
    weighted = np.linalg.solve(written_out(), residual.T.ravel())
    found = covariance.inverse_times(residual)
    assert found.ravel() == pytest.approx(weighted, rel=1e-9, abs=1e-9)
    columns = np.stack([SCATTER.at(one).T.ravel() for one in np.eye(EFFECTS)])
    expected = SPREAD**2 * (columns @ weighted)
    assert covariance.scatter_estimate(residual) == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_another_spread_is_another_matrix(covariance: Covariance) -> None:
    wider = covariance.with_spread(3 * SPREAD)
    a = DRAW.standard_normal((2, SENSORS, ROWS))
    again = Covariance(covariance.rows, SCATTER, 3 * SPREAD)
    assert wider.squares(wider.reduce(a)) == pytest.approx(again.squares(again.reduce(a)))
    assert (wider.squares(wider.reduce(a)) < covariance.squares(covariance.reduce(a))).all()


def test_a_sensor_taken_out_is_one_that_never_was_seen(covariance: Covariance) -> None:
    hidden = np.array([1, 1])
    observed = np.ones((ROWS, SENSORS), dtype=bool)
    observed[:, hidden] = False
    jacobian = np.where(observed[:, :, None], JACOBIAN, 0.0)
    rows = RowCovariance(NOISE, TIME, observed, jacobian)
    found, expected = covariance.without(hidden), Covariance(rows, SCATTER, SPREAD)
    assert found.information == pytest.approx(expected.information, rel=1e-9, abs=1e-9)
    a = DRAW.standard_normal((3, SENSORS, ROWS))
    sizes = [one.product(*2 * [one.reduce(a)]) for one in (found, expected)]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-9, abs=1e-9)
    whole = covariance.product(*2 * [covariance.reduce(a)])
    assert abs(sizes[0] - whole).max() > 1.0
    # Once more from what is left.
    assert found.without(hidden).information == pytest.approx(found.information, abs=1e-9)


def test_without_no_sensor_nothing_changes(covariance: Covariance) -> None:
    same = covariance.without(np.zeros(0, dtype=np.int64))
    assert same.information == pytest.approx(covariance.information)


def test_a_record_of_one_sensor() -> None:
    """All of its random effects are of that sensor alone."""
    alone = Noise(NOISE.sigma[:1], NOISE.phi[:1], NOISE.context_sigma, NOISE.deviation[:1])
    rows = RowCovariance(alone, TIME, np.ones((ROWS, 1), dtype=bool), JACOBIAN[:, :1])
    scatter = RandomEffects(SCATTER.courses, SCATTER.shares[:, :1])
    covariance = Covariance(rows, scatter, SPREAD)
    residual = DRAW.standard_normal((ROWS, 1))
    square = covariance.squares(covariance.reduce(residual.T[None]))[0]
    weighted = covariance.inverse_times(residual)
    assert square == pytest.approx(float(residual.T.ravel() @ weighted.ravel()))


def test_constants_are_added_to_columns(covariance: Covariance) -> None:
    a, by = DRAW.standard_normal((4, SENSORS, ROWS)), DRAW.standard_normal((4, SENSORS))
    expected = covariance.reduce(a + by[:, :, None])
    found = covariance.shifted(covariance.reduce(a), by)
    assert covariance.squares(found) == pytest.approx(covariance.squares(expected), rel=1e-9)
    assert found.score == pytest.approx(expected.score, rel=1e-9, abs=1e-9)
    channels = np.array([[0, 2], [1, 0], [2, 1], [1, 2]])
    few, few_by = a[:, :2], by[:, :2]
    expected = covariance.reduce(few + few_by[:, :, None], channels)
    found = covariance.shifted(covariance.reduce(few, channels), few_by, channels)
    assert covariance.squares(found) == pytest.approx(covariance.squares(expected), rel=1e-9)


def test_a_missing_reading_says_nothing() -> None:
    observed = np.ones((ROWS, SENSORS), dtype=bool)
    observed[5, 1] = observed[6, 1] = False
    rows = RowCovariance(NOISE, TIME, observed, JACOBIAN)
    covariance = Covariance(rows, SCATTER, SPREAD)
    a = DRAW.standard_normal((1, SENSORS, ROWS))
    other = a.copy()
    other[0, 1, 5:7] = 1e6
    sizes = [covariance.squares(covariance.reduce(columns))[0] for columns in (a, other)]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-9)
