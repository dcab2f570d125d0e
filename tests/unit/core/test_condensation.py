"""The paths of the simulation agree with a plain dense solve, whatever varies in a truss."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

from rga import _core
from rga._core import Condensation, DependentTerms, OutputKind
from rga_bench.solver.box_bridge import BoxBridge, box_bridge

DISPLACEMENT, STRAIN = OutputKind.DISPLACEMENT, OutputKind.STRAIN
FORCE, REACTION = OutputKind.SECTION_FORCE, OutputKind.REACTION_FORCE


def small_bridge(seed: int) -> BoxBridge:
    """The box bridge with sensors of every kind, on members and springs that vary too."""
    bridge = box_bridge(seed)
    draw = np.random.default_rng([seed, 1])
    members = bridge.members[:3]
    node = int(bridge.structure["spring_node"][0, 0])
    along = [0.0, 0.0, 0.0]
    rows = [
        *((DISPLACEMENT, int(draw.integers(84)), np.eye(3)[draw.integers(3)]) for _ in range(4)),
        *((STRAIN, int(member), along) for member in (*members, 7)),
        *((FORCE, int(member), along) for member in (*members, 9)),
        (REACTION, node, [1.0, 0.0, 0.0]),
        (REACTION, 0, [0.0, 0.0, 1.0]),
    ]
    bridge.outputs.update(
        kind=np.array([row[0] for row in rows]),
        index=np.array([row[1] for row in rows]),
        other=np.array([0 if row[0] == FORCE else -1 for row in rows]),
        vector=np.array([row[2] for row in rows], dtype=float),
        total=np.arange(len(rows)) == 5,
    )
    bridge.loads["prescribed"][0, 0, 2] = -0.01
    return bridge


def dense(bridge: BoxBridge, q: Any, factors: Any) -> Any:
    """One sample by a dense solve, written without the package: a truss with springs to ground."""
    structure, loads, outputs = bridge.structure, bridge.loads, bridge.outputs
    nodes, ends = structure["coordinates"], structure["ends"]
    between = nodes[ends[:, 1]] - nodes[ends[:, 0]]
    lengths = np.linalg.norm(between, axis=1)
    axial = structure["E"] * structure["A"] * factors[: len(ends)]
    springs = structure["spring_stiffness"] * factors[len(ends) :]
    size = 3 * len(nodes)
    direction, every = between / lengths[:, None], np.arange(len(ends))
    geometry = np.zeros((len(ends), len(nodes), 3))
    geometry[every, ends[:, 0]] = -direction
    geometry[every, ends[:, 1]] = direction
    geometry = geometry.reshape(len(ends), size)
    sparse = csr_array(geometry)
    stiffness = (sparse.T @ (sparse * (axial / lengths)[:, None])).toarray()
    for spring, (node, dof) in enumerate(
        zip(structure["spring_node"][:, 0], structure["spring_dof"], strict=True)
    ):
        stiffness[3 * node + dof, 3 * node + dof] += springs[spring]
    strain = np.tensordot(q, loads["strain"], 1)[:, 0]
    applied = np.tensordot(q, loads["forces"], 1)[:, :3].ravel()
    applied = applied + geometry.T @ (axial * strain)
    moved = np.tensordot(q, loads["prescribed"], 1)[:, :3].ravel()
    held = structure["fixed"][:, :3].ravel()
    motion = np.where(held, moved, 0.0)
    free = ~held
    motion[free] = np.linalg.solve(
        stiffness[np.ix_(free, free)], applied[free] - stiffness[np.ix_(free, held)] @ motion[held]
    )
    mechanical = geometry @ motion / lengths - strain
    reactions = np.where(held, stiffness @ motion - applied, 0.0)
    for spring, (node, dof) in enumerate(
        zip(structure["spring_node"][:, 0], structure["spring_dof"], strict=True)
    ):
        reactions[3 * node + dof] -= springs[spring] * motion[3 * node + dof]
    out = []
    for kind, index, vector, total in zip(
        outputs["kind"], outputs["index"], outputs["vector"], outputs["total"], strict=True
    ):
        if kind == STRAIN:
            out.append(mechanical[index] + (strain[index] if total else 0.0))
        elif kind == FORCE:
            out.append(axial[index] * mechanical[index])
        else:
            source = motion if kind == DISPLACEMENT else reactions
            out.append(vector @ source[3 * index : 3 * index + 3])
    return np.array(out)


def whole(bridge: BoxBridge, factors: Any) -> Any:
    """Factors of all members and springs."""
    count = len(bridge.structure["ends"])
    everything = np.ones((len(factors), count + len(bridge.springs)))
    everything[:, bridge.members] = factors[:, : len(bridge.members)]
    everything[:, count + bridge.springs] = factors[:, len(bridge.members) :]
    return everything


def assert_agree(found: Any, expected: Any) -> None:
    """To 1e-9 of the largest value of a kind of output."""
    size = np.abs(expected).max(axis=0)
    assert (np.abs(found - expected) <= 1e-9 * size).all()


@settings(max_examples=12, derandomize=True, deadline=None)
@given(seed=st.integers(0, 10_000), rows=st.integers(1, 40))
def test_all_paths_agree_with_a_dense_solve(seed: int, rows: int) -> None:
    bridge = small_bridge(seed)
    draw = np.random.default_rng([seed, 2])
    q = draw.uniform(-1, 1, (rows, len(bridge.loads["forces"])))
    factors = draw.uniform(0.3, 2.0, (rows, len(bridge.members) + len(bridge.springs)))
    arrays = (bridge.structure, bridge.loads, bridge.outputs)
    few = Condensation(*arrays, bridge.members, bridge.springs)
    every = _core.Refactored(*arrays)
    expected = np.array(
        [dense(bridge, *one) for one in zip(q, whole(bridge, factors), strict=True)]
    )
    assert_agree(few.respond(q, factors * few.stiffness), expected)
    assert_agree(every.respond(whole(bridge, factors), q), expected)
    none = np.zeros(0, np.int64)
    same = Condensation(*arrays, none, none)
    as_it_is = np.ones((1, len(factors.T)))
    expected = np.array([dense(bridge, one, whole(bridge, as_it_is)[0]) for one in q])
    assert_agree(same.respond(q, np.zeros((rows, 0))), expected)


def test_rows_have_the_same_bits_in_any_batch_and_on_any_number_of_threads() -> None:
    bridge = box_bridge(3)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    draw = np.random.default_rng(4)
    q = draw.uniform(-1, 1, (5000, len(bridge.loads["forces"])))
    stiffness = ours.stiffness * draw.uniform(0.5, 2, (5000, len(ours.stiffness)))
    found = ours.respond(q, stiffness)
    for threads in (2, 3):
        np.testing.assert_array_equal(ours.respond(q, stiffness, threads), found)
    for row in (0, 1, 17, 4999):
        alone = ours.respond(q[row : row + 1], stiffness[row : row + 1])
        np.testing.assert_array_equal(alone[0], found[row])


def test_derivatives_are_those_of_differences_of_high_order() -> None:
    bridge = small_bridge(5)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    draw = np.random.default_rng(6)
    rows, directions = 21, 4
    q = draw.uniform(-1, 1, (rows, len(bridge.loads["forces"])))
    stiffness = ours.stiffness * draw.uniform(0.5, 2, (rows, len(ours.stiffness)))
    of_q = draw.uniform(-1, 1, (rows, q.shape[1], directions))
    of_stiffness = ours.stiffness[:, None] * draw.uniform(-1, 1, (rows, len(ours.stiffness), 4))
    of_q[:, :, 1], of_stiffness[:, :, 2] = 0.0, 0.0
    found = ours.differentiate(q, stiffness, of_q, of_stiffness)

    def along(direction: int, step: float) -> Any:
        return ours.respond(
            np.ascontiguousarray(q + step * of_q[:, :, direction]),
            stiffness + step * of_stiffness[:, :, direction],
        )

    for direction in range(directions):
        first, second = (
            (along(direction, h) - along(direction, -h)) / (2 * h) for h in (2e-3, 1e-3)
        )
        difference = second + (second - first) / 3  # of fourth order
        size = np.abs(difference).max(axis=0)
        off = np.abs(found[:, :, direction] - difference)
        assert (off <= 1e-7 * size).all()


def test_terms_that_depend_on_each_other_are_refused() -> None:
    bridge = box_bridge(0)
    everything = np.arange(len(bridge.structure["ends"]))
    all_of_them = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, everything, bridge.springs
    )
    q = np.ones((1, len(bridge.loads["forces"])))
    with pytest.raises(DependentTerms):
        all_of_them.respond(q, all_of_them.stiffness[None])


def test_a_sample_that_can_move_is_named() -> None:
    bridge = box_bridge(0)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    q = np.ones((50, len(bridge.loads["forces"])))
    stiffness = np.tile(ours.stiffness, (50, 1))
    stiffness[37] = -ours.stiffness
    with pytest.raises(_core.UnstableSample) as caught:
        ours.respond(q, stiffness)
    assert caught.value.row == 37
    q[12, 3] = np.nan
    with pytest.raises(_core.InvalidInput, match="row 12, column 3"):
        ours.respond(q, stiffness)


def test_arrays_of_a_box_bridge_are_stable() -> None:
    bridge = box_bridge()
    assert len(bridge.structure["coordinates"]) == 84
    arrays: tuple[Any, ...] = (bridge.structure, bridge.loads, bridge.outputs)
    assert np.isfinite(_core.respond(*arrays)).all()
