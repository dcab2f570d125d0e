"""Frame members that vary, condensed: against other solvers, closed forms and structures anew."""

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from independent.reference_solver import solve_case
from rga import _core
from rga._core import Condensation, DependentTerms, OutputKind
from rga.simulation.verification_input import FrameCase, Loads, output_arrays

HERE = Path(__file__).parents[2]
NONE = np.zeros(0, np.int64)
STRAIN, FORCE = OutputKind.STRAIN, OutputKind.SECTION_FORCE


def condensed(arrays: Any, members: Any, springs: Any, q: Any, factors: Any) -> Any:
    """Outputs of rows: factors of members, then of springs, float[rows, elements]."""
    ours = Condensation(*arrays, members, springs)
    own = np.ones(len(members) + len(springs))
    own[ours.element] = ours.stiffness
    return ours.respond(q, factors * own)


@pytest.mark.parametrize(
    ("name", "members"),
    [
        ("frame3d_skew_reference", ["c1", "b2"]),
        ("frame3d_skew_reference", ["s1", "r1", "c3"]),
        ("frame2d_cantilever_with_stay", ["beam"]),
        ("frame_portal_temperature", ["2"]),
        ("beam_two_spans_settlement", ["2"]),
        ("beam_timoshenko_cantilever", ["1"]),
        ("frame_floor_ties", ["2"]),
    ],
)
def test_the_reference_solver_agrees(name: str, members: list[str]) -> None:
    case = json.loads((HERE / "verification" / f"{name}.json").read_text(encoding="utf-8"))
    frame, factors = FrameCase.read(case), np.array([[0.4, 1.7, 0.8][: len(members)]])
    softer = copy.deepcopy(case)
    for element in softer["elements"]:
        if str(element["id"]) in members:
            factor = factors[0, members.index(str(element["id"]))]
            element.update({key: element[key] * factor for key in ("E", "G") if key in element})
    numbers = np.array([frame.members[member] for member in members])
    for number, load_case in enumerate(case["load_cases"]):
        loads = Loads(frame, 1)
        loads.add(load_case, case.get("inclined_supports") or [])
        entries = load_case["expected"]
        arrays = frame.arrays, loads.arrays(), output_arrays(frame, entries)
        found = condensed(arrays, numbers, NONE, np.ones((1, 1)), factors)[0]
        expected = np.array(solve_case(softer, softer["load_cases"][number]), dtype=float)
        for kind in {entry["kind"] for entry in entries}:
            of_kind = [entry["kind"] == kind for entry in entries]
            size = np.abs(expected[of_kind]).max()
            assert np.abs(found - expected)[of_kind].max() <= 1e-9 * size, (kind, load_case)


def bent_chain(seed: int) -> tuple[Any, Any, Any]:
    """A clamped chain of frame members in space, with stays, hinged braces, springs and a roller.

    Loads of every kind lie on everything; every output there is reads every member.
    """
    draw = np.random.default_rng(seed)
    nodes = np.cumsum(draw.uniform([1.5, -1, -1], [3, 1, 1], (7, 3)), axis=0)
    ends = np.array([*((k, k + 1) for k in range(6)), (0, 3), (1, 4), (2, 6), (3, 6)])
    count, frame = len(ends), np.arange(len(ends)) % 8 != 7
    frame[6] = False
    connection = np.full((count, 12), np.inf)
    connection[8, [4, 5, 9, 10]] = 0.0  # a brace, hinged at an end and free to twist
    connection[9, [5, 10, 11]] = 0.0
    length = np.linalg.norm(np.diff(nodes[ends], axis=1)[:, 0], axis=1)
    structure = {
        "coordinates": nodes, "ends": ends, "frame": frame,
        "E": draw.uniform(1e11, 2e11, count), "G": draw.uniform(4e10, 8e10, count),
        "A": draw.uniform(2e-3, 1e-2, count), "J": draw.uniform(1e-6, 1e-4, count),
        **{name: draw.uniform(1e-5, 1e-4, count) for name in ("Iy", "Iz")},
        **{name: np.where(draw.random(count) < 0.5, np.inf, draw.uniform(1e-3, 5e-3, count))
           for name in ("Asy", "Asz")},
        "local_y": np.where(draw.random((count, 1)) < 0.3, np.nan, draw.normal(size=(count, 3))),
        "connection": connection,
        "rigid_end": draw.uniform(0, 0.2, (count, 2)) * (draw.random((count, 1)) < 0.4),
        "fixed": np.arange(7)[:, None] < np.ones((1, 6)),
        "inclined_node": np.array([4]), "inclined_direction": draw.normal(size=(1, 3)),
        "spring_node": np.array([[6, -1], [5, -1], [2, 5]]), "spring_dof": np.array([2, 4, 1]),
        "spring_stiffness": draw.uniform(1e5, 1e7, 3),
        "tie_node": np.zeros((0, 2), np.int64), "tie_dof": np.zeros(0, np.int64),
    }  # fmt: skip
    patterns, each = 3, 2 * count
    low, high = np.sort(
        draw.uniform(0, np.tile(length, patterns * 2), (2, patterns * each)), axis=0
    )
    forces = 1e4 * draw.normal(size=(patterns, 7, 6))
    loads = {
        "forces": forces, "strain": 2e-4 * draw.normal(size=(patterns, count, 3)),
        "prescribed": 1e-3 * draw.normal(size=forces.shape) * structure["fixed"],
        "prescribed_inclined": 1e-3 * draw.normal(size=(patterns, 1)),
        "member_pattern": np.repeat(np.arange(patterns), each),
        "member_index": np.tile(np.arange(count), 2 * patterns),
        "member_axis": draw.integers(0, 3, patterns * each),
        "member_from": low, "member_to": high,
        **{f"member_{end}": 1e4 * draw.normal(size=patterns * each) for end in ("start", "end")},
    }  # fmt: skip
    rows: list[tuple[int, int, int, Any, bool]] = [
        (kind, node, -1, axis, False)
        for kind in (0, 1, 4, 5) for node in range(7) for axis in np.eye(3)
    ]  # fmt: skip
    rows += [(6, member, dof, np.zeros(3), False) for member in range(count) for dof in range(12)]
    for member in range(count):
        rows += [(FORCE, member, part, [draw.random(), 0, 0], False) for part in range(6)]
        rows += [(STRAIN, member, -1, [draw.random(), *draw.normal(0, 0.1, 2)], total)
                 for total in (False, True)]  # fmt: skip
    kind, index, other, vector, total = zip(*rows, strict=True)
    outputs = {
        "kind": np.array(kind), "index": np.array(index), "other": np.array(other),
        "vector": np.array(vector, dtype=float), "total": np.array(total),
    }  # fmt: skip
    return structure, loads, outputs


