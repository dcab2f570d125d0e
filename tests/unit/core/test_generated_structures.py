"""The structures that solvers are compared on are what they are said to be."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import _core
from rga_bench.solver.box_bridge import EXPANSION, PATTERNS, box_bridge, samples
from rga_bench.solver.double_layer_grid import DENSITY, GRAVITY, PANEL, double_layer_grid
from rga_bench.solver.space_truss import SpaceTruss

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "verification"
DIRECTIONS = ("ux", "uy", "uz")


def read(name: str) -> Any:
    path = FOLDER / f"{name}.json"
    if not path.exists():
        pytest.skip("the verification set is not beside the repository")
    return json.loads(path.read_text(encoding="utf-8"))


def test_the_box_bridge_is_that_of_the_verification_set() -> None:
    base, contexts = read("truss3d_bridge84_base"), read("truss3d_bridge84_contexts")
    bridge = box_bridge()
    structure = bridge.structure
    np.testing.assert_array_equal(structure["coordinates"], list(base["nodes"].values()))
    assert [*base["nodes"]] == [str(number) for number in range(84)]
    elements = base["elements"]
    assert structure["ends"].tolist() == [[int(node) for node in e["nodes"]] for e in elements]
    for key in ("A", "E"):
        np.testing.assert_array_equal(structure[key], [element[key] for element in elements])
    fixed = np.zeros((84, 6), dtype=bool)
    for support in base["supports"]:
        fixed[int(support["node"]), [DIRECTIONS.index(dof) for dof in support["dofs"]]] = True
    np.testing.assert_array_equal(structure["fixed"], fixed)
    springs = zip(structure["spring_node"][:, 0], structure["spring_stiffness"], strict=True)
    assert [*springs] == [(int(spring["node"]), spring["k"]) for spring in base["springs"]]
    assert {spring["dof"] for spring in base["springs"]} == {"ux"}
    strain = bridge.loads["strain"][PATTERNS:, :, 0]
    np.testing.assert_array_equal(strain, EXPANSION * np.array(contexts["temperature_fields"]))
    assert contexts["alpha"] == EXPANSION
    for count, drawn in (("load_patterns", PATTERNS), ("sensors", len(bridge.outputs["kind"]))):
        assert len(contexts[count]) == drawn
    for pattern, given in zip(bridge.loads["forces"], contexts["load_patterns"], strict=False):
        assert np.any(pattern, axis=1).sum() == len(given)
        forces = np.array([load["f"] for load in given])
        assert (pattern.min(axis=0)[:3] >= [0.0, -1e3, -2e4]).all()
        assert (forces >= [0.0, -1e3, -2e4]).all()
        assert (forces <= [0.0, 1e3, -1e3]).all()


def test_samples_of_the_verification_set_on_the_box_bridge() -> None:
    contexts = read("truss3d_bridge84_contexts")
    bridge = box_bridge()
    forces = bridge.loads["forces"]
    forces[:PATTERNS] = 0.0
    for pattern, loads in zip(forces, contexts["load_patterns"], strict=False):
        for load in loads:
            pattern[int(load["node"]), :3] += load["f"]
    sensors = contexts["sensors"]
    bridge.outputs["index"] = np.array([int(sensor["node"]) for sensor in sensors])
    read_along = [DIRECTIONS.index(sensor["dof"]) for sensor in sensors]
    bridge.outputs["vector"] = np.eye(3)[read_along]
    solver = _core.Refactored(bridge.structure, bridge.loads, bridge.outputs)
    (group,) = [group for group in contexts["samples"] if group["kind"] == "C3"]
    springs = np.array(group["spring_k"]) / bridge.structure["spring_stiffness"]
    factors = np.hstack([np.array(group["k_mult"]), springs])
    found = solver.respond(factors, np.hstack([group["q"], group["T"]]))
    expected = np.array(group["sensors"])
    largest = np.abs(expected).max(axis=1, keepdims=True)
    assert (np.abs(found - expected) <= contexts["rtol_of_max"] * largest).all()


def stretch(truss: SpaceTruss) -> tuple[Any, Any]:
    """Unit vectors along the members, and their lengths."""
    ends = truss.structure["coordinates"][truss.structure["ends"]]
    between = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(between, axis=1)
    return between / lengths[:, None], lengths


@pytest.mark.parametrize("spans", [1, 3])
def test_spans_rest_on_piers_and_are_alike(spans: int) -> None:
    bridge = box_bridge(spans=spans)
    structure = bridge.structure
    assert len(structure["coordinates"]) == 84 * spans
    held = np.flatnonzero(structure["fixed"][:, 2])
    assert len(held) == 2 * (spans + 1)
    np.testing.assert_allclose(
        np.unique(structure["coordinates"][held, 0]), 63.0 * np.arange(spans + 1)
    )
    assert len({tuple(sorted(pair)) for pair in structure["ends"].tolist()}) == len(
        structure["ends"]
    )
    factors, q = samples(bridge, 3, seed=1)
    solver = _core.Refactored(structure, bridge.loads, bridge.outputs)
    assert np.isfinite(solver.respond(factors, q)).all()


def test_a_double_layer_grid_stands_on_its_edge_and_carries_its_weight() -> None:
    panels = 5
    grid = double_layer_grid(panels, seed=3)
    structure, (forces,) = grid.structure, grid.loads["forces"]
    nodes, ends = structure["coordinates"], structure["ends"]
    assert 3 * len(nodes) == 6 * panels * (panels + 1) + 3
    assert len(ends) == 8 * panels**2 == len({tuple(sorted(pair)) for pair in ends.tolist()})
    along, lengths = stretch(grid)
    np.testing.assert_allclose(lengths, PANEL)
    weight = GRAVITY * DENSITY * (structure["A"] * lengths).sum()
    np.testing.assert_allclose(forces.sum(axis=0), [0, 0, -weight, 0, 0, 0])
    held = structure["fixed"][:, 2]
    edge = np.isin(nodes[:, :2], [0.0, panels * PANEL]).any(axis=1) & (nodes[:, 2] > 0.0)
    np.testing.assert_array_equal(held, edge)
    # Equilibrium of every node in every free direction, from the displacements alone.
    moved = _core.respond(structure, grid.loads, grid.outputs)[0].reshape(-1, 3)
    pulled = ((moved[ends[:, 1]] - moved[ends[:, 0]]) * along).sum(axis=1)
    tension = (structure["E"] * structure["A"] / lengths * pulled)[:, None] * along
    balance = forces[:, :3].copy()
    np.add.at(balance, ends[:, 0], tension)
    np.add.at(balance, ends[:, 1], -tension)
    free = ~structure["fixed"][:, :3]
    assert np.abs(balance[free]).max() <= 1e-9 * np.abs(tension).max()
    assert (moved[:, 2][~held] < 0.0).all()
