"""Levels of integration: contexts and drifts that are there, lives, the ledger and the tables."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.benchmark.ledger import NAME
from rga.benchmark.loi import rows, setting
from rga.benchmark.loi.contexts import BEYOND, MANNERS, PART, Contexts
from rga.benchmark.loi.data import LOAD_TESTS, calibration_of, stream_of
from rga.benchmark.loi.drift import DRIFTS, ONE_IN, Measured, when
from rga.benchmark.loi.examination import Examination
from rga.benchmark.loi.floors import BEST_CONTEXT, FLOORS, NOISE, TRUE_CONTEXT, floor
from rga.benchmark.loi.found import paired
from rga.benchmark.loi.levels import Learned, State, live, most_likely
from rga.benchmark.loi.lived import Played, lived
from rga.benchmark.loi.method import Calibrated, Estimate, Problem
from rga.benchmark.loi.methods.modes import maximum_posterior
from rga.benchmark.loi.novel import with_novel
from rga.benchmark.loi.play import Outcome, play
from rga.benchmark.loi.rows import ORACLE, PAPERS, Row
from rga.benchmark.loi.run import Result, measure
from rga.benchmark.loi.score import Score, score
from rga.benchmark.loi.setting import DRIFTING, Setting, Sizes, Task
from rga.benchmark.loi.sheet_asked import asked
from rga.benchmark.loi.sheets_levels import order
from rga.benchmark.loi.spread import Mean
from rga.benchmark.loi.table import about, markdown
from rga.benchmark.machine import machine, versions
from rga.errors import InputError
from rga.model.parameter import FloatArray

SIZES = Sizes(source=64, unlabelled=60, stream=160, test=40)
RANGES = np.array([[0.0, 1.0], [-30.0, 30.0], [3.0, 5.5], [10.0, 12.0]])


def task(manner: str = DRIFTING, row: str = "nearest", split: int = 0, **changes: Any) -> Task:
    return replace(Task(3, split, "all", manner, row, DRIFTS, SIZES), **changes)


@dataclass(frozen=True, eq=False)
class Nearest:
    """The contexts of the simulated row that is most like the reading, less a level learned."""

    problem: Problem
    level: FloatArray
    learned: list[int] = field(default_factory=list)

    def infer(self, readings: FloatArray) -> Estimate:
        source = self.problem.source
        far = ((readings[:, None] - self.level - source.readings) ** 2).sum(axis=2)
        value = source.contexts[far.argmin(axis=1)]
        return Estimate(value, np.full(value.shape, np.inf))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        return self.problem.simulate(contexts) + self.level

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> Calibrated:
        off = recent - self.simulate(self.infer(recent).value)
        return replace(self, level=self.level + off.mean(axis=0), learned=[len(recent)])


def nearest(problem: Problem) -> Calibrated:
    return Nearest(problem, np.zeros(len(problem.noise)))


@pytest.fixture
def few_methods(monkeypatch: pytest.MonkeyPatch) -> dict[str, Row]:
    methods = {
        "prior mean": rows.METHODS["prior mean"],
        "nearest": Row(nearest),
        "absent": Row(nearest, needs=("no_such_package",)),
    }
    for module in ("run", "play", "lived", "sheet_asked"):
        monkeypatch.setattr(f"rga.benchmark.loi.{module}.METHODS", methods)
    return methods


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
    low, high = known.problem.ranges.T
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
    assert not np.array_equal(one.problem.real, calibration_of(task(split=1)).problem.real)
    assert one.problem.real.shape == (SIZES.unlabelled, 84)


def test_load_tests_go_to_whom_they_are_meant_for() -> None:
    got: list[Problem] = []

    def method(problem: Problem) -> Calibrated:
        got.append(problem)
        return nearest(problem)

    known = calibration_of(task("same"))
    Row(method).calibrated(known)
    Row(method, load_tests=20).calibrated(known)
    assert [len(one.load_tests) for one in got] == [0, 20]
    assert len(known.problem.load_tests) == LOAD_TESTS
    twins: list[object] = []

    def oracle(problem: Problem, twin: object) -> Calibrated:
        twins.append(twin)
        return nearest(problem)

    Row(oracle, oracle=True).calibrated(known)
    assert twins == [known.usual.twin]


# Lives


def lives(
    levels: list[float], learned: Callable[[FloatArray], FloatArray], *, stores: bool
) -> tuple[Any, list[slice]]:
    """A life on a stream of parts of 100 rows, each with a mean gap of its own.

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

    def learn(state: State, recent: slice) -> State:
        begun.append(recent)
        after: Any = object()
        left = learned(state.stream)
        return State(after, ordinary, left, ordinary)

    state = State(first, ordinary, stream, ordinary)
    checked: Learned = learn
    return live(state, Sizes(), checked, stores=stores), begun


