"""The ledger, the tables and the command of the levels of integration."""

import json
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import Any

import pytest

from context_tasks import SIZES, nearest, task
from rga.errors import InputError
from rga_bench.contexts.context_regime import MANNERS
from rga_bench.contexts.experiment import ContextsExperiment
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import ORACLE, PAPERS, Row
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import DRIFTING, ContextsSetting, ContextsTask
from rga_bench.contexts.stream_results import StreamResult
from rga_bench.contexts.tables.level_tables import order
from rga_bench.contexts.tables.table import page
from rga_bench.contexts.tables.targets import targets
from rga_bench.contexts.task_run import TaskOutcome, run_task
from rga_bench.experiment import Execution
from rga_bench.ledger import NAME
from rga_bench.machine import machine, versions

LITTLE = ContextsSetting(
    seed=3,
    splits=1,
    few=1,
    gaps=("noise only", "all"),
    manners=("same", "shifted"),
    drifts=("sensor",),
    rows=("noise", "true context", "prior mean", "nearest", "absent"),
    sizes=replace(SIZES, unlabelled=32, stream=24),
)


@pytest.mark.thorough
def test_a_run_that_was_killed_goes_on(few_methods: dict[str, Row], tmp_path: Path) -> None:
    experiment = ContextsExperiment(replace(LITTLE, rows=("noise", "prior mean", "absent")))
    whole = experiment.measure(Execution(folder=tmp_path / "whole"))
    assert len(whole.outcomes) == (2 + 2) * 2
    lines = (tmp_path / "whole" / NAME).read_text(encoding="utf-8").splitlines()
    cut = tmp_path / "cut"
    cut.mkdir()
    (cut / NAME).write_text("\n".join([*lines[:5], lines[5][:40]]), encoding="utf-8")
    shown: list[float] = []
    again = experiment.measure(Execution(folder=cut, progress=shown.append))
    assert len(shown) == len(lines) - 5
    assert shown[-1] == 1.0
    assert again.outcomes == whole.outcomes
    pages = [page(replace(one, outcomes=_timeless(one)), "again") for one in (whole, again)]
    assert pages[0].text() == pages[1].text()
    assert "absent is left out: no_such_package not installed" in pages[0].about
    other = ContextsExperiment(replace(LITTLE, seed=4, drifts=())).measure(Execution())
    assert other.outcomes[0].score != whole.outcomes[0].score


def _timeless(result: Any) -> list[Any]:
    return [replace(one, learning=None, inference=None) for one in result.outcomes]


@pytest.mark.thorough
def test_a_method_beside_others_is_reported(few_methods: dict[str, Row]) -> None:
    setting = replace(LITTLE, gaps=("all",), manners=("same",))
    found = ContextsExperiment(setting).measure(Execution())
    text = page(found, "rga benchmark loi").text()
    assert "| true context |" in text
    assert "| 0.405 / 297 |" in text
    assert "The paper's order cannot be judged" in text
    by_row = {one.row: one.score for one in found.outcomes if one.manner == "same"}
    assert by_row["prior mean"].error == pytest.approx(1.0, abs=0.15)
    assert "†" not in text.partition("## RG")[2].partition("##")[0].replace("†:", "")


def made(errors: dict[str, tuple[float, float, float]]) -> ContextsResult:
    """A result of two splits, from the Errors of each method at the levels."""
    outcomes = []
    for split in (0, 1):
        for row, by_level in errors.items():
            found = [Score(rg=100.0 * one, error=one + 0.01 * split) for one in by_level]
            learned = {"A": 0, "B": 4, "C": 1}
            played = tuple(
                StreamResult(drift, level, found[0], one, recalibrations=learned[level])
                for drift in ("sensor", "recurring")
                for level, one in zip(learned, found, strict=True)
            )
            for manner in ("same", DRIFTING):
                stream_results = played if manner == DRIFTING else ()
                name = f"{split}{row}{manner}"
                outcomes.append(
                    TaskOutcome(name, split, "all", manner, row, found[0], stream_results)
                )
    some = ContextsSetting(gaps=("all",), drifts=("none", "sensor", "recurring"))
    return ContextsResult(machine(), versions(), some, tuple(errors), {}, outcomes)


