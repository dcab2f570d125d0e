"""Laws of linear statics that every structure obeys, on random stable structures."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from random_structures import (
    FORCE,
    MEMBER_LOAD,
    SETTLEMENT,
    STRAIN,
    Answer,
    Arrays,
    Case,
    Floats,
    cases,
    laws,
    lengths,
    loads_on,
)
from rga import _core

PER_MEMBER = {"ends", "frame", "local_y", "connection", "rigid_end", "E", "G", "A"}
PER_MEMBER |= {"Iy", "Iz", "J", "Asy", "Asz"}


def same(one: Floats, other: Floats, *, size: float = 0.0) -> None:
    """Equal but for rounding, against the largest of the values or a size given."""
    largest = max(size, float(np.abs(other).max(initial=0.0)))
    assert np.abs(one - other).max(initial=0.0) <= 1e-8 * largest + 1e-300


def _axes(structure: Arrays, member: int) -> Floats:
    start, end = structure["coordinates"][structure["ends"][member]]
    x = (end - start) / np.linalg.norm(end - start)
    z = np.cross(x, structure["local_y"][member])
    z /= np.linalg.norm(z)
    return np.array([x, np.cross(z, x), z])


def _wrench(at: Floats, force: Floats) -> Floats:
    """Force, and moment about the origin."""
    return np.concatenate([force, np.cross(at, force)])


def applied(case: Case) -> Floats:
    """The sum of all loads: force, and moment about the origin."""
    points = case.structure["coordinates"]
    total = np.zeros(6)
    for at, force in zip(points, case.loads["forces"][0], strict=True):
        total += _wrench(at, force[:3]) + np.concatenate([np.zeros(3), force[3:]])
    for load in zip(*(case.loads[f"member_{key}"] for key in MEMBER_LOAD), strict=True):
        member, axis, low, high, first, last = load
        axes = _axes(case.structure, member)
        if axis >= 3:
            total[3:] += first * axes[axis - 3]
            continue
        size, place = first, low
        if high > low:
            size = (first + last) / 2 * (high - low)
            moment = (high - low) * ((2 * first + last) * low + (first + 2 * last) * high) / 6
            place = moment / size
        start = points[case.structure["ends"][member][0]]
        total += _wrench(start + place * axes[0], size * axes[axis])
    return total


def only(case: Case, **kept: Any) -> Case:
    """The case with nothing but the loads given."""
    empty = {f"member_{key}": case.loads[f"member_{key}"][:0] for key in ("pattern", *MEMBER_LOAD)}
    rest = ("forces", "strain", "prescribed", "prescribed_inclined")
    zeros = {key: np.zeros_like(case.loads[key]) for key in rest}
    return replace(case, loads={**zeros, **empty, **kept})


@laws
@given(cases())
def test_reactions_balance_the_loads(case: Case) -> None:
    answer = case.solve()
    total = applied(case)
    for at, reaction in zip(case.structure["coordinates"], answer.reactions, strict=True):
        total += _wrench(at, reaction[:3]) + np.concatenate([np.zeros(3), reaction[3:]])
    same(total, np.zeros(6), size=max(FORCE, float(np.abs(answer.reactions).max())))


@laws
@given(cases(), st.integers(0, 2**32 - 1))
def test_work_is_mutual(case: Case, seed: int) -> None:
    """Maxwell and Betti: the work of one system on the motions of another, reactions included."""
    other = loads_on(np.random.default_rng(seed), case.structure)
    keys = ("forces", "prescribed", "prescribed_inclined")
    one, two = (only(case, **{key: loads[key] for key in keys}) for loads in (case.loads, other))
    first, second = one.solve(), two.solve()
    forward = (one.loads["forces"][0] + first.reactions) * second.motions
    backward = (two.loads["forces"][0] + second.reactions) * first.motions
    size = float(np.abs(forward).sum() + np.abs(backward).sum())
    same(np.array([forward.sum()]), np.array([backward.sum()]), size=size)


@laws
@given(cases(), st.integers(0, 2**32 - 1), st.floats(-3.0, 3.0))
def test_responses_add_up(case: Case, seed: int, factor: float) -> None:
    other = case.with_loads(**loads_on(np.random.default_rng(seed), case.structure))
    summed = {
        key: case.loads[key] + factor * other.loads[key]
        for key in ("forces", "strain", "prescribed", "prescribed_inclined")
    }
    for key in ("pattern", *MEMBER_LOAD):
        scale = factor if key in ("start", "end") else 1
        both = (case.loads[f"member_{key}"], scale * other.loads[f"member_{key}"])
        summed[f"member_{key}"] = np.concatenate(both)
    first, second, both_at_once = case.solve(), other.solve(), case.with_loads(**summed).solve()
    for name in ("motions", "reactions", "end_forces"):
        parts = getattr(first, name), factor * getattr(second, name)
        size = float(max(np.abs(part).max() for part in parts))
        same(getattr(both_at_once, name), parts[0] + parts[1], size=size)


@laws
@given(cases())
def test_a_rigid_motion_strains_nothing(case: Case) -> None:
    """Supports that move as one body carry the structure along."""
    structure = {**case.structure, "spring_stiffness": 0 * case.structure["spring_stiffness"]}
    shift, turn = SETTLEMENT * np.array([1.0, -0.6, 0.3]), SETTLEMENT * np.array([0.2, 0.5, -0.7])
    moved = shift + np.cross(turn, structure["coordinates"])
    rigid = np.concatenate([moved, np.broadcast_to(turn, moved.shape)], axis=1)
    normals = structure["inclined_direction"]
    normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    inclined = (normals * moved[structure["inclined_node"]]).sum(axis=1)
    case = replace(case, structure=structure)
    case = only(
        case, prescribed=(rigid * structure["fixed"])[None], prescribed_inclined=inclined[None]
    )
    answer = case.solve()
    stiffness = float((structure["E"] * structure["A"] / lengths(structure)).max())
    same(answer.motions[:, :3], moved)
    turning = np.isin(np.arange(case.nodes), structure["ends"][structure["frame"]])
    same(answer.motions[turning, 3:], rigid[turning, 3:])
    for forces in (answer.reactions, answer.end_forces):
        same(forces, np.zeros_like(forces), size=stiffness * float(np.abs(rigid).max()))


@laws
@given(cases())
def test_growing_all_over_strains_nothing(case: Case) -> None:
    """A structure that is warmed all over, gussets too, and whose supports move as it does."""
    structure = {**case.structure, "spring_stiffness": 0 * case.structure["spring_stiffness"]}
    moved = STRAIN * structure["coordinates"]
    grown = np.concatenate([moved, np.zeros_like(moved)], axis=1)
    normals = structure["inclined_direction"]
    normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    inclined = (normals * moved[structure["inclined_node"]]).sum(axis=1)
    strain = np.zeros((1, case.members, 3))
    strain[..., 0] = STRAIN
    case = only(
        replace(case, structure=structure),
        strain=strain,
        prescribed=(grown * structure["fixed"])[None],
        prescribed_inclined=inclined[None],
    )
    answer = case.solve()
    stiffness = float((structure["E"] * structure["A"]).max())
    same(answer.motions[:, :3], moved)
    for forces in (answer.reactions, answer.end_forces):
        same(forces, np.zeros_like(forces), size=stiffness * STRAIN)


@laws
@given(cases(), st.tuples(*[st.floats(-np.pi, np.pi)] * 3))
def test_turning_all_turns_the_answer(case: Case, angles: tuple[float, float, float]) -> None:
    turn: Floats = Rotation.from_euler("xyz", angles).as_matrix()

    def turned(values: Floats) -> Floats:
        """Vectors of three, or forces and moments of six."""
        parts = values.reshape(*values.shape[:-1], values.shape[-1] // 3, 3)
        return (parts @ turn.T).reshape(values.shape)

    vectors = ("coordinates", "local_y", "inclined_direction")
    structure = {**case.structure, **{key: turned(case.structure[key]) for key in vectors}}
    loads = {key: turned(case.loads[key]) for key in ("forces", "prescribed")}
    answer, other = case.solve(), Case(structure, {**case.loads, **loads}).solve()
    same(other.motions, turned(answer.motions))
    same(other.reactions, turned(answer.reactions))
    same(other.end_forces, answer.end_forces)


@laws
@given(cases(), st.floats(1e-3, 1e3))
def test_stiffness_and_loads_scale_together(case: Case, factor: float) -> None:
    stiff = ("E", "G", "spring_stiffness", "connection")
    structure = {**case.structure, **{key: factor * case.structure[key] for key in stiff}}
    forces = ("forces", "member_start", "member_end")
    loads = {key: factor * case.loads[key] for key in forces}
    answer, other = case.solve(), Case(structure, {**case.loads, **loads}).solve()
    same(other.motions, answer.motions)
    same(other.reactions, factor * answer.reactions)
    same(other.end_forces, factor * answer.end_forces)


@laws
@given(cases(), st.randoms(use_true_random=False))
def test_numbering_does_not_matter(case: Case, random: Any) -> None:
    order = random.sample(range(case.nodes), case.nodes)
    place = np.argsort(order)
    structure = {
        **case.structure,
        "coordinates": case.structure["coordinates"][order],
        "fixed": case.structure["fixed"][order],
        "ends": place[case.structure["ends"]],
        "inclined_node": place[case.structure["inclined_node"]],
        "spring_node": case.structure["spring_node"].copy(),
    }
    structure["spring_node"][:, 0] = place[case.structure["spring_node"][:, 0]]
    loads = {key: case.loads[key][:, order] for key in ("forces", "prescribed")}
    answer, other = case.solve(), Case(structure, {**case.loads, **loads}).solve()
    same(other.motions, answer.motions[order])
    same(other.reactions, answer.reactions[order])
    same(other.end_forces, answer.end_forces)


@laws
@given(cases(kinds=("frame", "mixed")), st.floats(0.1, 0.9))
def test_a_node_in_a_member_changes_nothing(case: Case, share: float) -> None:
    """Beam elements are exact: the first member, in two elements, bends as before."""
    structure = {
        **case.structure,
        "connection": np.full((case.members, 12), np.inf),
        "rigid_end": np.zeros((case.members, 2)),
    }
    start, end = structure["ends"][0]
    new, cut = case.nodes, share * lengths(structure)[0]
    points = structure["coordinates"]
    split = {
        key: np.concatenate([array, array[:1]])
        for key, array in structure.items()
        if key in PER_MEMBER
    }
    split["ends"][[0, -1]] = [[start, new], [new, end]]
    middle = points[start] + share * (points[end] - points[start])
    split["coordinates"] = np.vstack([points, middle])
    split["fixed"] = np.vstack([structure["fixed"], np.zeros((1, 6), dtype=bool)])

    def bent(structure: Arrays, spans: dict[int, float]) -> Answer:
        """Under forces at the old nodes, and a load and a gradient along the member."""
        nodes, members = len(structure["coordinates"]), len(structure["ends"])
        loads = only(case).loads
        strain = np.zeros((1, members, 3))
        strain[0, list(spans)] = STRAIN * np.array([1.0, -2.0, 0.5])
        forces = np.zeros((1, nodes, 6))
        forces[:, : case.nodes] = case.loads["forces"]
        along = {
            "member_pattern": np.zeros(len(spans), dtype=np.int64),
            "member_index": np.array(list(spans)),
            "member_axis": np.ones(len(spans), dtype=np.int64),
            "member_from": np.zeros(len(spans)),
            "member_to": np.array(list(spans.values())),
            "member_start": np.full(len(spans), FORCE),
            "member_end": np.full(len(spans), FORCE),
        }
        changed = {"forces": forces, "strain": strain, "prescribed": np.zeros((1, nodes, 6))}
        return Case(structure, {**loads, **changed, **along}).solve()

    whole = bent(structure, {0: cut / share})
    parts = bent({**structure, **split}, {0: cut, case.members: cut / share - cut})
    same(parts.motions[:-1], whole.motions)
    joined = parts.end_forces[:-1].copy()
    joined[0, 6:] = parts.end_forces[-1, 6:]
    same(joined, whole.end_forces)


def chain(count: int, along: Floats, hinged: bool) -> Case:
    """A cantilever of frame members in a row, slender and askew, loaded across at its end."""
    random = np.random.default_rng(100)
    nodes, x = count + 1, along / np.linalg.norm(along)
    across = np.cross(x, random.normal(size=3))
    across /= np.linalg.norm(across)
    connection = np.full((count, 12), np.inf)
    if hinged:
        connection[-1, 5] = 0.0
    fixed = np.zeros((nodes, 6), dtype=bool)
    fixed[0] = True
    every: Arrays = {key: np.full(count, 1.0) for key in ("E", "G", "A", "Iy", "Iz", "J")}
    structure: Arrays = {
        "coordinates": np.linspace(0.0, 10.0, nodes)[:, None] * x,
        "ends": np.stack([np.arange(count), np.arange(1, nodes)], axis=1),
        "frame": np.ones(count, dtype=bool),
        "local_y": np.tile(across, (count, 1)),
        "connection": connection,
        "rigid_end": np.zeros((count, 2)),
        "fixed": fixed,
        "inclined_node": np.zeros(0, dtype=np.int64),
        "inclined_direction": np.zeros((0, 3)),
        "spring_node": np.zeros((0, 2), dtype=np.int64),
        "spring_dof": np.zeros(0, dtype=np.int64),
        "spring_stiffness": np.zeros(0),
        "tie_node": np.zeros((0, 2), dtype=np.int64),
        "tie_dof": np.zeros(0, dtype=np.int64),
        **every,
        "Asy": np.full(count, np.inf),
        "Asz": np.full(count, np.inf),
    }
    # A round bar of 0.01 m over a length of 10 m.
    structure["E"] *= 2e11
    structure["G"] *= 8e10
    structure["A"] *= 7.85e-5
    for key, size in (("Iy", 4.9e-10), ("Iz", 4.9e-10), ("J", 9.8e-10)):
        structure[key] *= size
    forces = np.zeros((1, nodes, 6))
    forces[0, -1, :3] = 0.1 * across
    none = np.zeros(0)
    loads: Arrays = {
        "forces": forces,
        "strain": np.zeros((1, count, 3)),
        "prescribed": np.zeros((1, nodes, 6)),
        "prescribed_inclined": np.zeros((1, 0)),
        **{f"member_{key}": none.astype(np.int64) for key in ("pattern", "index", "axis")},
        **{f"member_{key}": none for key in MEMBER_LOAD[2:]},
    }
    return Case(structure, loads)


@pytest.mark.parametrize("seed", range(12))
def test_what_bends_much_stands_and_a_hinge_in_it_does_not(seed: int) -> None:
    along = np.random.default_rng(seed).normal(size=3)
    for count in (1, 8, 300):
        soft = chain(count, along, hinged=False)
        tip = np.linalg.norm(soft.solve().motions[-1, :3])
        # The condition of a chain grows with the fourth power of its members.
        exact = 0.1 * 10.0**3 / (3 * 2e11 * 4.9e-10)
        assert abs(tip - exact) <= 1e-5 * exact
        with pytest.raises(_core.UnstableStructure):
            chain(count, along, hinged=True).solve()


@pytest.mark.parametrize("released", [[4], [5], [4, 5], [3, 4, 5]])
def test_a_release_askew_turns_with_all(released: list[int]) -> None:
    """A rotation that nothing stiffens is held about any axis, and a moment about it is refused."""
    steady = chain(1, np.array([1.0, 0.0, 0.0]), hinged=False)
    structure = {**steady.structure, "coordinates": np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0.0],
                                                              [7, 0, 0], [4, 0, 3.0]])}  # fmt: skip
    structure["ends"] = np.array([[0, 1], [2, 1], [3, 1], [4, 1]])
    structure["frame"] = np.array([True, False, False, False])
    structure["fixed"] = np.zeros((5, 6), dtype=bool)
    structure["fixed"][[0, 2, 3, 4]] = True
    for name in PER_MEMBER - {"ends", "frame"}:
        structure[name] = np.repeat(steady.structure[name], 4, axis=0)
    structure["connection"][0, [6 + dof for dof in released]] = 0.0
    loads = {name: np.zeros((1, 5, 6)) for name in ("forces", "prescribed")}
    loads |= {"strain": np.zeros((1, 4, 3)), "prescribed_inclined": np.zeros((1, 0))}
    loads |= {key: array for key, array in steady.loads.items() if key.startswith("member_")}
    loads["forces"][0, 1, :3] = [3e3, -2e3, 1e3]
    straight = Case(structure, loads)
    turn = Rotation.from_euler("zyx", [0.5, 0.3, -0.7]).as_matrix()
    turned = Case(
        {
            **structure,
            "coordinates": structure["coordinates"] @ turn.T,
            "local_y": structure["local_y"] @ turn.T,
        },
        {**loads, "forces": (loads["forces"].reshape(1, 5, 2, 3) @ turn.T).reshape(1, 5, 6)},
    )
    one, other = straight.solve(), turned.solve()
    same(other.end_forces, one.end_forces)
    same(other.motions[:, :3], one.motions[:, :3] @ turn.T)
    outputs = {
        "kind": np.zeros(3, np.int64), "index": np.ones(3, np.int64), "vector": np.eye(3),
        "other": np.full(3, -1), "total": np.zeros(3, bool),
    }  # fmt: skip
    every = _core.Refactored(turned.structure, turned.loads, outputs)
    same(every.respond(np.ones((1, 4)), np.ones((1, 1)))[0], other.motions[1, :3])
    moment = np.zeros(6)
    moment[3:] = 1e3 * turn[:, released[0] - 3]
    forces = turned.loads["forces"].copy()
    forces[0, 1] += moment
    with pytest.raises(_core.InvalidInput, match="moment"):
        turned.with_loads(forces=forces).solve()
