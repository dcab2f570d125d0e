"""Ways to infer contexts that turn the simulator round."""

from dataclasses import replace

import numpy as np
import pytest

from context_methods import UNLABELLED
from context_problems import coverage, easy, error, lesson, measured
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.posterior_mode import posterior_mode
from rga.inference.rows import Rows
from rga.model.effects.supports.support_flexibility import SupportFlexibility
from rga_bench.contexts.methods.discrepancy import smooth_discrepancy
from rga_bench.contexts.methods.ensemble_kalman import ensemble_kalman
from rga_bench.contexts.methods.iterated_kalman import iterated_kalman
from rga_bench.contexts.methods.low_rank import low_rank_discrepancy
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.methods.unscented_kalman import unscented_kalman
from rga_bench.contexts.methods.updated_model import updated_model

LEARNING = UNLABELLED[1:]
NAMES = [method.__name__ for method in UNLABELLED]


@pytest.fixture(scope="module")
def learned():
    problem, _ = easy()
    return {method.__name__: method(problem) for method in UNLABELLED}


def with_load_tests(problem, rows):
    return replace(problem, load_tests=measured(problem, np.random.default_rng(3), rows))


def test_the_prior_mean_is_the_measure_of_errors(learned):
    problem, judged = easy()
    assert error(problem, learned["prior_mean"], judged) == pytest.approx(1.0, abs=0.15)
    assert coverage(problem, learned["prior_mean"], judged) > 0.9


@pytest.mark.parametrize("name", NAMES[1:])
def test_every_row_learns(learned, name):
    problem, judged = easy()
    few = Rows(judged.contexts[:30], judged.readings[:30])
    assert error(problem, learned[name], few) < 0.3


@pytest.mark.parametrize(
    "name", ["maximum_posterior", "smooth_discrepancy", "low_rank_discrepancy", "iterated_kalman"]
)
def test_intervals_cover_where_the_model_is_right(learned, name):
    problem, judged = easy()
    assert 0.84 < coverage(problem, learned[name], judged) < 0.96


@pytest.mark.parametrize("name", NAMES)
def test_load_tests_are_not_looked_at(name):
    problem, judged = easy()
    problem, rows = replace(problem, real=problem.real[:20]), judged.readings[:3]
    method = next(one for one in UNLABELLED if one.__name__ == name)
    before = method(problem).estimate(rows)
    again = method(with_load_tests(problem, 5)).estimate(rows)
    assert np.array_equal(before.value, again.value)
    assert np.array_equal(before.spread, again.spread)


@pytest.mark.parametrize("name", NAMES)
def test_no_row_one_row_and_missing_readings(learned, name):
    problem, judged = easy()
    one, contexts = learned[name], len(problem.ranges)
    assert one.estimate(judged.readings[:0]).value.shape == (0, contexts)
    assert one.simulate(judged.contexts[:0]).shape == (0, len(problem.noise))
    assert one.estimate(judged.readings[:1]).value.shape == (1, contexts)
    gappy = judged.readings[:4].copy()
    gappy[:, ::9] = np.nan
    gappy[1] = np.nan
    estimate = one.estimate(gappy)
    assert np.isfinite(estimate.value).all()
    assert (estimate.spread > 0).all()
    low, high = problem.ranges.T
    assert ((estimate.value >= low - 1e-9) & (estimate.value <= high + 1e-9)).all()


@pytest.mark.parametrize("name", NAMES)
def test_rows_from_one_on_are_inferred_as_among_all(learned, name):
    problem, judged = easy()
    laws, rows = list(problem.model.context.values()), judged.readings[:40]
    time, contexts = np.zeros(40), np.zeros((40, len(laws)))
    whole, part = (learned[name].infer(first, rows, contexts, time, laws) for first in (0, 30))
    for one, all_rows in zip(part, whole, strict=True):
        np.testing.assert_allclose(one, all_rows[30:], rtol=1e-6)


def test_a_missing_sensor_widens_the_intervals():
    problem, judged = easy()
    modes = maximum_posterior(problem)
    gappy = judged.readings[:20].copy()
    gappy[:, ::2] = np.nan
    whole = modes.estimate(judged.readings[:20]).spread
    assert np.median(modes.estimate(gappy).spread / whole) > 1.1


def test_filters_gain_where_contexts_drift():
    problem, judged = easy(smooth=True)
    alone = error(problem, maximum_posterior(problem), judged)
    for method in (iterated_kalman, unscented_kalman):
        follows = method(problem)
        assert np.median(follows.memory) > 0.9
        assert error(problem, follows, judged) < 0.9 * alone