def test_the_papers_order_is_reported_where_it_is_and_where_it_is_not() -> None:
    ordered = (PAPERS["with physics"], PAPERS["residual loss"], PAPERS["without physics"])
    falling = {row: (0.3 + k, 0.2 + k, 0.1 + k) for k, row in enumerate(ordered)}
    assert "appears here in Error and RG at every level" in order(made(falling))
    rising = dict(zip(ordered, list(falling.values())[::-1], strict=True))
    assert "does not appear here as a whole: nowhere" in order(made(rising))
    mixed = dict(falling)
    mixed[ordered[0]] = (0.3, 9.0, 9.0)
    assert "only in Error at A, RG at A" in order(made(mixed))


def test_targets_are_reported_of_the_best_method(monkeypatch: pytest.MonkeyPatch) -> None:
    methods = {
        "poor": Row(nearest),
        "good": Row(nearest),
        "labelled": Row(nearest, load_tests=20),
        ORACLE: Row(nearest, oracle=True),
    }
    monkeypatch.setattr("rga_bench.contexts.tables.targets.METHODS", methods)
    errors = {
        "poor": (0.9, 0.9, 0.9),
        "good": (0.5, 0.4, 0.2),
        "labelled": (0.3, 0.3, 0.3),
        ORACLE: (0.2, 0.2, 0.2),
    }
    shown = {figure: found for figure, found, _ in targets(made(errors)).rows}
    assert shown["(1 - Error) / (1 - floor): good, no load tests"].startswith("0.62")
    assert shown["(1 - Error) / (1 - floor): labelled, 20 load tests"].startswith("0.87")
    assert shown["Error on drifted rows (sensor), B against A: good"].startswith("-19.8%")
    assert shown["Error on ordinary rows (sensor), B against A: good"].startswith("+0.0%")
    assert shown["Error on recurrence, C against B: good"].startswith("-22.0%")
    assert shown["recalibrations on recurrence, C against B: good"].startswith("-75.0%")
    assert not any("physics" in figure for figure in shown)


def test_wrong_rows_and_drifts_are_refused(few_methods: dict[str, Row], tmp_path: Path) -> None:
    for wrong, message in (
        ({"rows": ("wizard",)}, "no row 'wizard'"),
        ({"rows": ("prior mean",), "drifts": ("sabotage",)}, "no drift 'sabotage'"),
    ):
        experiment = ContextsExperiment(replace(LITTLE, **wrong))
        with pytest.raises(InputError, match=message):
            experiment.measure(Execution())
    (tmp_path / NAME).write_text("nonsense\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 1"):
        ContextsExperiment(LITTLE).measure(Execution(folder=tmp_path))


def test_tasks_have_names_of_their_own() -> None:
    tasks = ContextsSetting().tasks(("a", "b"))
    assert (
        len({one.id for one in tasks}) == len(tasks) == 2 * (10 * 2 + ContextsSetting.few * (5 + 3))
    )
    longer = replace(tasks[0], sizes=replace(tasks[0].sizes, stream=201))
    assert longer.id != tasks[0].id
    assert {one.manner for one in tasks} == {*MANNERS, DRIFTING}


def test_the_command(
    rga: Any, tmp_path: Path, few_methods: dict[str, Row], monkeypatch: pytest.MonkeyPatch
) -> None:
    little = replace(LITTLE, gaps=("all",), manners=("same",))
    monkeypatch.setattr(
        "rga_bench.contexts.experiment.shorter",
        lambda seed, rows: replace(little, seed=seed, rows=("noise", "nearest")),
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
    monkeypatch.setattr("rga_bench.contexts.experiment.run_task", run_nothing)
    assert rga("benchmark", "loi", *given).code == 0


@wraps(run_task)
def run_nothing(task: ContextsTask) -> None:
    raise AssertionError(f"{task.id} is in the ledger")


def test_a_method_that_learned_is_timed(few_methods: dict[str, Row]) -> None:
    outcome = run_task(task("same"))
    assert outcome.learning is not None
    assert outcome.inference is not None
    assert outcome == run_task(task("same"))
