"""`rga benchmark endless`: what is measured of runs without end, and that storage is bounded."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga_bench.endless.experiment import EndlessExperiment
from rga_bench.endless.measure import PACKET
from rga_bench.experiment import Execution


def test_the_command_writes_its_tables(
    rga: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[float] = []
    measure = EndlessExperiment.measure

    def listened_to(experiment: EndlessExperiment, execution: Execution) -> Any:
        return measure(experiment, Execution(progress=told.append))

    monkeypatch.setattr(EndlessExperiment, "measure", listened_to)
    target = tmp_path / "endless.json"
    assert (
        rga("benchmark", "endless", "--quick", "-o", tmp_path / "out", "--json", target).code == 0
    )
    assert told == sorted(told)
    content = json.loads(target.read_text(encoding="utf-8"))
    (run,) = content["runs"]
    assert run["rows"] == 4_000
    assert run["ratio"] == run["late"] / run["early"]
    assert run["memory"] > run["loaded"] > 10e6
    # A step leaves little beside its rows: time, readings, simulations and gaps of each sensor, and
    # contexts as measured, inferred and unsure.
    assert run["rows_stored"] / PACKET >= 8 * (1 + 3 * run["sensors"])
    assert 0 < run["stored"] - run["rows_stored"] < 8_000
    cut, killed = content["disturbed"]
    assert (cut["times"], killed["times"]) == (2, 3)
    for one in (cut, killed):
        assert (one["lost"], one["doubled"], one["differing"]) == (0, 0, 0)
    assert content["fleet"]["load"] > 0
    page = (tmp_path / "out" / "endless.md").read_text(encoding="utf-8")
    assert "`rga benchmark endless --quick --seed 0`" in page
    assert "| 4,000 " in page
