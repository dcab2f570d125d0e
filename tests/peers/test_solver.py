"""`rga benchmark solver`: the solvers agree, one that is wrong is refused, one may be missing."""

import json
import os
import sys
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import _core
from rga_bench.measurement import Measurement
from rga_bench.solver import cores, large, refactored
from rga_bench.solver.box_bridge import box_bridge, samples
from rga_bench.solver.data_set import data_set_cost
from rga_bench.solver.double_layer_grid import double_layer_grid
from rga_bench.solver.experiment import SolverExperiment
from rga_bench.solver.from_scratch import FromScratch
from rga_bench.solver.peers.cholmod import Cholmod, least_operations
from rga_bench.solver.peers.linear_system import LinearSystem
from rga_bench.solver.peers.pynite import PyNite
from rga_bench.solver.peers.superlu import SuperLU
from rga_bench.solver.result import SolverResult
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.solver.table import page

#: as little as can be measured
LITTLE = SolverSetting(rows=64, seconds=0.0, panels=(6,), data_set=100)
ROOFS = Roofs(1e10, 1e10, 1e10)


def solver(name: str, bridge: Any, system: LinearSystem) -> Any:
    """A solver of the benchmark; the test is skipped where it is not installed."""
    if name == "splu":
        return SuperLU(system)
    if name == "PyNite":
        pytest.importorskip("Pynite")
        return PyNite(bridge, system)
    pytest.importorskip("sksparse")
    mode, ordering = name.split()
    return Cholmod(system, (mode, ordering))


NAMES = ["splu", "PyNite", "simplicial amd", "simplicial natural", "supernodal nesdis"]


@pytest.mark.parametrize("name", NAMES)
def test_a_peer_agrees(name: str) -> None:
    bridge = box_bridge(seed=4)
    peer = solver(name, bridge, LinearSystem(bridge))
    factors, q = samples(bridge, 3, seed=5)
    expected = FromScratch(bridge).respond(factors, q)
    for rows in (slice(0, 3), slice(1, 2)):
        found = peer.respond(factors[rows], q[rows])
        assert np.abs(found - expected[rows]).max() <= 1e-9 * np.abs(expected).max()


@dataclass(frozen=True)
class Off:
    """A solver whose results are off by a share."""

    solver: Any
    share: float
    rows: int = 4

    def respond(self, factors: Any, coefficients: Any) -> Any:
        return self.solver.respond(factors, coefficients) * (1.0 + self.share)


@pytest.mark.parametrize("name", ["ours", *NAMES])
def test_a_solver_that_is_wrong_is_refused(name: str) -> None:
    bridge = box_bridge()
    right = FromScratch(bridge) if name == "ours" else solver(name, bridge, LinearSystem(bridge))
    found = refactored.rates(bridge, {"right": Off(right, 1e-11), "absent": None}, LITTLE)
    assert found.keys() == {"right"}
    with pytest.raises(ArithmeticError, match=r"the wrong one is off by 2\.0e-09 of the largest"):
        refactored.rates(bridge, {"the wrong one": Off(right, 2e-9)}, LITTLE)
    with pytest.raises(ArithmeticError, match="the broken one is off by nan"):
        refactored.rates(bridge, {"the broken one": Off(right, np.nan)}, LITTLE)


def test_a_grid_that_is_wrong_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    real = large._cholmod

    def wrong(*given: Any) -> Any:
        names, _ = real(*given)
        return names, [
            lambda: FromScratch(double_layer_grid(6)).respond(*given[1:]) * (1 + 2e-8)
        ] * 2

    monkeypatch.setattr(large, "_cholmod", wrong)
    with pytest.raises(ArithmeticError, match=r"the grid is off by 2\.0e-08"):
        large.grid(6, LITTLE, ROOFS)


def test_what_is_not_installed_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("sksparse", "sksparse.cholmod", "Pynite"):
        monkeypatch.setitem(sys.modules, name, None)
    figures = refactored.one_span(LITTLE, ROOFS) + large.grid(6, LITTLE, ROOFS)
    missing = {one.peer for one in figures if one.peer is not None and one.peer_value is None}
    assert missing == {"CHOLMOD", "PyNite"}
    there = {one.peer for one in figures if one.ratio is not None}
    assert there == {"SciPy splu", "rga, the structure anew"}
    text = page(result(figures), "rga benchmark solver").text()
    assert text.count("| not installed |") == len(_core.instructions()) + 1 + 3


