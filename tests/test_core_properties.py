"""Laws of linear statics that every structure obeys, on random stable structures."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from rga import _core

Floats = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]

FORCE, STRAIN, SETTLEMENT = 1e4, 2e-4, 2e-3
PER_MEMBER = {"ends", "frame", "local_y", "connection", "rigid_end", "E", "G", "A"}
PER_MEMBER |= {"Iy", "Iz", "J", "Asy", "Asz"}
MEMBER_LOAD = ("index", "axis", "from", "to", "start", "end")
laws = settings(max_examples=120, derandomize=True, deadline=None)
"""The same examples in every run."""


@dataclass(frozen=True)
class Case:
    """A structure with one load pattern, as arrays of the core."""

    structure: Arrays
    loads: Arrays

    @property
    def nodes(self) -> int:
        return len(self.structure["coordinates"])

    @property
    def members(self) -> int:
        return len(self.structure["ends"])

    def with_loads(self, **changed: Any) -> "Case":
        return replace(self, loads={**self.loads, **changed})

    def solve(self) -> "Answer":
        """Motions and reactions of every node, end forces of every member."""
        corners = [
            (kind, index, -1, direction)
            for kind in (0, 1, 4, 5)
            for index in range(self.nodes)
            for direction in np.eye(3)
        ]
        ends = [(6, index, dof, np.zeros(3)) for index in range(self.members) for dof in range(12)]
        kind, index, other, vector = zip(*corners, *ends, strict=True)
        outputs: Arrays = {
            "kind": np.array(kind),
            "index": np.array(index),
            "other": np.array(other),
            "vector": np.array(vector),
            "total": np.zeros(len(kind), dtype=bool),
        }
        values = _core.respond(self.structure, self.loads, outputs)[0]
        nodal = values[: 12 * self.nodes].reshape(4, self.nodes, 3)
        return Answer(
            np.concatenate([nodal[0], nodal[1]], axis=1),
            np.concatenate([nodal[2], nodal[3]], axis=1),
            values[12 * self.nodes :].reshape(self.members, 12),
        )


@dataclass(frozen=True)
class Answer:
    """Motions and reactions [nodes, 6] in global axes, end forces [members, 12] in local ones."""

    motions: Floats
    reactions: Floats
    end_forces: Floats


def same(one: Floats, other: Floats, *, size: float = 0.0) -> None:
    """Equal but for rounding, against the largest of the values or a size given."""
    largest = max(size, float(np.abs(other).max(initial=0.0)))
    assert np.abs(one - other).max(initial=0.0) <= 1e-8 * largest + 1e-300


@st.composite
def cases(draw: st.DrawFn, *, kinds: tuple[str, ...] = ("truss", "frame", "mixed")) -> Case:
    """A structure that stands: clamped nodes, and each further node joined to earlier ones.

    A truss node hangs on three earlier nodes that are not near one plane with it; a frame node on
    one, by a member that bends; a mixed structure is a frame with trusses between its nodes.
    """
    kind = draw(st.sampled_from(kinds))
    free = draw(st.integers(1, 5))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    held = 3 if kind == "truss" else draw(st.integers(1, 3))
    points = _points(random, held + free)
    ends, frame = _members(kind, points, held)
    structure = _structure(random, points, ends, frame, held)
    if draw(st.booleans()):
        _support_more(random, structure, held)
    return Case(structure, _loads(random, structure))


def _points(random: np.random.Generator, count: int) -> Floats:
    """Points that keep apart."""
    points = [random.uniform(-4.0, 4.0, 3)]
    while len(points) < count:
        point = random.uniform(-4.0, 4.0, 3)
        if min(np.linalg.norm(point - other) for other in points) > 2.0:
            points.append(point)
    return np.array(points)


def _members(kind: str, points: Floats, held: int) -> tuple[list[tuple[int, int]], list[bool]]:
    ends: list[tuple[int, int]] = []
    frame: list[bool] = []
    for node in range(held, len(points)):
        near = np.argsort(np.linalg.norm(points[:node] - points[node], axis=1))
        if kind == "truss":
            chosen = _far_from_one_plane(points, node)
            ends += [(int(other), node) for other in chosen]
            frame += [False] * 3
            continue
        ends.append((int(near[0]), node))
        frame.append(True)
        if kind == "mixed" and len(near) > 1:
            ends.append((node, int(near[-1])))
            frame.append(False)
    if kind == "frame" and len(points) > held + 1:
        ends.append((held, len(points) - 1))
        frame.append(True)
    return ends, frame


def _far_from_one_plane(points: Floats, node: int) -> tuple[int, int, int]:
    """The three earlier nodes that hold the node best."""
    directions = points[:node] - points[node]
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    threes = [(a, b, c) for a in range(node) for b in range(a) for c in range(b)]
    return max(threes, key=lambda three: abs(np.linalg.det(directions[list(three)])))


def _structure(
    random: np.random.Generator,
    points: Floats,
    ends: list[tuple[int, int]],
    frame: list[bool],
    held: int,
) -> Arrays:
    nodes, members = len(points), len(ends)

    def between(low: float, high: float) -> Floats:
        return random.uniform(low, high, members)

    fixed = np.zeros((nodes, 6), dtype=bool)
    fixed[:held] = True
    connection = np.full((members, 12), np.inf)
    connection[random.random(members) < 0.3, 4] = 2e6
    connection[random.random(members) < 0.3, 11] = 5e5
    if frame[-1] and members > nodes - held:
        connection[-1, [5, 10]] = 0.0  # hinges, in the member that closes a loop
    rigid = random.uniform(0.0, 0.3, (members, 2)) * (random.random((members, 1)) < 0.3)
    return {
        "coordinates": points,
        "ends": np.array(ends, dtype=np.int64),
        "frame": np.array(frame),
        "local_y": random.normal(size=(members, 3)),
        "connection": connection,
        "rigid_end": rigid,
        "fixed": fixed,
        "inclined_node": np.zeros(0, dtype=np.int64),
        "inclined_direction": np.zeros((0, 3)),
        "spring_node": np.zeros((0, 2), dtype=np.int64),
        "spring_dof": np.zeros(0, dtype=np.int64),
        "spring_stiffness": np.zeros(0),
        "tie_node": np.zeros((0, 2), dtype=np.int64),
        "tie_dof": np.zeros(0, dtype=np.int64),
        "E": between(0.7e11, 2.1e11),
        "G": between(0.3e11, 0.8e11),
        "A": between(2e-3, 1e-2),
        "Iy": between(1e-5, 1e-4),
        "Iz": between(1e-5, 1e-4),
        "J": between(1e-6, 1e-4),
        "Asy": np.where(random.random(members) < 0.5, np.inf, between(1e-3, 5e-3)),
        "Asz": np.where(random.random(members) < 0.5, np.inf, between(1e-3, 5e-3)),
    }


def _support_more(random: np.random.Generator, structure: Arrays, held: int) -> None:
    """A roller on a plane at the first free node, and an even spring to the ground at the last."""
    last = len(structure["coordinates"]) - 1
    structure["inclined_node"] = np.array([held])
    structure["inclined_direction"] = random.normal(size=(1, 3))
    structure["spring_node"] = np.array([[last, -1]] * 3)
    structure["spring_dof"] = np.arange(3)
    structure["spring_stiffness"] = np.full(3, random.uniform(1e5, 1e7))


def _loads(random: np.random.Generator, structure: Arrays) -> Arrays:
    """Forces, temperatures and settlements everywhere, and four loads on each member."""
    fixed, frame = structure["fixed"], structure["frame"]
    nodes, members, inclined = len(fixed), len(frame), len(structure["inclined_node"])
    forces = FORCE * random.normal(size=(1, nodes, 6))
    turning = np.isin(np.arange(nodes), structure["ends"][frame])
    forces[0, ~turning, 3:] = 0.0  # nothing resists a moment there
    strain = STRAIN * random.normal(size=(1, members, 3))
    strain[0, :, 1:] *= frame[:, None]
    spread: list[tuple[float, ...]] = []
    for member, length in enumerate(_lengths(structure)):
        low, high = np.sort(random.uniform(0.0, length, 2))
        sizes = FORCE * random.normal(size=(4, 2))
        spread += [(member, axis, low, high, *sizes[axis]) for axis in (0, 1, 2)]
        axis = int(random.integers(0, 6 if frame[member] else 3))
        spread.append((member, axis, high, high, *sizes[3]))
    columns = np.array(spread).T.copy()
    return {
        "forces": forces,
        "strain": strain,
        "prescribed": SETTLEMENT * random.normal(size=(1, nodes, 6)) * fixed,
        "prescribed_inclined": SETTLEMENT * random.normal(size=(1, inclined)),
        "member_pattern": np.zeros(len(spread), dtype=np.int64),
        "member_index": columns[0].astype(np.int64),
        "member_axis": columns[1].astype(np.int64),
        **{f"member_{key}": columns[2 + k] for k, key in enumerate(MEMBER_LOAD[2:])},
    }


def _lengths(structure: Arrays) -> Floats:
    along = np.diff(structure["coordinates"][structure["ends"]], axis=1)[:, 0]
    return np.asarray(np.linalg.norm(along, axis=1))


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
    other = _loads(np.random.default_rng(seed), case.structure)
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
    other = case.with_loads(**_loads(np.random.default_rng(seed), case.structure))
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
    stiffness = float((structure["E"] * structure["A"] / _lengths(structure)).max())
    same(answer.motions[:, :3], moved)
    turning = np.isin(np.arange(case.nodes), structure["ends"][structure["frame"]])
    same(answer.motions[turning, 3:], rigid[turning, 3:])
    for forces in (answer.reactions, answer.end_forces):
        same(forces, np.zeros_like(forces), size=stiffness * float(np.abs(rigid).max()))


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
    new, cut = case.nodes, share * _lengths(structure)[0]
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
