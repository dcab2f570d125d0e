"""`rga benchmark modes`: the solvers agree, one that is wrong is refused, one may be missing."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import _core
from rga_bench.modes import figures
from rga_bench.modes.peers import ArpackOnCholmod, Dense, ShiftInvert, hertz
from rga_bench.modes.setting import ModesSetting
from rga_bench.modes.swinging import Swinging
from rga_bench.solver.box_bridge import box_bridge
from rga_bench.solver.double_layer_grid import double_layer_grid

LITTLE = ModesSetting(
    seconds=0.0, panels=4, samples=16, windows=16, rows=60, structure="portal", judged=False
)


def peer(name: str, swinging: Swinging) -> Any:
    """A solver of the benchmark; the test is skipped where it is not installed."""
    if name == "CHOLMOD":
        pytest.importorskip("sksparse")
        return ArpackOnCholmod(swinging, 8, ("supernodal", "amd"))
    return {"dense": Dense, "eigsh": ShiftInvert}[name](swinging, 8)


@pytest.mark.parametrize("name", ["dense", "eigsh", "CHOLMOD"])
@pytest.mark.parametrize("truss", [box_bridge(seed=4), double_layer_grid(4, seed=1)])
def test_a_peer_agrees(name: str, truss: Any) -> None:
    swinging = Swinging.of(truss)
    count = len(truss.structure["ends"]) + len(truss.structure["spring_stiffness"])
    factors = np.random.default_rng(5).uniform(0.7, 1.4, count)
    ours = hertz(_core.modes(swinging.structure(factors), swinging.masses, 8)[0])
    np.testing.assert_allclose(peer(name, swinging).frequencies(factors), ours, rtol=1e-9)


@pytest.mark.parametrize("few", [True, False])
def test_samples_side_by_side_agree_with_dense_matrices(few: bool) -> None:
    swinging = Swinging.of(box_bridge(seed=4))
    structure, masses = swinging.truss.structure, swinging.masses
    count = len(structure["ends"]) + len(structure["spring_stiffness"])
    draw = np.random.default_rng(6)
    varied = draw.choice(count, 10, replace=False) if few else np.arange(count)
    factors = np.ones((9, count))
    factors[:, varied] = draw.uniform(0.4, 1.8, (9, len(varied)))
    batch = _core.ModalBatch(structure, masses, varied, 8, np.zeros(0, np.int64))
    squares, _ = batch.modes(np.ascontiguousarray(factors[:, varied]), 2)
    dense = Dense(swinging, 8)
    for own, sample in zip(squares, factors, strict=True):
        np.testing.assert_allclose(hertz(own), dense.frequencies(sample), rtol=1e-9)


def test_a_peer_that_is_wrong_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    right = ShiftInvert.frequencies
    monkeypatch.setattr(
        ShiftInvert, "frequencies", lambda self, factors: right(self, factors) * (1 + 1e-7)
    )
    with pytest.raises(ArithmeticError):
        figures.few_vary(LITTLE)


def test_the_command_without_cholmod(
    rga: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga_bench.modes.experiment.shorter", lambda seed: LITTLE)
    monkeypatch.setattr("rga_bench.modes.figures.present", lambda make: None)
    folder, file = tmp_path / "out", tmp_path / "figures.json"
    ran = rga("benchmark", "modes", "--quick", "-o", folder, "--json", file)
    assert ran.code == 0, ran.err
    page = (folder / "modes.md").read_text(encoding="utf-8")
    assert "ARPACK on CHOLMOD | not installed" in page
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["command"] == "rga benchmark modes --quick --seed 0"
    assert all(figure["value"] > 0.0 for figure in content["figures"])