def test_every_figure_has_its_peer() -> None:
    pytest.importorskip("sksparse")
    pytest.importorskip("Pynite")
    figures = refactored.one_span(LITTLE, ROOFS) + large.grid(6, LITTLE, ROOFS)
    assert not [one for one in figures if one.peer is not None and one.peer_value is None]
    residuals = [one for one in figures if one.name.startswith("residual")]
    assert all(0.0 < one.value < 1e-10 for one in residuals)
    shares = [one for one in figures if "roof" in one.name]
    assert len(shares) == 2


def test_the_least_operations_are_those_of_an_elimination() -> None:
    """Counted by eliminating one unknown after the other, in an order that CHOLMOD tries."""
    pytest.importorskip("sksparse")
    system = LinearSystem(double_layer_grid(3))
    whole = system.lower + system.lower.T
    near = [set(whole.indices[a:b]) for a, b in pairwise(whole.indptr)]
    squares = 0
    for pivot in range(system.size):
        after = {one for one in near[pivot] if one > pivot}
        squares += (len(after) + 1) ** 2
        for one in after:
            near[one] |= after
    counted = (Cholmod(system, ("simplicial", "natural")).columns() ** 2).sum()
    assert counted == squares
    assert least_operations(system)[0] <= squares


def test_a_linear_system_holds_no_entry_that_is_always_zero() -> None:
    bridge = box_bridge()
    system = LinearSystem(bridge)
    factors, _ = samples(bridge, 4, seed=6)
    assert (np.abs(system.values(factors)).max(axis=0) > 0.0).all()


def test_two_cores_are_measured_beside_a_product() -> None:
    figures = cores.two_cores(LITTLE, ROOFS)
    assert [one.peer for one in figures] == ["NumPy GEMM"] * ((os.cpu_count() or 1) > 1)


def test_memory_of_a_data_set_is_not_that_of_this_process() -> None:
    held = np.ones(2**26)
    del held
    memory, seconds = data_set_cost(100)
    assert 50.0 < memory < 512.0
    assert seconds > 0.0


def result(figures: list[Measurement]) -> SolverResult:
    machine = {
        "processor": "Z80",
        "instructions": ["portable"],
        "cores": 1,
        "memory_GiB": 0.1,
        "system": "CP/M",
    }
    return SolverResult(machine, {"rga": "1", "CHOLMOD": None}, "1982-04-23", 7, ROOFS, figures)


def test_a_page_reports_ratios_and_whether_they_reach_their_targets() -> None:
    text = page(
        result(
            [
                Measurement("bridge", "lanes", 180_000.0, "/s").beside("CHOLMOD", 10_000.0, 17.0),
                Measurement("bridge", "no lanes", 1_234_567.0, "/s").beside("CHOLMOD", 1e7, 9.0),
                Measurement("roof", "solve", 0.0123, "s").beside("CHOLMOD", 0.0246, 0.5),
                Measurement("roof", "residual", 1.5e-12),
            ]
        ),
        "rga benchmark solver --seed 7",
    ).text()
    assert "`rga benchmark solver --seed 7` on 1982-04-23" in text
    for line in (
        "| **bridge** |  |  |  |  |  |",
        "| lanes | 180 000/s | CHOLMOD | 10 000/s | 18 | 17 ✓ |",
        "| no lanes | 1.23 million/s | CHOLMOD | 10 million/s | 0.123 | 9 ✗ |",
        "| solve | 12.3 ms | CHOLMOD | 24.6 ms | 2 | 0.5 ✓ |",
        "| residual | 1.5e-12 |  |  |  |  |",
        "- Z80 with portable",
        "- rga 1, CHOLMOD not installed",
        "- seed 7",
    ):
        assert line in text.splitlines()


@pytest.mark.thorough
def test_the_command(rga: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "rga_bench.solver.experiment.shorter",
        lambda seed: replace(LITTLE, rows=256, seed=seed, judged=False),
    )
    folder, file = tmp_path / "out", tmp_path / "figures.json"
    ran = rga("benchmark", "solver", "--quick", "-o", folder, "--json", file)
    assert ran.code == 0, ran.err
    assert "C3, every stiffness varies, 244 DOFs" in ran.out
    assert {path.name for path in folder.iterdir()} == {"solver.md", "solver.png"}
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["command"] == "rga benchmark solver --quick --seed 0"
    assert content["roofs"]["arithmetic"] > 0.0
    cases = {figure["case"] for figure in content["figures"]}
    page = (folder / "solver.md").read_text(encoding="utf-8")
    assert all(f"| **{case}** |" in page for case in cases)


def test_a_place_that_cannot_be_written_is_reported_before_anything_is_measured(
    rga: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(SolverExperiment, "measure", None)
    taken = tmp_path / "file"
    taken.touch()
    ran = rga("benchmark", "solver", "-o", taken)
    assert ran.code == 2
    assert "the output is a file" in ran.err
