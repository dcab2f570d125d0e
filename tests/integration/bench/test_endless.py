"""`rga benchmark endless`: what is measured of runs without end, and that storage is bounded."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga_bench.endless.measure import PACKET, measure


@pytest.mark.thorough
def test_the_command_writes_its_tables(rga: Callable[..., Any], tmp_path: Path) -> None:
    target = tmp_path / "endless.json"
    assert (
        rga("benchmark", "endless", "--quick", "-o", tmp_path / "out", "--json", target).code == 0
    )
    content = json.loads(target.read_text(encoding="utf-8"))
    (run,) = content["runs"]
    assert run["rows"] == 4_000
    assert run["ratio"] == run["late"] / run["early"]
    assert run["memory"] > run["loaded"] > 10e6
    cut, killed = content["disturbed"]
    assert (cut["times"], killed["times"]) == (2, 3)
    for one in (cut, killed):
        assert (one["lost"], one["doubled"], one["differing"]) == (0, 0, 0)
    assert content["fleet"]["load"] > 0
    page = (tmp_path / "out" / "endless.md").read_text(encoding="utf-8")
    assert "`rga benchmark endless --quick --seed 0`" in page
    assert "| 4,000 " in page


@pytest.mark.thorough
def test_a_step_leaves_little_beside_its_rows() -> None:
    told: list[float] = []
    run = measure(4_000, 24, 10, 1, told.append)
    assert told == sorted(told)
    per_row = run.rows_stored / PACKET
    # Time, readings, simulations and gaps, and three contexts as measured, inferred and unsure.
    assert per_row >= 8 * (1 + 3 * 24)
    assert 0 < run.stored - run.rows_stored < 8_000
