"""What becomes of a twin at each level of integration, and the states that it keeps."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from context_tasks import SIZES, Nearest, nearest, task
from rga.arrays import FloatArray
from rga_bench.contexts.data import DriftStream, calibration_of, stream_of
from rga_bench.contexts.evaluation import Evaluation
from rga_bench.contexts.levels import CalibratedMethod, Learned, most_likely, run_stream
from rga_bench.contexts.method import Calibrated, Estimate, LearningProblem
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.novel import with_novel
from rga_bench.contexts.rows import Row
from rga_bench.contexts.setting import ContextsTask, Sizes
from rga_bench.contexts.stream_results import StreamResult, results_of_streams


def run_of(
    levels: list[float], learned: Callable[[FloatArray], FloatArray], *, stores: bool
) -> tuple[Any, list[slice]]:
    """A run through a stream of parts of 100 rows, each with a mean gap of its own.

    Args:
        levels: mean gaps of the parts.
        learned: residuals of all rows after learning, from those before.
        stores: whether stored states are taken up.
    """
    generator = np.random.default_rng(1)
    stream = generator.standard_normal((100 * len(levels), 16))
    stream *= np.sqrt(np.repeat(levels, 100))[:, None]
    ordinary = generator.standard_normal((200, 16))
    first: Any = object()
    begun: list[slice] = []

    def learn(state: CalibratedMethod, recent: slice) -> CalibratedMethod:
        begun.append(recent)
        after: Any = object()
        left = learned(state.stream)
        return CalibratedMethod(after, ordinary, left, ordinary)

    state = CalibratedMethod(first, ordinary, stream, ordinary)
    checked: Learned = learn
    return run_stream(state, Sizes(), checked, stores=stores), begun


def halved(residuals: FloatArray) -> FloatArray:
    return residuals / 2.0


def test_nothing_happens_on_the_null_twin() -> None:
    run, begun = run_of([1.0, 1.0, 1.0], halved, stores=False)
    assert run.alarms == []
    assert begun == []


def test_an_alarm_gathers_rows_and_recalibrates() -> None:
    run, begun = run_of([1.0, 4.0], halved, stores=False)
    assert run.recalibrations == len(begun) == 1
    assert run.taken_back == 0
    (alarm,) = run.alarms
    assert 100 <= alarm < 110
    assert begun[0].stop == alarm + Sizes().settle
    assert 60 <= begun[0].start <= alarm


def test_a_state_that_is_stored_learns_from_rows_behind_the_alarm() -> None:
    run, begun = run_of([1.0, 4.0], halved, stores=True)
    (alarm,) = run.alarms
    assert begun == [slice(alarm, alarm + Sizes().settle)]


def test_a_recalibration_that_does_harm_is_taken_back() -> None:
    def worse(residuals: FloatArray) -> FloatArray:
        return 1.1 * residuals

    run, begun = run_of([1.0, 4.0], worse, stores=False)
    assert run.recalibrations == run.taken_back == len(begun) == 1
    assert run.state.calibrated is run.stored[0].calibrated
    # What could not be learned is usual from then on: no further alarm.
    assert len(run.alarms) == 1


def test_a_recalibration_that_forgets_is_taken_back() -> None:
    generator = np.random.default_rng(1)
    left = generator.standard_normal((50, 16))
    nobody: Any = None
    before = CalibratedMethod(nobody, left, left, left)

    def harms(alone: bool = False, **changed: FloatArray) -> bool:
        return replace(before, **changed).harms(before, slice(20, 50), Sizes(), alone=alone)

    assert not harms(stream=left / 2)
    assert harms(stream=left / 2, ordinary=1.1 * left)
    assert harms(stream=1.1 * left)
    # A state that is stored beside others may forget what these know.
    assert not harms(stream=left / 2, ordinary=1.1 * left, alone=True)
    assert harms(stream=1.1 * left, alone=True)
    # One sensor that is left a larger gap does no harm where it makes that of others smaller.
    assert not harms(stream=left * np.where(np.arange(16) == 0, 4.0, 0.8))


def test_states_of_the_same_gap_are_distinguished_by_their_sensors() -> None:
    generator = np.random.default_rng(2)
    nobody: Any = None
    shape = np.where(np.arange(16) < 4, 2.0, 0.5)
    one, other = (
        CalibratedMethod(nobody, left, left, left)
        for left in (generator.standard_normal((40, 16)) * way for way in (shape, shape[::-1]))
    )
    for number, way in enumerate((shape, shape[::-1])):
        rows = generator.standard_normal((10, 16)) * way
        assert most_likely([one, other], [rows, rows]) == number


@pytest.mark.parametrize("stores", [False, True])
def test_what_recurs_is_taken_up_where_it_is_stored(stores: bool) -> None:
    """Gaps of 4 come, go, come and go again; what is learned changes no gap."""

    def same(residuals: FloatArray) -> FloatArray:
        return residuals.copy()

    run, begun = run_of([1.0, 4.0, 1.0, 4.0, 1.0], same, stores=stores)
    for change in (100, 200, 300, 400):
        assert any(change <= alarm < change + 30 for alarm in run.alarms)
    assert run.recalibrations == len(begun) == len(run.alarms) - run.recalled
    assert (run.recalibrations == 1) is stores


def test_what_is_new_is_not_taken_for_what_is_stored() -> None:
    run, begun = run_of([1.0, 4.0, 16.0], lambda left: left.copy(), stores=True)
    assert run.recalled == 0
    assert len(begun) == 2


def test_a_method_lives_through_drifts(few_methods: dict[str, Row]) -> None:
    known = calibration_of(task())
    method = nearest(known.problem)
    usual = Evaluation(known.test, known.problem.ranges, SIZES.settle)
    played = results_of_streams(task(drifts=("none", "sensor", "recurring")), known, method, usual)
    by_place = {(one.drift, one.level): one for one in played}
    assert len(by_place) == len(played) == 9
    assert all(one.recalibrations == 0 for one in played if one.level == "A")
    quiet = by_place["none", "B"]
    assert quiet.delays == ()
    assert quiet.watched == SIZES.stream or quiet.false_alarm
    assert len(by_place["recurring", "C"].delays) == 3


@dataclass(frozen=True, eq=False)
class Levelled:
    """A method that takes off the mean gap that it found."""

    inner: Calibrated
    level: FloatArray

    def infer(self, readings: FloatArray) -> Estimate:
        return self.inner.infer(readings - self.level)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        return self.inner.simulate(contexts) + self.level

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> Calibrated:
        off = recent - self.simulate(self.infer(recent).value)
        return replace(self, level=self.level + off.mean(axis=0))


@dataclass(frozen=True, eq=False)
class Remembering:
    """A method that infers the same readings once."""

    inner: Calibrated
    seen: dict[bytes, Estimate] = field(default_factory=dict)

    def infer(self, readings: FloatArray) -> Estimate:
        key = readings.tobytes()
        if key not in self.seen:
            self.seen[key] = self.inner.infer(readings)
        return self.seen[key]

    def simulate(self, contexts: FloatArray) -> FloatArray:
        return self.inner.simulate(contexts)

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> Calibrated:
        return self.inner.recalibrated(recent, alone=alone)


#: where the model is right but for some sensors, offsets are learned
FEW = replace(SIZES, stream=90, test=20, unlabelled=32, harm=100.0)
RIGHT = task(gap="noise only", drifts=("sensor",), sizes=FEW)


@cache
def modes() -> Remembering:
    return Remembering(maximum_posterior(calibration_of(RIGHT).problem))


def levels() -> list[StreamResult]:
    """Results at every level, where offsets are learned."""
    known = calibration_of(RIGHT)
    method = Levelled(modes(), np.zeros(84))
    usual = Evaluation(known.test, known.problem.ranges, FEW.settle)
    return results_of_streams(RIGHT, known, method, usual)


@pytest.fixture(scope="module")
def right() -> list[StreamResult]:
    return levels()


def test_recalibration_helps_and_c_keeps_what_was_before(right: list[StreamResult]) -> None:
    a, b, c = right
    assert b.delays == c.delays
    assert b.delays[0] is not None
    assert b.recalibrations == c.recalibrations == 1
    assert b.drifted.rg < 0.5 * a.drifted.rg
    assert c.drifted.rg < 0.5 * a.drifted.rg
    # What the sensors show now is not what they showed: B forgets, and C does not.
    assert b.ordinary.rg > 2.0 * a.ordinary.rg
    assert c.ordinary == a.ordinary


def test_no_level_looks_at_labels(
    right: list[StreamResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other true contexts change Errors, and nothing that was decided."""

    def unlabelled(found: list[StreamResult]) -> list[tuple[object, ...]]:
        return [
            (one.delays, one.alarms, one.recalibrations, one.taken_back, one.recalled,
             one.ordinary.rg, one.drifted.rg)
            for one in found
        ]  # fmt: skip

    def mislabelled(given: ContextsTask, drift: str) -> DriftStream:
        stream = stream_of(given, drift)
        wrong = [
            replace(one, contexts=np.random.default_rng(1).permutation(one.contexts, axis=0))
            for one in (stream.rows, stream.drifted)
        ]
        return replace(stream, rows=wrong[0], drifted=wrong[1])

    monkeypatch.setattr("rga_bench.contexts.stream_results.stream_of", mislabelled)
    wrong = levels()
    assert any(one.recalibrations for one in right)
    assert unlabelled(right) == unlabelled(wrong)
    assert all(
        one.drifted.error != other.drifted.error for one, other in zip(right, wrong, strict=True)
    )