def test_filters_lose_nothing_where_rows_have_no_order(learned):
    problem, judged = easy()
    alone = error(problem, learned["maximum_posterior"], judged)
    for name in ("iterated_kalman", "unscented_kalman"):
        assert (learned[name].memory == 0.0).all()
        assert error(problem, learned[name], judged) < 1.1 * alone


def wrong(problem, rows, seed):
    """Rows of a bridge whose eastern bearings give way."""
    soft = SupportFlexibility(support=["east north", "east south"], dof="uz", stiffness=2e7)
    other = TwinOnArrays(problem.simulator.extended({"soft": soft}))
    made = measured(problem, np.random.default_rng(seed), rows)
    noise = made.readings - problem.simulate(made.contexts)
    return Rows(made.contexts, other.simulate(made.contexts) + noise)


def test_what_was_measured_lately_is_learned():
    problem, _ = easy()
    rows = wrong(problem, 20, 5).readings
    before = smooth_discrepancy(replace(problem, real=rows[:8]))
    after = before.refined(lesson(1000, 1, real=rows))
    whole = smooth_discrepancy(replace(problem, real=rows))
    assert np.array_equal(after.covariance, whole.covariance)
    assert not np.array_equal(before.covariance, whole.covariance)


def test_a_model_error_is_learned_from_rows_without_contexts():
    problem, _ = easy()
    problem, judged = replace(problem, real=wrong(problem, 100, 5).readings), wrong(problem, 60, 6)
    naive, smooth = maximum_posterior(problem), smooth_discrepancy(problem)
    shapes = low_rank_discrepancy(problem)
    assert error(problem, smooth, judged) < error(problem, naive, judged)
    assert coverage(problem, smooth, judged) > coverage(problem, naive, judged) + 0.1
    assert error(problem, shapes, judged) < 0.5 * error(problem, naive, judged)
    assert coverage(problem, shapes, judged) > 0.8


def test_updating_finds_what_load_tests_show(monkeypatch):
    monkeypatch.setattr("rga_bench.contexts.methods.updated_model.MOST", 4)
    problem, _ = easy()
    problem, judged = replace(problem, load_tests=wrong(problem, 6, 5)), wrong(problem, 24, 6)
    updated = updated_model(problem)
    assert error(problem, updated, judged) < 0.5 * error(
        problem, maximum_posterior(problem), judged
    )
    assert coverage(problem, updated, judged) > 0.8


def test_updating_without_load_tests_is_map():
    problem, judged = easy()
    rows = judged.readings[:5]
    plain, updated = (
        maximum_posterior(problem).estimate(rows),
        updated_model(problem).estimate(rows),
    )
    assert np.array_equal(plain.value, updated.value)


def test_modes_of_a_linear_model_are_generalised_least_squares():
    rng = np.random.default_rng(0)
    slopes, root = rng.standard_normal((9, 3)), rng.standard_normal((9, 9))
    covariance, ranges = root @ root.T + np.eye(9), np.array([[-8.0, 4.0]] * 3)
    shown = rng.standard_normal((4, 9))
    shown[2, 5] = np.nan
    straight = np.tile(slopes, (4, 1, 1))
    found = posterior_mode(
        lambda c: c @ slopes.T,
        lambda c: straight[: len(c)],
        shown,
        covariance,
        ranges,
        np.zeros((4, 3)),
    )
    for row, measured_row in enumerate(shown):
        seen = np.isfinite(measured_row)
        weight = np.linalg.inv(covariance[np.ix_(seen, seen)])
        # Evenly spread over 12 units: variance 12, about -2.
        normal = slopes[seen].T @ weight @ slopes[seen] + np.eye(3) / 12.0
        pull = slopes[seen].T @ weight @ measured_row[seen] - 2.0 / 12.0
        assert found.value[row] == pytest.approx(np.linalg.solve(normal, pull), abs=1e-3)
        spread = np.sqrt(np.diag(np.linalg.inv(normal)))
        assert found.spread[row] == pytest.approx(spread)


def test_the_same_seed_gives_the_same_bits(learned):
    problem, judged = easy()
    for method in (ensemble_kalman, smooth_discrepancy):
        again = method(problem).estimate(judged.readings[:5])
        assert np.array_equal(
            again.value, learned[method.__name__].estimate(judged.readings[:5]).value
        )
