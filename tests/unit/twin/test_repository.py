"""The historical repository: what is stored comes back, as it stood."""

import json
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from rga.errors import InputError
from rga.twin.history import Event
from rga.twin.repository import Identity, Repository, Run, StoredFindings, source
from rga.twin.repository.chunks import unpack
from stored_runs import IDENTITY, noisy, version


def test_measured_rows_come_back(run: Run) -> None:
    time, readings, contexts = np.arange(3000.0) * 60, noisy(3000, 5), noisy(3000, 2, seed=1)
    for first in (0, 7):
        end = 7 if first == 0 else 3000
        with run.step() as step:
            rows = slice(first, end)
            step.measured(first, time[rows], readings[rows], contexts[rows])
    whole = run.measured()
    assert_array_equal(whole.rows, np.arange(3000))
    assert_array_equal(whole.time, time)
    assert_array_equal(whole.readings, readings)
    assert_array_equal(whole.contexts, contexts)
    part = run.measured(first=1020, end=2060)
    assert_array_equal(part.rows, np.arange(1020, 2060))
    assert_array_equal(part.readings, readings[1020:2060])
    assert len(run.measured(first=3000).rows) == 0
    assert run.row == 2999


def test_chosen_rows_come_back(run: Run) -> None:
    time, readings, contexts = np.arange(3000.0) * 60, noisy(3000, 5), noisy(3000, 2, seed=1)
    with run.step() as step:
        step.measured(0, time[:2500], readings[:2500], contexts[:2500])
    with run.step() as step:
        step.measured(2000, time[2000:], readings[2000:] + 1, contexts[2000:])
    readings[2000:] += 1
    rows = np.array([2999, 7, 8, 1023, 1024, 1999, 2000, 2499, 2500, 4000])
    chosen, known = run.measured_at(rows), np.sort(rows)[:-1]
    assert_array_equal(chosen.rows, known)
    assert_array_equal(chosen.time, time[known])
    assert_array_equal(chosen.readings, readings[known])
    assert_array_equal(chosen.contexts, contexts[known])
    assert_array_equal(run.as_of(row=2499).measured_at([2499]).readings, noisy(3000, 5)[[2499]])


def test_chosen_rows_of_many_packets(run: Run) -> None:
    readings = noisy(400, 5)
    for first in range(0, 400, 4):
        with run.step() as step:
            rows = slice(first, first + 4)
            step.measured(first, np.arange(400.0)[rows], readings[rows], np.zeros((4, 0)))
    chosen = run.measured_at(np.arange(1, 400, 3))
    assert_array_equal(chosen.readings, readings[1::3])
    assert chosen.contexts.shape == (len(chosen.rows), 0)


