"""What a sample costs on each path: `pytest benches` (needs pytest-benchmark).

`rga benchmark solver` measures the same beside NumPy.
"""

from typing import Any

import numpy as np
import pytest

from rga import _core
from rga._core import Condensation
from rga.simulation.paths.factorisation import Factorisation
from rga_bench.solver.box_bridge import box_bridge

ROWS = 4096
NOTHING = np.zeros(0, np.int64)


@pytest.mark.parametrize("path", ["C1", "C2"])
def test_condensed(benchmark: Any, path: str) -> None:
    bridge = box_bridge()
    varied = (NOTHING, NOTHING) if path == "C1" else (bridge.members, bridge.springs)
    ours = Condensation(bridge.structure, bridge.loads, bridge.outputs, *varied)
    draw = np.random.default_rng(1)
    q = draw.uniform(-1, 1, (ROWS, len(bridge.loads["forces"])))
    stiffness = ours.stiffness * draw.uniform(0.5, 1.5, (ROWS, len(ours.stiffness)))
    shown = benchmark(ours.respond, q, stiffness)
    assert np.isfinite(shown).all()


def test_refactored(benchmark: Any) -> None:
    bridge = box_bridge()
    ours = _core.Refactored(bridge.structure, bridge.loads, bridge.outputs)
    draw = np.random.default_rng(1)
    q = draw.uniform(-1, 1, (256, len(bridge.loads["forces"])))
    terms = len(bridge.structure["ends"]) + len(bridge.springs)
    shown = benchmark(ours.respond, draw.uniform(0.5, 1.5, (256, terms)), q)
    assert np.isfinite(shown).all()


@pytest.mark.parametrize("path", ["C2", "C3"])
@pytest.mark.parametrize("way", ["forward", "adjoint"])
def test_derivatives(benchmark: Any, path: str, way: str) -> None:
    """Of 84 sensors by eight contexts; or of one function of them by all that they depend on."""
    bridge = box_bridge(sensors=84)
    arrays = (bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs)
    few = Condensation(*arrays)
    ours = few if path == "C2" else Factorisation(*arrays, few.stiffness)
    draw = np.random.default_rng(1)
    q = draw.uniform(-1, 1, (256, len(bridge.loads["forces"])))
    stiffness = few.stiffness * draw.uniform(0.5, 1.5, (256, len(few.stiffness)))
    if way == "adjoint":
        found = benchmark(ours.pull_back, q, stiffness, draw.normal(size=(256, 84)))
    else:
        rates = np.zeros((256, q.shape[1], 8))
        rates[:, :6, :6] = np.eye(6)
        of_elements = np.zeros((256, len(few.stiffness), 8))
        of_elements[:, :, 6:] = few.stiffness[:, None]
        found = benchmark(ours.differentiate, q, stiffness, rates, of_elements)
    assert np.isfinite(found).all()


def test_one_sample(benchmark: Any) -> None:
    bridge = box_bridge()
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    q = np.ones((1, len(bridge.loads["forces"])))
    assert np.isfinite(benchmark(ours.respond, q, ours.stiffness[None])).all()