def halved(residuals: FloatArray) -> FloatArray:
    return residuals / 2.0


def test_nothing_happens_on_the_null_twin() -> None:
    life, begun = lives([1.0, 1.0, 1.0], halved, stores=False)
    assert life.alarms == []
    assert begun == []


def test_an_alarm_gathers_rows_and_recalibrates() -> None:
    life, begun = lives([1.0, 4.0], halved, stores=False)
    assert life.recalibrations == len(begun) == 1
    assert life.taken_back == 0
    (alarm,) = life.alarms
    assert 100 <= alarm < 110
    assert begun[0].stop == alarm + Sizes().settle
    assert 60 <= begun[0].start <= alarm


def test_a_state_that_is_stored_learns_from_rows_behind_the_alarm() -> None:
    life, begun = lives([1.0, 4.0], halved, stores=True)
    (alarm,) = life.alarms
    assert begun == [slice(alarm, alarm + Sizes().settle)]


def test_a_recalibration_that_does_harm_is_taken_back() -> None:
    def worse(residuals: FloatArray) -> FloatArray:
        return 1.1 * residuals

    life, begun = lives([1.0, 4.0], worse, stores=False)
    assert life.recalibrations == life.taken_back == len(begun) == 1
    assert life.state.calibrated is life.stored[0].calibrated
    # What could not be learned is usual from then on: no further alarm.
    assert len(life.alarms) == 1


def test_a_recalibration_that_forgets_is_taken_back() -> None:
    generator = np.random.default_rng(1)
    left = generator.standard_normal((50, 16))
    nobody: Any = None
    before = State(nobody, left, left, left)

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