def test_only_chunks_with_chosen_rows_are_loaded(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    with run.step() as step:
        step.measured(0, np.arange(9000.0), noisy(9000, 5), noisy(9000, 2))
    loaded = []

    def counted(packed: bytes, count: int) -> Any:
        loaded.append(count)
        return unpack(packed, count)

    monkeypatch.setattr(source, "unpack", counted)
    assert_array_equal(run.measured_at([5, 6, 8999]).rows, [5, 6, 8999])
    assert loaded == [1024] * 3 + [808] * 3


def test_a_record_without_measured_contexts(run: Run) -> None:
    with run.step() as step:
        step.measured(4, [240.0, 300.0], noisy(2, 5), np.zeros((2, 0)))
    assert_array_equal(run.measured().rows, [4, 5])
    assert run.measured().contexts.shape == (2, 0)


def test_nothing_stored_is_read_as_nothing(run: Run) -> None:
    assert (run.steps, run.row) == (0, -1)
    assert run.measured().readings.shape == (0, 0)
    assert run.measured_at([0, 5]).readings.shape == (0, 0)
    assert len(run.simulated(within=([0, 0, 0], [1, 1, 1]))) == 0
    assert run.count_simulated() == run.count_simulated(within=([0, 0, 0], [1, 1, 1])) == 0
    assert run.version_in_force() is None
    assert run.kept("network") is None
    assert run.events() == run.messages() == run.findings() == run.versions() == ()


def test_simulations_by_version_origin_and_box(run: Run) -> None:
    contexts, readings = np.random.default_rng(0).random((2500, 3)), noisy(2500, 5)
    with run.step() as step:
        step.simulated(1, "design", 0, contexts, readings)
    with run.step() as step:
        step.simulated(1, "novel", 40, contexts[:1] + 5, readings[:1])
        falling = np.arange(20) % 2 == 1
        step.simulated(2, "requested", 50, contexts[:20], readings[:20], falling)
    everything = run.simulated()
    assert len(everything) == run.count_simulated() == 2521
    assert_array_equal(everything.contexts[:2500], contexts)
    assert_array_equal(everything.readings[:2500], readings)
    assert_array_equal(everything.falling, [False] * 2501 + [False, True] * 10)
    assert_array_equal(everything.version, [1] * 2501 + [2] * 20)
    assert_array_equal(everything.row, [0] * 2500 + [40] + [50] * 20)
    assert list(everything.origin[2499:2502]) == ["design", "novel", "requested"]

    assert run.count_simulated(version=2) == len(run.simulated(version=2)) == 20
    assert run.count_simulated(origin="novel") == len(run.simulated(origin="novel")) == 1
    box = ([0.2, 0.0, 0.5], [0.8, 1.0, 1.0])
    inside = ((contexts >= box[0]) & (contexts <= box[1])).all(axis=1)
    found = run.simulated(version=1, origin="design", within=box)
    assert_array_equal(found.readings, readings[inside])
    assert run.count_simulated(1, "design", box) == inside.sum() == len(found)


def test_a_later_entry_for_a_row_is_read_and_the_earlier_one_kept(run: Run) -> None:
    mean, spread, simulated, gaps = noisy(10, 2), noisy(10, 2), noisy(10, 5), noisy(10, 5) ** 2
    with run.step() as step:
        step.inferred(0, mean, spread, version=1)
        step.gaps(0, simulated, gaps, version=1)
    with run.step() as step:
        step.inferred(4, mean[4:] + 1, spread[4:], version=2)
        step.gaps(4, simulated[4:] + 1, gaps[4:], version=2)
    inferred, latest = run.inferred(), run.gaps()
    for entry in (inferred, latest):
        assert_array_equal(entry.rows, np.arange(10))
        assert_array_equal(entry.version, [1] * 4 + [2] * 6)
    assert_array_equal(inferred.contexts, np.concatenate([mean[:4], mean[4:] + 1]))
    assert_array_equal(inferred.spread, spread)
    assert_array_equal(latest.simulated, np.concatenate([simulated[:4], simulated[4:] + 1]))
    assert_array_equal(run.gaps(version=1).simulated, simulated)
    assert_array_equal(run.gaps(5, 8, version=1).gaps, gaps[5:8])
    assert_array_equal(run.inferred(2, 6).rows, [2, 3, 4, 5])
    assert_array_equal(run.inferred(version=2).rows, np.arange(4, 10))


def test_versions_and_which_is_in_force(run: Run) -> None:
    with run.step() as step:
        step.version(**version(1, 0))
        step.in_force(1, 0)
    with run.step() as step:
        step.version(**version(2, 30))
        step.in_force(2, 31)
    with run.step() as step:
        step.in_force(1, 45)
    first, second = run.versions()
    assert (first.number, first.gain, first.gain_ci90) == (1, None, None)
    assert (second.gain, second.gain_ci90, second.status) == (12.5, (10.0, 14.0), "accepted")
    assert second.model == json.dumps({"name": "model 2"})
    assert run.in_force() == ((0, 1), (31, 2), (45, 1))
    assert run.version_in_force() == run.version_in_force(row=30) == first
    assert run.version_in_force(row=44) == second


def test_words_come_back(run: Run) -> None:
    event = Event("alarm", 8, "2024-05-01T00:00:00", "D1 leaves", ("D1", "§2"), 3.5, None)
    body = {"held": 3, "missing": [1.5, None], "words": "größer"}
    with run.step() as step:
        step.message(kind="Q2", row=8, time=120.0, body={})
        step.message(kind="R2", row=8, body=body)
        step.findings(8, '{"verdict": "named"}')
        step.event(**vars(event))
        step.event("calibration", 9, 0.1, "done")
    with run.step() as step:
        step.message(kind="Q2", row=9, time="2024-05-01T00:01:00", body={})
    query, response, later = run.messages()
    assert (query.kind, query.row, query.time) == ("Q2", 8, 120.0)
    assert (response.body, response.time) == (body, None)
    assert later.time == "2024-05-01T00:01:00"
    assert later.written_at >= query.written_at >= run.begun_at
    assert run.messages(kind="Q2") == (query, later)
    assert run.findings() == (StoredFindings(8, '{"verdict": "named"}'),)
    assert run.events() == (event, Event("calibration", 9, 0.1, "done"))


def test_the_last_checkpoint_of_a_name_is_read(run: Run) -> None:
    for row, weights in enumerate((b"\x00\x01", b"\xff" * 3000)):
        with run.step() as step:
            step.keep("network", weights, row)
            step.keep("detector", b"window", row)
    assert run.kept("network") == b"\xff" * 3000
    assert run.kept("detector") == b"window"
    assert run.as_of(row=0).kept("network") == b"\x00\x01"


def test_a_checkpoint_is_written_over_and_falls_with_its_step(run: Run) -> None:
    assert run.state("detector") is None
    for number in range(3):
        with run.step() as step:
            step.state("detector", b"state %d" % number)
            step.state("other", b"")
    with pytest.raises(RuntimeError, match="ended"):
        step.state("detector", b"late")

    def failing() -> None:
        with run.step() as step:
            step.state("detector", b"never")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        failing()
    assert run.state("detector") == b"state 2"
    assert run.state("other") == b""


def test_a_run_as_it_stood(run: Run) -> None:
    with run.step() as step:
        step.version(**version(1, 0))
        step.in_force(1, 0)
        step.simulated(1, "design", 0, noisy(4, 2), noisy(4, 5))
    for packet in range(4):
        first = 10 * packet
        with run.step() as step:
            step.measured(first, 60.0 * np.arange(first, first + 10), noisy(10, 5), noisy(10, 1))
            step.gaps(first, noisy(10, 5), noisy(10, 5), version=1)
            step.message(kind="Q5", row=first + 9, body={})
            if packet == 2:
                step.event("version", 29, 1740.0, "version 2 is in force")
                step.version(**version(2, 29))
                step.in_force(2, 29)
                step.gaps(0, noisy(30, 5), noisy(30, 5), version=2)
                step.findings(29, "{}")
    assert run.row == 39

    then = run.as_of(row=19)
    assert (then.steps, then.row) == (3, 19)
    assert_array_equal(then.measured().rows, np.arange(20))
    assert set(then.gaps().version) == {1}
    assert then.version_in_force() == run.versions()[0]
    assert (then.versions(), then.events(), then.findings()) == (run.versions()[:1], (), ())
    assert len(then.messages()) == 2

    for view in (run.as_of(row=29), run.as_of(row=38), run.as_of(time=60.0 * 29 + 1)):
        assert_array_equal(view.measured().rows, np.arange(30))
        assert view.version_in_force() == run.versions()[1]
        assert set(view.gaps().version) == {2}
        assert len(view.findings()) == len(view.events()) == 1
    assert run.as_of(time=19 * 60.0).row == 19
    assert run.as_of(time=-1.0).steps == 0
    assert run.as_of(row=0).count_simulated() == 4
    assert len(run.as_of(row=0).measured().rows) == 0
    assert run.as_of(time=1e9).steps == run.as_of(row=39).steps == run.steps == 5
    assert run.as_of(row=19).as_of(row=39).steps == 3
    with pytest.raises(TypeError, match="either"):
        run.as_of()


def test_a_step_that_fails_leaves_nothing(run: Run) -> None:
    with run.step() as step:
        step.keep("state", b"before", 0)

    def fail() -> None:
        with run.step() as step:
            step.keep("state", b"after", 1)
            step.measured(0, [0.0], [[1.0]], [[2.0]])
            assert run.kept("state") == b"after"
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert (run.steps, run.row, run.kept("state")) == (1, 0, b"before")
    with run.step() as step:
        step.keep("state", b"again", 1)
    assert (step.number, step.row) == (2, 1)
    with pytest.raises(RuntimeError, match="ended"):
        step.keep("state", b"late", 1)


def test_arrays_that_do_not_fit_are_refused(run: Run) -> None:
    with pytest.raises(ValueError, match="differ in length"), run.step() as step:
        step.measured(0, [0.0], [[1.0], [2.0]], [[1.0]])
    with pytest.raises(ValueError, match="one or two axes"), run.step() as step:
        step.inferred(0, np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), 1)
    with pytest.raises(ValueError, match="JSON"), run.step() as step:
        step.message(kind="R1", row=0, body={"gap": float("nan")})
    assert run.steps == 0


def test_the_same_identity_resumes_and_another_begins_a_new_run(place: str) -> None:
    other = Identity("a" * 64, "b" * 64, 4, IDENTITY.settings)
    for _ in range(2):
        with Repository.open(place) as repository:
            run = repository.run(IDENTITY)
            with run.step() as step:
                step.keep("state", b"", step.number)
            run.close()
            repository.run(other)
    with Repository.open(place, read_only=True) as repository:
        resumed, begun = repository.runs()
    assert (resumed.identity, begun.identity) == (IDENTITY, other)
    assert (resumed.steps, begun.steps) == (2, 0)


def test_reading_writes_nothing_and_needs_no_lock(place: str, run: Run) -> None:
    with Repository.open(place, read_only=True) as reader:
        (view,) = reader.runs()
        with run.step() as step:
            step.keep("state", b"new", 0)
            assert view.kept("state") is None
        assert view.kept("state") == b"new"
        with pytest.raises(InputError, match="open it for writing"):
            reader.run(IDENTITY)