@settings(max_examples=25, derandomize=True, deadline=None)
@given(seed=st.integers(0, 10_000), place=st.integers(0, 5))
def test_it_is_the_structure_anew(seed: int, place: int) -> None:
    """Condensed, refactored and assembled anew are one, on every kind of output."""
    structure, loads, outputs = bent_chain(seed)
    members, springs = np.unique([place, 4, 7, 8, 9]), np.arange(3)
    members = members[: 4 + place % 2]
    draw = np.random.default_rng([seed, 1])
    rows, count = 3, len(structure["ends"])
    q = draw.uniform(-1, 1, (rows, 3))
    factors = draw.uniform(0.3, 2, (rows, len(members) + len(springs)))
    everything = np.ones((rows, count + 3))
    everything[:, [*members, *(count + springs)]] = factors
    found = condensed((structure, loads, outputs), members, springs, q, factors)
    refactored = _core.Refactored(structure, loads, outputs).respond(everything, q)
    for row in range(rows):
        own = everything[row]
        softer = structure | {name: structure[name] * own[:count] for name in ("E", "G")}
        softer["spring_stiffness"] = structure["spring_stiffness"] * own[count:]
        anew = q[row] @ _core.respond(softer, loads, outputs)
        for kind in range(7):
            of_kind = outputs["kind"] == kind
            size = np.abs(anew[of_kind]).max()
            for other in (found[row], refactored[row]):
                assert np.abs(other - anew)[of_kind].max() <= 1e-9 * size


def test_a_gauge_under_a_load_by_hand() -> None:
    """A beam on two supports: M = q x (L - x) / 2, whatever its stiffness; strain -M y / EI."""
    length, e, inertia, load = 6.0, 2e11, 4e-5, 3e4
    frame = FrameCase.read(
        {
            "dim": 2,
            "nodes": {"a": [0, 0], "b": [length, 0]},
            "elements": [
                {"id": 1, "type": "beam", "nodes": ["a", "b"], "E": e, "A": 0.01, "Iz": inertia}
            ],
            "supports": [{"node": "a", "dofs": ["ux", "uy"]}, {"node": "b", "dofs": ["uy"]}],
        }
    )
    loads = Loads(frame, 1)
    loads.add({"element_loads": [{"element": 1, "kind": "uniform", "wy": -load}]}, [])
    outputs = output_arrays(frame, [{"kind": "axial", "element": 1}] * 3)
    places, heights = np.array([0.2, 0.5, 0.9]), np.array([-0.1, 0.15, 0.2])
    outputs |= {"kind": np.full(3, STRAIN), "vector": np.column_stack([places, heights, [0.0] * 3])}
    factors = np.array([[0.25], [1.0], [3.0]])
    found = condensed(
        (frame.arrays, loads.arrays(), outputs), np.array([0]), NONE, np.ones((3, 1)), factors
    )
    moment = load * places * length * (length - places * length) / 2
    np.testing.assert_allclose(found, -moment * heights / (factors * e * inertia), rtol=1e-11)


def test_what_supports_strain_is_left_to_others() -> None:
    """A member clamped at both ends has no elongation to solve for, but a force when it is warm."""
    structure, loads, outputs = bent_chain(1)
    structure["fixed"][1] = True
    clamped = np.array([0])
    with pytest.raises(DependentTerms):
        Condensation(structure, loads, outputs, clamped, NONE)
    still = loads | {name: loads[name] * 0 for name in ("strain", "prescribed")}
    found = condensed((structure, still, outputs), clamped, NONE, np.eye(3), np.full((3, 1), 0.5))
    half = np.where(np.arange(len(structure["ends"])) == 0, 0.5, 1.0)
    softer = structure | {name: structure[name] * half for name in ("E", "G")}
    expected = _core.respond(softer, still, outputs)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


def test_members_that_determine_each_other_are_refused() -> None:
    structure, loads, outputs = bent_chain(2)
    ring = Condensation(structure, loads, outputs, np.array([0, 1, 2, 6]), NONE)
    with pytest.raises(DependentTerms):
        ring.respond(np.ones((1, len(loads["forces"]))), np.full((1, 4), 2e11))