def test_states_of_the_same_gap_are_told_apart_by_their_sensors() -> None:
    generator = np.random.default_rng(2)
    nobody: Any = None
    shape = np.where(np.arange(16) < 4, 2.0, 0.5)
    one, other = (
        State(nobody, left, left, left)
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

    life, begun = lives([1.0, 4.0, 1.0, 4.0, 1.0], same, stores=stores)
    for change in (100, 200, 300, 400):
        assert any(change <= alarm < change + 30 for alarm in life.alarms)
    assert life.recalibrations == len(begun) == len(life.alarms) - life.recalled
    assert (life.recalibrations == 1) is stores


def test_what_is_new_is_not_taken_for_what_is_stored() -> None:
    life, begun = lives([1.0, 4.0, 16.0], lambda left: left.copy(), stores=True)
    assert life.recalled == 0
    assert len(begun) == 2


def test_a_method_lives_through_drifts(few_methods: dict[str, Row]) -> None:
    known = calibration_of(task())
    method = nearest(known.problem)
    usual = Examination(known.test, known.problem.ranges, SIZES.settle)
    played = lived(task(drifts=("none", "sensor", "recurring")), known, method, usual)
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


def test_recalibration_helps_and_c_keeps_what_was_before() -> None:
    """Where the model is right but for some sensors, offsets are learned."""
    few = replace(SIZES, stream=90, test=20, unlabelled=32, harm=100.0)
    given = task(gap="noise only", drifts=("sensor",), sizes=few)
    known = calibration_of(given)
    method = Levelled(maximum_posterior(known.problem), np.zeros(84))
    usual = Examination(known.test, known.problem.ranges, few.settle)
    a, b, c = lived(given, known, method, usual)
    assert b.delays == c.delays
    assert b.delays[0] is not None
    assert b.recalibrations == c.recalibrations == 1
    assert b.drifted.rg < 0.5 * a.drifted.rg
    assert c.drifted.rg < 0.5 * a.drifted.rg
    # What the sensors show now is not what they showed: B forgets, and C does not.
    assert b.ordinary.rg > 2.0 * a.ordinary.rg
    assert c.ordinary == a.ordinary


def test_the_papers_repository_learns_from_simulations_around_what_is_novel() -> None:
    known, sources = calibration_of(task()), []

    def method(problem: Problem) -> Calibrated:
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
        state = State.of(inner, known.problem.real, stream)
        assert learned(state, slice(80, 90)).calibrated is not inner
        # Rows at one place are novel once.
        assert [len(one) for one in sources] == ([SIZES.source + added] if added else [])
        if added:
            low, high = known.problem.ranges.T
            share = (sources[0].contexts[-added:] - low) / (high - low)
            np.testing.assert_allclose(share, 1.2, atol=0.25)


# Scores


def test_scores_by_hand() -> None:
    measured = Measured(np.array([[1.0, 0.0], [3.0, 2.0]]), np.ones((2, 3)), np.zeros((2, 3)))
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


def test_floors_are_in_order() -> None:
    known = calibration_of(task("same"))
    rg = {name: floor(name, known.problem, known.test).rg for name in FLOORS}
    assert 0.0 < rg[BEST_CONTEXT] < rg[TRUE_CONTEXT]
    assert rg[NOISE] == pytest.approx(0.09, rel=0.2)
    clean = calibration_of(task("same", gap="noise only"))
    rg = {name: floor(name, clean.problem, clean.test).rg for name in FLOORS}
    # The model is right, and contexts explain as many readings as there are contexts.
    assert rg[TRUE_CONTEXT] == pytest.approx(rg[NOISE], rel=0.01)
    assert rg[BEST_CONTEXT] == pytest.approx(rg[NOISE] * (1.0 - 8.0 / 84.0), rel=0.08)


def test_each_block_is_inferred_by_the_state_after_which_it_is_likeliest() -> None:
    known = calibration_of(task("same"))
    readings = known.test.readings.copy()
    readings[20:] += 5.0
    shifted = replace(known.test, readings=readings)
    one, other = nearest(known.problem), Nearest(known.problem, np.full(84, 5.0))
    first = State.of(one, known.problem.real, known.problem.real)
    second = State.of(other, known.problem.real + 5.0, known.problem.real)
    examination = Examination(shifted, known.problem.ranges, 20)
    both, alone = examination.score_of_likeliest([first, second]), examination.score(one)
    clean = Examination(known.test, known.problem.ranges, 20).score(one)
    assert both.error == pytest.approx(clean.error)
    assert both.rg == pytest.approx(clean.rg)
    assert alone.rg > both.rg
    assert examination.score_of_likeliest([first]) == alone


def test_intervals_over_splits() -> None:
    difference = paired({0: 1.0, 1: 2.0, 2: 3.5, 7: 9.0}, {0: 0.5, 1: 1.5, 2: 3.0})
    assert difference is not None
    assert difference.value == pytest.approx(0.5)
    assert difference.reach == pytest.approx(0.0, abs=1e-12)
    assert Mean.of([2.0]).told(".1f") == "2.0"
    assert Mean(-0.25, 0.1).told("+.2f") == "-0.25 ± 0.10"
    assert paired({0: 1.0}, {1: 1.0}) is None


# Runs

LITTLE = Setting(
    seed=3,
    splits=2,
    few=1,
    gaps=("noise only", "all"),
    manners=("same", "shifted"),
    drifts=("none", "sensor"),
    rows=("noise", "true context", "prior mean", "nearest", "absent"),
    sizes=SIZES,
)


def test_a_run_that_was_killed_goes_on(few_methods: dict[str, Row], tmp_path: Path) -> None:
    whole = measure(LITTLE, folder=tmp_path / "whole")
    assert len(whole.outcomes) == (4 + 2) * 4
    lines = (tmp_path / "whole" / NAME).read_text(encoding="utf-8").splitlines()
    cut = tmp_path / "cut"
    cut.mkdir()
    (cut / NAME).write_text("\n".join([*lines[:9], lines[9][:40]]), encoding="utf-8")
    shown: list[float] = []
    again = measure(LITTLE, folder=cut, progress=shown.append)
    assert len(shown) == len(lines) - 9
    assert shown[-1] == 1.0
    assert again.outcomes == whole.outcomes
    pages = [markdown(replace(one, outcomes=_timeless(one)), "again") for one in (whole, again)]
    assert pages[0] == pages[1]
    assert "absent is left out: no_such_package not installed" in about(whole)
    other = measure(replace(LITTLE, seed=4, splits=1, drifts=()))
    assert other.outcomes[0].score != whole.outcomes[0].score


def _timeless(result: Any) -> list[Any]:
    return [replace(one, learning=None, inference=None) for one in result.outcomes]


def test_a_method_beside_others_is_told_of(few_methods: dict[str, Row]) -> None:
    found = measure(replace(LITTLE, splits=1, gaps=("all",), manners=("same",)))
    page = markdown(found, "rga benchmark loi")
    assert "| true context |" in page
    assert "| 0.405 / 297 |" in page
    assert "The paper's order cannot be told" in page
    by_row = {one.row: one.score for one in found.outcomes if one.manner == "same"}
    assert by_row["prior mean"].error == pytest.approx(1.0, abs=0.15)
    assert "†" not in page.partition("## RG")[2].partition("##")[0].replace("†:", "")


def made(errors: dict[str, tuple[float, float, float]]) -> Result:
    """A result of two splits, from the Errors of each method at the levels."""
    outcomes = []
    for split in (0, 1):
        for row, by_level in errors.items():
            found = [Score(rg=100.0 * one, error=one + 0.01 * split) for one in by_level]
            learned = {"A": 0, "B": 4, "C": 1}
            played = tuple(
                Played(drift, level, found[0], one, recalibrations=learned[level])
                for drift in ("sensor", "recurring")
                for level, one in zip(learned, found, strict=True)
            )
            for manner in ("same", DRIFTING):
                lived_through = played if manner == DRIFTING else ()
                name = f"{split}{row}{manner}"
                outcomes.append(Outcome(name, split, "all", manner, row, found[0], lived_through))
    some = Setting(gaps=("all",), drifts=("none", "sensor", "recurring"))
    return Result(machine(), versions(), some, tuple(errors), {}, outcomes)


def test_the_papers_order_is_told_where_it_is_and_where_it_is_not() -> None:
    ordered = (PAPERS["with physics"], PAPERS["residual loss"], PAPERS["without physics"])
    falling = {row: (0.3 + k, 0.2 + k, 0.1 + k) for k, row in enumerate(ordered)}
    assert "appears here in Error and RG at every level" in order(made(falling))
    rising = dict(zip(ordered, list(falling.values())[::-1], strict=True))
    assert "does not appear here as a whole: nowhere" in order(made(rising))
    mixed = dict(falling)
    mixed[ordered[0]] = (0.3, 9.0, 9.0)
    assert "only in Error at A, RG at A" in order(made(mixed))


def test_what_is_asked_is_told_of_the_best_method(monkeypatch: pytest.MonkeyPatch) -> None:
    methods = {
        "poor": Row(nearest),
        "good": Row(nearest),
        "labelled": Row(nearest, load_tests=20),
        ORACLE: Row(nearest, oracle=True),
    }
    monkeypatch.setattr("rga.benchmark.loi.sheet_asked.METHODS", methods)
    errors = {
        "poor": (0.9, 0.9, 0.9),
        "good": (0.5, 0.4, 0.2),
        "labelled": (0.3, 0.3, 0.3),
        ORACLE: (0.2, 0.2, 0.2),
    }
    told = {figure: found for figure, found, _ in asked(made(errors)).rows}
    assert told["(1 - Error) / (1 - floor): good, no load tests"].startswith("0.62")
    assert told["(1 - Error) / (1 - floor): labelled, 20 load tests"].startswith("0.87")
    assert told["Error on drifted rows, B against A: good"].startswith("-20%")
    assert told["Error on ordinary rows, B against A: good"].startswith("+0%")
    assert told["Error on recurrence, C against B: good"].startswith("-22%")
    assert told["recalibrations on recurrence, C against B: good"].startswith("-75%")
    assert not any("physics" in figure for figure in told)


def test_wrong_rows_and_drifts_are_refused(few_methods: dict[str, Row], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no row 'wizard'"):
        measure(replace(LITTLE, rows=("wizard",)))
    with pytest.raises(InputError, match="no drift 'sabotage'"):
        measure(replace(LITTLE, rows=("prior mean",), drifts=("sabotage",)))
    (tmp_path / NAME).write_text("nonsense\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 1"):
        measure(LITTLE, folder=tmp_path)


def test_tasks_have_names_of_their_own() -> None:
    tasks = Setting().tasks(("a", "b"))
    assert len({one.id for one in tasks}) == len(tasks) == 2 * (10 * 2 + Setting.few * (5 + 3))
    paper = replace(tasks[0], sizes=replace(tasks[0].sizes, repository="paper"))
    assert paper.id != tasks[0].id
    assert {one.manner for one in tasks} == {*MANNERS, DRIFTING}


def test_the_command(
    rga: Any, tmp_path: Path, few_methods: dict[str, Row], monkeypatch: pytest.MonkeyPatch
) -> None:
    little = replace(LITTLE, splits=1, gaps=("all",), manners=("same",))
    monkeypatch.setattr(
        setting, "shorter", lambda seed, rows: replace(little, seed=seed, rows=("noise", "nearest"))
    )
    folder, file = tmp_path / "out", tmp_path / "found.json"
    given = ("--quick", "--seed", "3", "--workers", "1", "-o", folder, "--json", file)
    ran = rga("benchmark", "loi", *given)
    assert ran.code == 0, ran.err
    assert "nearest" in ran.out
    names = {path.name for path in folder.iterdir()}
    assert names == {"loi.md", "methods.png", "levels.png", NAME}
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["command"] == "rga benchmark loi --quick --seed 3"
    assert {one["row"] for one in content["outcomes"]} == {"noise", "nearest"}
    monkeypatch.setattr("rga.benchmark.loi.run.play", play_nothing)
    assert rga("benchmark", "loi", *given).code == 0
    wrong = rga("benchmark", "loi", "--quick", "--repository", "attic")
    assert wrong.code == 2
    assert "give one of measured, paper" in wrong.err


def play_nothing(task: Task) -> None:
    raise AssertionError(f"{task.id} is in the ledger")


def test_a_method_that_learned_is_timed(few_methods: dict[str, Row]) -> None:
    outcome = play(task("same"))
    assert outcome.learning is not None
    assert outcome.inference is not None
    assert outcome == play(task("same"))
