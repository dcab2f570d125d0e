"""The benchmark of the shipped twin: what is drawn, how it is judged, and the tables."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga_bench.experiment import Execution
from rga_bench.streams.experiment import StreamsExperiment
from rga_bench.streams.setting import ELSEWHERE, StreamSetting, StreamTask
from rga_bench.streams.table import page
from rga_bench.streams.twin_run import StreamOutcome, drawn, is_false, is_hidden


def task(sort: str, seed: int = 2, rows: int = 90) -> StreamTask:
    return StreamTask(sort, seed, rows, "auto")


def result(sort: str, seed: int, **more: Any) -> StreamOutcome:
    known: dict[str, Any] = {
        "sort": sort, "seed": seed, "inference": "auto", "chosen": "joint", "error": 0.01,
        "covered": 0.9, "delay": None, "named": None, "false_versions": 0,
        "verdict": "nothing_wrong", "false_causes": 0, "alarms": 0, "recalibrations": 0,
        "diagnoses": 1, "new_versions": 0, "novel": 0, "gap": 1.0, "seconds": 60.0,
    }  # fmt: skip
    return StreamOutcome(**(known | more))


def test_one_gauge_breaks_and_nothing_else_differs() -> None:
    broken, change = drawn(task("gauge"))
    null, never = drawn(task("null"))
    assert never is None
    assert change is not None
    assert 0.68 * 90 <= change + 1 <= 0.74 * 90 + 1
    for name, readings in broken.channels.items():
        moved = readings - null.channels[name]
        known = np.isfinite(moved)
        if name == broken.truth["broken"]:
            noise = broken.model["sensors"][name]["noise"]
            assert (moved[:change][known[:change]] == 0).all()
            assert (np.abs(moved[change:][known[change:]]) >= 5.0 * noise * (1 - 1e-9)).all()
        else:
            assert (moved[known] == 0).all()


def test_what_is_hidden_is_known_by_kind_and_place() -> None:
    case, change = drawn(task("structure", seed=3, rows=480))
    assert case.truth["kind"] == "support_settlement"
    assert change == 346
    right = {"kind": "support_settlement", **case.truth["place"], "displacement": -0.001}
    assert is_hidden(right, case)
    assert not is_false(right, case)
    elsewhere = right | {"support": "west south"}
    assert not is_hidden(elsewhere, case)
    assert is_false(elsewhere, case)
    # The joints of the frame are stiff in truth: to name them is no mistake, and finds nothing.
    joints = {"kind": "joint_rigidity", "group": "bottom chord"}
    assert not is_hidden(joints, case)
    assert not is_false(joints, case)


@pytest.mark.parametrize("kind", ["sensor_bias", "sensor_fault"])
def test_a_cause_of_the_broken_gauge_is_right_of_whatever_kind(kind: str) -> None:
    case, _ = drawn(task("gauge"))
    name = case.truth["broken"]
    assert is_hidden({"kind": kind, "sensor": name}, case)
    assert is_false({"kind": kind, "sensor": f"{name} not"}, case)


def test_the_tables_count_what_was_found_and_what_was_not() -> None:
    played = [
        result("structure", 1, delay=4, named=45, new_versions=1, verdict="named"),
        result("structure", 2, delay=9, named=80, new_versions=1, verdict="partial"),
        result("structure", 3, delay=30, false_versions=1, false_causes=1, verdict="partial"),
        *(result("null", seed) for seed in range(4)),
    ]
    text = page(played, "rga benchmark streams --seed 1").text()
    (structure,) = (
        line for line in text.splitlines() if line.startswith("| auto | 3 | ") and "(" in line
        and "partial 2" in line
    )  # fmt: skip
    cells = [cell.strip() for cell in structure.strip("|").split("|")]
    assert cells[2].startswith("9 (")
    assert cells[4].startswith("1 of 3")
    assert cells[5] == "1"
    assert cells[6].startswith("1 of 3")
    assert cells[8] == "named 1, partial 2"
    assert "0 of 4 (0%" in text


def played(task: StreamTask) -> StreamOutcome:
    return result(task.sort, task.seed)


def never(task: StreamTask) -> StreamOutcome:
    raise AssertionError(f"{task.id} is in the ledger")


def test_what_was_played_is_not_played_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    experiment = StreamsExperiment.of(5, quick=True)
    monkeypatch.setattr("rga_bench.streams.experiment.run_twin", played)
    first = experiment.measure(Execution(folder=tmp_path))
    monkeypatch.setattr("rga_bench.streams.experiment.run_twin", never)
    assert experiment.measure(Execution(folder=tmp_path)) == first
    assert len(first) == 4 + len(ELSEWHERE)


def test_all_streams_are_asked_for_the_default_first() -> None:
    tasks = StreamSetting(seed=5, nulls=3, streams=2, elsewhere=1).tasks()
    assert len({one.id for one in tasks}) == len(tasks) == 2 + 3 + 4 + 3 + 4
    assert [one.inference for one in tasks[:12]] == ["auto"] * 12
    assert sum(one.sort == "null" for one in tasks) == 3
    assert len(StreamsExperiment.of(5, quick=True).setting.tasks()) == 4 + len(ELSEWHERE)


@pytest.mark.parametrize("sort", ELSEWHERE)
def test_other_structures_stand_under_contexts_that_nobody_measures(sort: str) -> None:
    case, change = drawn(task(sort, rows=60))
    assert change is None
    assert set(case.channels) == set(case.model["sensors"])
    assert set(case.truth["contexts"]) == set(case.model["context"])
    assert all(len(course) == 60 for course in case.truth["contexts"].values())
    anything = {"kind": "support_settlement", "support": next(iter(case.model["supports"]))}
    assert is_false(anything, case)
