"""`rga export` and `rga status`: rows come out as they went in, and where a run stands."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import Model, Twin, load_model, load_record
from rga.jobs.begin import begun
from rga.records import Record
from rga.twin import Settings
from rga.twin.runner import taken_up
from rga_bench.synthetic import draw_case

Case = tuple[Model, Record]


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    folder = tmp_path_factory.mktemp("case")
    draw_case(1028, rows=160).write(folder)
    model = load_model(folder / "model.json")
    return model, load_record(folder / "record.csv", model)


def test_a_twin_that_has_no_rows_yet_says_so(
    case: Case, tmp_path: Path, rga: Callable[..., Any]
) -> None:
    settings = Settings(level="A", calibration_rows=60, packet=20, settle=40)
    begun(case[0], tmp_path / "live", settings=settings)
    told = rga("export", tmp_path / "live", "-o", tmp_path / "live.csv")
    assert told.code == 2
    assert "the twin has no rows yet" in told.err
    assert "no such file" in rga("export", tmp_path, "-o", tmp_path / "live.csv").err


def played(case: Case, place: Path, rows: int) -> None:
    settings = Settings(level="A", calibration_rows=60, packet=20)
    with taken_up(*case, place, settings, 0) as running:
        while running.row < rows and running.stage != "close":
            running.step()


@pytest.mark.parametrize("ending", ["csv", "parquet"])
@pytest.mark.parametrize("start", [0.0, "2026-03-29T01:30:00+01:00"])
def test_what_went_in_comes_out(
    start: str | float, ending: str, case: Case, tmp_path: Path, rga: Callable[..., Any]
) -> None:
    model, given = case
    assert np.isnan(given.readings).any(), "missing readings are a part of the test"
    dated = "iso" if isinstance(start, str) else "seconds"
    given = replace(given, start=start, time_format=dated)
    played((model, given), tmp_path / "twin.sqlite", 100)
    target = tmp_path / f"out.{ending}"
    done = rga("export", tmp_path, "-o", target)
    assert f"100 rows of {len(given.sensors)} sensors" in done.out
    back = load_record(target, model)
    np.testing.assert_array_equal(back.readings, given.readings[:100])
    np.testing.assert_array_equal(back.time, given.time[:100])
    for name, column in given.contexts.items():
        np.testing.assert_array_equal(back.contexts[name], column[:100])
    assert (back.start, back.time_format) == (given.start, given.time_format)


def test_where_a_run_stands(case: Case, tmp_path: Path, rga: Callable[..., Any]) -> None:
    model, given = case
    played(case, tmp_path / "twin.sqlite", 40)
    assert "it gathers rows for the first calibration" in rga("status", tmp_path).out
    played(case, tmp_path / "twin.sqlite", 100)
    said = rga("status", tmp_path).out
    assert f"{model.name}: 100 rows, the last of {given.time[99]:g} s" in said
    assert "it watches" in said
    assert "Model version 1 is in force; no alarm is open." in said
    assert "calibration: calibrated on 60 rows" in said
    with Twin.open(tmp_path) as twin:
        assert twin.status().rows == 100
        assert [one.kind for one in twin.status().events] == ["calibration"]


def test_nothing_has_run_there(tmp_path: Path, rga: Callable[..., Any]) -> None:
    for name in ("status", "export"):
        assert rga(name, tmp_path).code == 2


def test_a_service_that_runs_gives_no_record(tmp_path: Path, rga: Callable[..., Any]) -> None:
    refused = rga("export", "http://127.0.0.1:9/east", "-o", tmp_path / "east.csv")
    assert refused.code == 2
    assert refused.err.count("\n") == 1
    assert "a service that runs gives no record" in refused.err
    assert "/api/v1/twins/east/series" in refused.err
    assert "names no twin" in rga("export", "http://127.0.0.1:9").err
    assert not list(tmp_path.iterdir())
