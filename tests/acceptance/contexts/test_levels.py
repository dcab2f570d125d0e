"""What becomes of a twin at each level of integration in the streams of the table."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from context_tasks import SIZES, nearest, task
from rga.twin.calibration.joint_posterior import JointEstimator
from rga.twin.settings import Settings
from rga_bench.contexts.data import DriftStream, calibration_of, stream_of
from rga_bench.contexts.setting import ContextsTask
from rga_bench.contexts.stream_results import StreamResult, results_of_streams
from rga_bench.contexts.twin_run import LearnedOnce, TwinStream

#: where the model is right but for some sensors, what is learned are these
FEW = replace(SIZES, stream=60)
RIGHT = task(gap="noise only", drifts=("sensor",), sizes=FEW)


@pytest.fixture
def quick_monitor(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thresholds of short streams: what is asked is what follows an alarm."""
    monkeypatch.setattr("rga_bench.contexts.twin_run.Settings", partial(Settings, arl0=2000.0))


@pytest.mark.thorough
@pytest.mark.usefixtures("quick_monitor")
def test_a_method_lives_through_drifts() -> None:
    little = task(drifts=("none", "recurring"), sizes=replace(FEW, test=40))
    played = results_of_streams(little, calibration_of(little), nearest)
    by_place = {(one.drift, one.level): one for one in played}
    assert len(by_place) == len(played) == 6
    assert all(one.recalibrations == one.alarms == 0 for one in played if one.level == "A")
    quiet = by_place["none", "B"]
    assert quiet.delays == ()
    assert quiet.watched == FEW.stream or quiet.false_alarm
    assert len(by_place["recurring", "C"].delays) == 3


def test_rows_follow_one_another() -> None:
    known, given = calibration_of(RIGHT), stream_of(RIGHT, "sensor")
    stream = TwinStream.of(known, given)
    real = known.lesson.data.real
    np.testing.assert_array_equal(stream.rows[: len(real)], real)
    for rows, part in (
        (stream.stream, given.rows),
        (stream.drifted, given.drifted),
        (stream.ordinary, known.test),
    ):
        np.testing.assert_array_equal(stream.rows[rows], part.readings)
        np.testing.assert_array_equal(stream.contexts[rows], part.contexts)
    assert np.isnan(stream.contexts[: len(real)]).all()
    assert stream.ordinary.stop == len(stream.rows)


def test_the_same_calibration_is_learned_once() -> None:
    lesson, asked = calibration_of(RIGHT).lesson, []
    once = LearnedOnce(lambda given: asked.append(given) or nearest(given))
    assert once(lesson) is once(lesson)
    assert len(asked) == 1


@pytest.mark.thorough
def test_recalibration_helps_and_c_goes_back_to_what_was_before() -> None:
    a, b, c = results_of_streams(RIGHT, calibration_of(RIGHT), JointEstimator.learn)
    assert b.delays == c.delays
    assert b.delays[0] is not None
    assert b.drifted.rg < 0.5 * a.drifted.rg
    assert c.drifted.rg < 0.5 * a.drifted.rg
    assert b.recalled == 0 < c.recalled
    assert c.recalibrations < b.recalibrations
    # Behind the drift the sensors are as they were: C knows them, and B learns them anew.
    assert c.ordinary.rg < b.ordinary.rg


@pytest.mark.usefixtures("quick_monitor")
def test_no_level_looks_at_labels(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other true contexts change Errors, and nothing that was decided."""
    monkeypatch.setattr("rga_bench.contexts.stream_results.LEVELS", ("C",))

    def unlabelled(found: list[StreamResult]) -> list[tuple[object, ...]]:
        return [
            (one.delays, one.alarms, one.recalibrations, one.recalled, one.ordinary.rg,
             one.drifted.rg)
            for one in found
        ]  # fmt: skip

    def mislabelled(given: ContextsTask, drift: str) -> DriftStream:
        stream = stream_of(given, drift)
        shuffle = partial(np.random.default_rng(1).permutation, axis=0)
        rows, drifted = (
            replace(one, contexts=shuffle(one.contexts)) for one in (stream.rows, stream.drifted)
        )
        return replace(stream, rows=rows, drifted=drifted)

    known = calibration_of(RIGHT)
    right = results_of_streams(RIGHT, known, nearest)
    monkeypatch.setattr("rga_bench.contexts.stream_results.stream_of", mislabelled)
    wrong = results_of_streams(RIGHT, known, nearest)
    assert any(one.recalibrations for one in right)
    assert unlabelled(right) == unlabelled(wrong)
    assert all(
        one.drifted.error != other.drifted.error for one, other in zip(right, wrong, strict=True)
    )
