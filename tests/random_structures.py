"""Random structures that stand, with one load pattern, as arrays of the core."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from rga import _core

Floats = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]

FORCE, STRAIN, SETTLEMENT = 1e4, 2e-4, 2e-3
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
    return Case(structure, loads_on(random, structure))


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


def loads_on(random: np.random.Generator, structure: Arrays) -> Arrays:
    """Forces, temperatures and settlements everywhere, and four loads on each member."""
    fixed, frame = structure["fixed"], structure["frame"]
    nodes, members, inclined = len(fixed), len(frame), len(structure["inclined_node"])
    forces = FORCE * random.normal(size=(1, nodes, 6))
    turning = np.isin(np.arange(nodes), structure["ends"][frame])
    forces[0, ~turning, 3:] = 0.0  # nothing resists a moment there
    strain = STRAIN * random.normal(size=(1, members, 3))
    strain[0, :, 1:] *= frame[:, None]
    spread: list[tuple[float, ...]] = []
    for member, length in enumerate(lengths(structure)):
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


def lengths(structure: Arrays) -> Floats:
    """Of the members [m]."""
    along = np.diff(structure["coordinates"][structure["ends"]], axis=1)[:, 0]
    return np.asarray(np.linalg.norm(along, axis=1))
