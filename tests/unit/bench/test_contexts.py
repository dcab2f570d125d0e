"""Levels of integration: contexts and drifts that are there, scores and floors."""

from dataclasses import replace

import numpy as np
import pytest

from context_tasks import RANGES, SIZES, nearest, task
from rga.arrays import FloatArray
from rga.errors import InputError
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.context_regime import BEYOND, PART, Contexts
from rga_bench.contexts.data import LOAD_TESTS, calibration_of, stream_of
from rga_bench.contexts.drift import DRIFTS, ONE_IN, MeasuredRows, when
from rga_bench.contexts.method import Estimate
from rga_bench.contexts.rows import Row
from rga_bench.contexts.score import score
from rga_bench.contexts.tables.aggregate import paired
from rga_bench.contexts.tables.spread import Mean

# Contexts


def shares(manner: str, count: int = 4000) -> tuple[FloatArray, Contexts]:
    contexts = Contexts.drawn(manner, RANGES, np.random.default_rng(5))
    low, high = RANGES.T
    return (contexts.draw(count, np.random.default_rng(6)) - low) / (high - low), contexts


@pytest.mark.parametrize("manner", ["same", "held out", "smooth"])
def test_contexts_are_spread_evenly(manner: str) -> None:
    share, _ = shares(manner, 20_000)
    assert share.min() >= 0.0
    assert share.max() <= 1.0
    np.testing.assert_allclose(share.mean(axis=0), 0.5, atol=0.05)
    np.testing.assert_allclose(share.var(axis=0), 1.0 / 12.0, atol=0.01)


def test_manners_and_seasons_differ_where_they_should() -> None:
    share, contexts = shares("shifted")
    ends = np.where(contexts.marked, 5.0 / 7.0, 2.0 / 7.0)
    np.testing.assert_allclose(share.mean(axis=0), ends, atol=0.02)
    share, contexts = shares("held out")
    covered = contexts.source
    assert np.array_equal(covered[~contexts.marked], RANGES[~contexts.marked])
    lacking = (share[:, contexts.marked] > 1.0 - PART).any(axis=1)
    outside = (contexts.draw(4000, np.random.default_rng(6)) > covered[:, 1]).any(axis=1)
    assert np.array_equal(lacking, outside)
    assert outside.mean() == pytest.approx(1.0 - (1.0 - PART) ** 2, abs=0.03)
    for manner, memory in (("smooth", 0.9), ("same", -0.1)):
        share, _ = shares(manner)
        following = np.corrcoef(share[1:, 0], share[:-1, 0])[0, 1]
        assert following == pytest.approx(memory, abs=0.12)
    corner = {
        manner: (found[0][:, found[1].marked] > 1.0 - PART).all(axis=1)
        for manner in ("ordinary", "elsewhere")
        for found in (shares(manner),)
    }
    assert not corner["ordinary"].any()
    assert corner["elsewhere"].all()
    share, contexts = shares("beyond")
    assert share[:, contexts.marked].min() >= 1.0
    assert share[:, contexts.marked].max() <= 1.0 + BEYOND
    assert share[:, ~contexts.marked].max() <= 1.0
    with pytest.raises(InputError, match="no manner 'sideways'"):
        shares("sideways")


# Drifts


@pytest.mark.parametrize("drift", DRIFTS)
def test_a_drift_is_there_and_the_null_twin_has_none(drift: str) -> None:
    known, stream = calibration_of(task()), stream_of(task(), drift)
    holds, measured = when(drift, SIZES.stream), stream.rows
    assert (drift == "none") == (not holds.any())
    assert stream.changes == {"none": (), "recurring": (40, 80, 120)}.get(drift, (64,))
    shown = known.usual.twin.read(measured.contexts) + measured.noise
    off = np.abs(measured.readings - shown).max(axis=1) > 1e-9
    changed = drift in ("sensor", "structural", "recurring")
    np.testing.assert_array_equal(off, holds if changed else np.zeros_like(off))
    if drift in ("sensor", "recurring"):
        hit = np.abs(measured.readings - shown)[holds].max(axis=0) > 1e-9
        assert hit.sum() == -(-len(hit) // ONE_IN)
    low, high = known.ranges.T
    share = ((measured.contexts - low) / (high - low))[:, known.usual.contexts.marked]
    moved = (share > 1.0 - PART).all(axis=1)
    expected = holds if drift in ("operational", "novel", "recurring") else np.zeros_like(holds)
    np.testing.assert_array_equal(moved, expected)
    assert (share > 1.0).any() == (drift == "novel")


def test_a_drift_that_nobody_knows_is_refused() -> None:
    with pytest.raises(InputError, match="no drift 'sabotage'"):
        stream_of(task(), "sabotage")


def test_rows_of_a_split_meet_the_same_data_and_splits_do_not() -> None:
    one, same = calibration_of(task(row="a")), calibration_of(task(row="b"))
    assert one is same
    real = one.lesson.data.real
    assert not np.array_equal(real, calibration_of(task(split=1)).lesson.data.real)
    assert real.shape == (SIZES.unlabelled, 84)


def test_load_tests_go_to_whom_they_are_meant_for() -> None:
    got: list[Lesson] = []

    def method(lesson: Lesson) -> ContextEstimator:
        got.append(lesson)
        return nearest(lesson)

    known = calibration_of(task("same"))
    Row(method).calibrated(known)
    Row(method, load_tests=20).calibrated(known)
    assert [one.load_tests and len(one.load_tests) for one in got] == [None, 20]
    assert known.lesson.load_tests is not None
    assert len(known.lesson.load_tests) == LOAD_TESTS
    twins: list[object] = []

    def oracle(lesson: Lesson, twin: object) -> ContextEstimator:
        twins.append(twin)
        return nearest(lesson)

    Row(oracle, oracle=True).calibrated(known)
    assert twins == [known.usual.twin]


# Scores


def test_scores_by_hand() -> None:
    measured = MeasuredRows(np.array([[1.0, 0.0], [3.0, 2.0]]), np.ones((2, 3)), np.zeros((2, 3)))
    estimate = Estimate(np.array([[2.0, 0.0], [3.0, 0.0]]), np.full((2, 2), 0.7))
    found = score(measured, estimate, np.full((2, 3), 3.0), np.array([[0.0, 6.0], [0.0, 12.0]]))
    # MSE 0.5 and 2 over 3 and 12.
    assert found.error == pytest.approx((0.5 / 3.0 + 2.0 / 12.0) / 2.0)
    assert found.errors == pytest.approx((np.sqrt(0.5), np.sqrt(2.0)))
    assert found.coverage == (1.0, 0.5)
    assert found.rg == 4.0
    assert score(measured, replace(estimate, spread=None), np.ones((2, 3)), RANGES[:2]) == replace(
        found, coverage=None, rg=0.0, error=pytest.approx((0.5 * 12 + 2.0 / 300.0) / 2.0)
    )


def test_intervals_over_splits() -> None:
    difference = paired({0: 1.0, 1: 2.0, 2: 3.5, 7: 9.0}, {0: 0.5, 1: 1.5, 2: 3.0})
    assert difference is not None
    assert difference.value == pytest.approx(0.5)
    assert difference.reach == pytest.approx(0.0, abs=1e-12)
    assert Mean.of([2.0]).text(".1f") == "2.0"
    assert Mean(-0.25, 0.1).text("+.2f") == "-0.25 ± 0.10"
    assert paired({0: 1.0}, {1: 1.0}) is None
