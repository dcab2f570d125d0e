"""Derivatives of samples, forward and adjoint, against differences of high order."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from random_structures import Case, cases, laws
from rga import _core
from rga._core import Condensation
from rga_bench.solver.box_bridge import box_bridge

#: differences of fourth order: places and weights
STENCIL = ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12))
STEP = 1e-3


def every_kind(case: Case) -> Any:
    """Outputs of every kind at every node and member."""
    rows = [
        (kind, node, -1, direction)
        for kind in (0, 1, 4, 5)
        for node in range(case.nodes)
        for direction in np.eye(3)
    ]
    for member in range(case.members):
        rows += [
            (2, member, -1, [0.3, 0.01 * case.structure["frame"][member], 0.0]),
            *((3, member, part, [0.6, 0.0, 0.0]) for part in range(6)),
            (6, member, 4, np.zeros(3)),
        ]
    kind, index, other, vector = zip(*rows, strict=True)
    return {
        "kind": np.array(kind),
        "index": np.array(index),
        "other": np.array(other),
        "vector": np.array(vector, dtype=float),
        "total": np.arange(len(rows)) % 5 == 0,
    }


def in_two(loads: Any) -> Any:
    """One pattern as two: the loads along members apart from all others."""
    for name in ("forces", "strain", "prescribed", "prescribed_inclined"):
        loads = {**loads, name: np.concatenate([loads[name], np.zeros_like(loads[name])])}
    return {**loads, "member_pattern": np.ones_like(loads["member_pattern"])}


def assert_close(found: Any, expected: Any, values: Any, kinds: Any) -> None:
    """To 1e-7 of the largest derivative or value of a kind."""
    for kind in np.unique(kinds):
        chosen = kinds == kind
        error = np.abs(found[..., chosen] - expected[..., chosen]).max()
        size = max(np.abs(expected[..., chosen]).max(), np.abs(values[..., chosen]).max())
        assert error <= 1e-7 * size


@laws
@given(case=cases(), seed=st.integers(0, 2**32 - 1))
def test_of_a_refactored_structure(case: Case, seed: int) -> None:
    draw = np.random.default_rng(seed)
    structure = dict(case.structure)
    # Ends that yield do not scale with their member.
    structure["connection"] = np.where(structure["connection"] > 0, np.inf, 0.0)
    outputs = every_kind(case)
    every = _core.Refactored(structure, in_two(case.loads), outputs)
    elements = case.members + len(structure["spring_dof"])
    q, factors = draw.uniform(-1, 1, (3, 2)), draw.uniform(0.5, 2.0, (3, elements))
    # Along the first direction one load and all stiffnesses change, along the second one of each.
    rates = np.zeros((2, 3, 2)), np.zeros((2, 3, elements))
    rates[0][[0, 1], :, [0, 1]] = draw.normal(size=(2, 3))
    rates[1][0], rates[1][1, :, -1] = draw.normal(size=(3, elements)), draw.normal(size=3)
    of_loads, of_factors = (np.moveaxis(one, 0, 2) for one in rates)
    found = every.differentiate(factors, q, np.arange(elements), of_factors, of_loads)
    for direction in range(2):
        along = sum(
            weight
            / STEP
            * every.respond(
                factors + place * STEP * rates[1][direction], q + place * STEP * rates[0][direction]
            )
            for place, weight in STENCIL
        )
        assert_close(found[:, :, direction], along, every.respond(factors, q), outputs["kind"])
    gradients = draw.normal(size=(3, len(outputs["kind"])))
    pulled = every.pull_back(factors, q, gradients)
    for direction in range(2):
        terms_of = np.concatenate([rates[0][direction], rates[1][direction]], axis=1) * pulled
        forward = gradients * found[:, :, direction]
        size = np.abs(forward).sum(axis=1)
        assert (np.abs(terms_of.sum(axis=1) - forward.sum(axis=1)) <= 1e-9 * size).all()


@pytest.mark.parametrize("rows", [1, 7, 100])
def test_adjoint_of_a_condensation(rows: int) -> None:
    bridge = box_bridge(rows)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    draw = np.random.default_rng(rows)
    patterns, terms = len(bridge.loads["forces"]), len(ours.stiffness)
    q = draw.uniform(-1, 1, (rows, patterns))
    stiffness = ours.stiffness * draw.uniform(0.5, 2, (rows, terms))
    along = [
        np.broadcast_to(np.eye(patterns, patterns + terms), (rows, patterns, patterns + terms)),
        np.broadcast_to(np.eye(terms, patterns + terms, patterns), (rows, terms, patterns + terms)),
    ]
    whole = ours.differentiate(q, stiffness, *along)
    gradients = draw.normal(size=(rows, whole.shape[1]))
    expected = np.einsum("to,toc->tc", gradients, whole)
    found = ours.pull_back(q, stiffness, gradients)
    size = np.einsum("to,toc->tc", np.abs(gradients), np.abs(whole))
    assert (np.abs(found - expected) <= 1e-12 * size).all()
    for threads in (2, 3):
        np.testing.assert_array_equal(ours.pull_back(q, stiffness, gradients, threads), found)


def test_bad_gradients_are_refused() -> None:
    bridge = box_bridge(1)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    q = np.zeros((2, len(bridge.loads["forces"])))
    stiffness = np.tile(ours.stiffness, (2, 1))
    gradients = np.zeros((2, len(bridge.outputs["kind"])))
    gradients[1, 3] = np.nan
    with pytest.raises(_core.InvalidInput, match="gradients holds NaN at row 1, column 3"):
        ours.pull_back(q, stiffness, gradients)
    with pytest.raises(_core.InvalidInput, match="gradients holds"):
        ours.pull_back(q, stiffness, gradients[:1])