def test_the_papers_repository_learns_from_simulations_around_what_is_novel() -> None:
    known, sources = calibration_of(task()), []

    def method(problem: LearningProblem) -> Calibrated:
        sources.append(problem.source)
        return nearest(problem)

    @dataclass(frozen=True, eq=False)
    class Beyond(Nearest):
        """Infers a place that no simulation is near to."""

        def infer(self, readings: FloatArray) -> Estimate:
            low, high = self.problem.ranges.T
            return Estimate(np.tile(low + 1.2 * (high - low), (len(readings), 1)), None)

    stream, level = stream_of(task(), "none").rows.readings, np.zeros(84)
    for inner, added in ((Beyond(known.problem, level), 8), (nearest(known.problem), 0)):
        sources.clear()
        learned = with_novel(Row(method), known, stream)
        state = CalibratedMethod.of(inner, known.problem.real, stream)
        assert learned(state, slice(80, 90)).calibrated is not inner
        # Rows at one place are novel once.
        assert [len(one) for one in sources] == ([SIZES.source + added] if added else [])
        if added:
            low, high = known.problem.ranges.T
            share = (sources[0].contexts[-added:] - low) / (high - low)
            np.testing.assert_allclose(share, 1.2, atol=0.25)


def test_each_block_is_inferred_by_the_state_after_which_it_is_likeliest() -> None:
    known = calibration_of(task("same"))
    readings = known.test.readings.copy()
    readings[20:] += 5.0
    shifted = replace(known.test, readings=readings)
    one, other = nearest(known.problem), Nearest(known.problem, np.full(84, 5.0))
    first = CalibratedMethod.of(one, known.problem.real, known.problem.real)
    second = CalibratedMethod.of(other, known.problem.real + 5.0, known.problem.real)
    evaluation = Evaluation(shifted, known.problem.ranges, 20)
    both, alone = evaluation.score_of_likeliest([first, second]), evaluation.score(one)
    clean = Evaluation(known.test, known.problem.ranges, 20).score(one)
    assert both.error == pytest.approx(clean.error)
    assert both.rg == pytest.approx(clean.rg)
    assert alone.rg > both.rg
    assert evaluation.score_of_likeliest([first]) == alone
