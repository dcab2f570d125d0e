"""Rows of which something is missing: what they tell, and how they are judged."""

import numpy as np
import pytest

from rga import _core
from rga.arrays import FloatArray
from rga.detection import SyncMonitor
from rga.detection.baseline.baseline_model import Reference
from rga.detection.baseline.decorrelation import correlations, inverse_root, pairwise
from rga.detection.baseline.incomplete import likeliest_covariance
from rga.detection.statistic import STATISTICS
from rga.errors import InputError

SENSORS = 5


def drawn(rows: int, seed: int, common: float = 0.7) -> tuple[FloatArray, FloatArray]:
    """Normal rows of correlated sensors, and their correlation."""
    generator = np.random.default_rng(seed)
    correlation = common + (1.0 - common) * np.eye(SENSORS)
    return generator.standard_normal((rows, SENSORS)) @ np.linalg.cholesky(
        correlation
    ).T, correlation


def lacking(rows: FloatArray, share: float, seed: int, never_whole: bool = False) -> FloatArray:
    """The same with readings missing; in each row some, if none is to be whole."""
    generator = np.random.default_rng(seed)
    gone = generator.random(rows.shape) < share
    if never_whole:
        gone[np.arange(len(rows)), generator.integers(0, rows.shape[1], len(rows))] = True
    return np.where(gone, np.nan, rows)


def test_a_correlation_is_learned_though_no_row_is_whole() -> None:
    rows, correlation = drawn(3000, 1)
    parts = lacking(rows, 0.4, 2, never_whole=True)
    assert not np.isfinite(parts).all(axis=1).any()
    found, _ = correlations(parts)
    assert np.abs(found - correlation).max() < 0.06


def test_what_is_missing_may_depend_on_what_is_there() -> None:
    """The second sensor is read where the first is low alone: pairs have a part of the range."""
    rows, correlation = drawn(4000, 3)
    rows[rows[:, 0] > 0.0, 1] = np.nan
    found = likeliest_covariance(rows, pairwise(rows)[0])
    pairs = [row[:2] for row in rows if np.isfinite(row[:2]).all()]
    assert abs(found[0, 1] - correlation[0, 1]) < 0.06
    assert abs(np.cov(np.array(pairs).T)[0, 1] - correlation[0, 1]) > 0.3
    assert np.linalg.eigvalsh(found).min() > 0.0


def test_scores_of_what_is_there_are_independent_and_of_variance_one() -> None:
    rows, correlation = drawn(20_000, 4)
    parts = lacking(rows, 0.4, 5, never_whole=True)
    plain = Reference.known(SENSORS)
    known = Reference(**{**vars(plain), "mixing": inverse_root(correlation)})
    statistics = known.statistics(np.full(len(STATISTICS), np.inf), len(parts))
    statistics.update_many(parts)
    scores = statistics.recent().astype(float)
    assert np.array_equal(np.isfinite(scores), np.isfinite(parts))
    np.testing.assert_allclose(np.nanvar(scores, axis=0), 1.0, atol=0.05)
    assert np.abs(pairwise(scores)[0] - np.eye(SENSORS)).max() < 0.05
    # As many degrees of freedom as there are readings: their sum of squares is that of the law of
    # what is there.
    three = np.isfinite(parts).sum(axis=1) == 3
    usual = np.nan_to_num(np.abs(scores)).max(axis=1) < 3.0
    row = int(np.argmax(three & usual))
    there = np.isfinite(parts[row])
    own = parts[row, there]
    marginal = own @ np.linalg.solve(correlation[np.ix_(there, there)], own)
    assert np.isclose((scores[row, there] ** 2).sum(), marginal, rtol=1e-4)


def test_innovations_have_one_variance_whatever_is_missing_before() -> None:
    generator = np.random.default_rng(6)
    steps = generator.standard_normal(40_000)
    weights = np.array([[0.5], [0.3]])
    rows = np.zeros((len(steps), 1))
    for at in range(2, len(rows)):
        rows[at] = 0.5 * rows[at - 1] + 0.3 * rows[at - 2] + steps[at]
    gone = generator.random(len(rows)) < 0.4
    left = _core.innovations(np.where(gone[:, None], np.nan, rows), weights)[:, 0]
    assert np.array_equal(np.isnan(left), gone)
    assert abs(np.nanvar(left) - 1.0) < 0.03
    behind = np.r_[False, gone[:-1]] & ~gone
    assert abs(np.var(left[behind]) - 1.0) < 0.04
    known = left[:-1][~gone[:-1] & ~gone[1:]] @ left[1:][~gone[:-1] & ~gone[1:]]
    assert abs(known) / (~gone).sum() < 0.03


@pytest.mark.parametrize("deviations", [np.zeros(3), np.zeros((3, 2))])
def test_other_shapes_of_a_memory_are_refused(deviations: FloatArray) -> None:
    with pytest.raises(InputError, match="another shape"):
        _core.innovations(deviations, np.zeros((1, 1)))


def test_a_shift_is_found_though_no_row_is_whole() -> None:
    rows = lacking(drawn(900, 7)[0], 0.4, 8, never_whole=True)
    twin = SyncMonitor(rows[:400], arl0=20_000)
    assert not twin.update_many(rows[400:]).any()
    rows[600:, 2] += 2.0
    monitor = SyncMonitor(rows[:400], arl0=20_000)
    alarms = monitor.update_many(rows[400:])
    assert not alarms[:200].any()
    assert alarms[-1]
    assert monitor.alarm is not None
    assert monitor.alarm.sensors[0] == 2
    assert abs(monitor.alarm.since - 200) < 15


def test_what_was_fitted_beforehand_makes_thresholds_higher() -> None:
    rows = drawn(700, 9)[0]
    rows[400:, 1] += 0.7
    plain, cautious = (SyncMonitor(rows[:400], arl0=2000, fitted=fitted) for fitted in (0, 6))
    assert plain.update_many(rows[400:]).sum() > cautious.update_many(rows[400:]).sum()
    with pytest.raises(InputError, match="fitted is -1"):
        SyncMonitor(rows[:400], fitted=-1)


def test_sensors_that_repeat_each_other_leave_a_covariance() -> None:
    drawn = np.random.default_rng(4).standard_normal((60, 2))
    scores = drawn[:, [0, 0, 1, 1, 1]]
    scores[::7, 0] = scores[3::5, 3] = np.nan
    found = likeliest_covariance(scores, np.eye(5))
    assert np.isfinite(np.linalg.cholesky(found)).all()
    assert found[0, 1] == pytest.approx(np.sqrt(found[0, 0] * found[1, 1]), rel=0.02)
