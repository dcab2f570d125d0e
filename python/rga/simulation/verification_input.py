"""Verification cases as arrays of the finite-element core."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga._core import OutputKind
from rga.arrays import LoadArrays, OutputArrays, StructureArrays

Floats = NDArray[np.float64]
Json = Mapping[str, Any]

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
FORCES = ("fx", "fy", "fz", "mx", "my", "mz")
OUT_OF_PLANE = [2, 3, 4]
#: along and about an axis
BY_AXIS = {
    "displacement": (OutputKind.DISPLACEMENT, OutputKind.ROTATION),
    "reaction": (OutputKind.REACTION_FORCE, OutputKind.REACTION_MOMENT),
}


@dataclass(frozen=True)
class FrameCase:
    """The structure of a case, with the names that its loads and outputs use."""

    arrays: StructureArrays
    nodes: dict[str, int]
    members: dict[str, int]

    @classmethod
    def read(cls, case: Json) -> "FrameCase":
        plane = case["dim"] == 2
        elements = case["elements"]
        nodes = {str(name): index for index, name in enumerate(case["nodes"])}
        members = {str(element["id"]): index for index, element in enumerate(elements)}
        supports = case.get("inclined_supports") or []
        springs = case.get("springs") or []
        ties = _ties(case.get("ties") or [], nodes)
        arrays: StructureArrays = {
            "coordinates": np.array([point(p) for p in case["nodes"].values()]),
            "ends": np.array(
                [[nodes[str(n)] for n in e["nodes"]] for e in elements], dtype=np.int64
            ).reshape(-1, 2),
            "frame": np.array([e["type"] == "beam" for e in elements], dtype=bool),
            "local_y": np.array([point(e.get("local_y", [math.nan] * 3)) for e in elements]),
            "connection": np.full((len(elements), 12), math.inf),
            "rigid_end": np.zeros((len(elements), 2)),
            "fixed": _fixed(case, nodes, plane),
            "inclined_node": np.array([nodes[str(s["node"])] for s in supports], dtype=np.int64),
            "inclined_direction": np.array(
                [point(s["direction"]) for s in supports], dtype=np.float64
            ).reshape(-1, 3),
            "E": _section(elements, "E", plane),
            "G": _section(elements, "G", plane),
            "A": _section(elements, "A", plane),
            "Iy": _section(elements, "Iy", plane),
            "Iz": _section(elements, "Iz", plane),
            "J": _section(elements, "J", plane),
            "Asy": _section(elements, "Asy", plane),
            "Asz": _section(elements, "Asz", plane),
            "spring_node": np.array(
                [_spring_ends(spring, nodes) for spring in springs], dtype=np.int64
            ).reshape(-1, 2),
            "spring_dof": np.array([DOFS.index(s["dof"]) for s in springs], dtype=np.int64),
            "spring_stiffness": np.array([float(s["k"]) for s in springs]),
            "tie_node": ties[:, :2].copy(),
            "tie_dof": ties[:, 2].copy(),
        }
        return cls(arrays, nodes, members)

    def axes(self, member: int) -> Floats:
        """Local axes in the rows, by the rule of the core."""
        start, end = self.arrays["coordinates"][self.arrays["ends"][member]]
        x = (end - start) / np.linalg.norm(end - start)
        y = self.arrays["local_y"][member]
        if np.isnan(y).any():
            y = np.array([-x[1], x[0], 0.0])
            y = y if np.linalg.norm(y) > 1e-9 else np.array([0.0, 1.0, 0.0])
        z = np.cross(x, y)
        z /= np.linalg.norm(z)
        return np.array([x, np.cross(z, x), z])

    def length(self, member: int) -> float:
        start, end = self.arrays["coordinates"][self.arrays["ends"][member]]
        return float(np.linalg.norm(end - start))


class Loads:
    """Load arrays of the core under construction."""

    def __init__(self, frame: FrameCase, patterns: int) -> None:
        nodes, members = len(frame.nodes), len(frame.members)
        self.frame = frame
        self.forces = np.zeros((patterns, nodes, 6))
        self.strain = np.zeros((patterns, members, 3))
        self.prescribed = np.zeros((patterns, nodes, 6))
        self.inclined = np.zeros((patterns, len(frame.arrays["inclined_node"])))
        self.member_loads: list[tuple[int, int, float, float, float, float]] = []

    def add(self, load_case: Json, inclined_supports: Sequence[Json]) -> None:
        """Adds a load case to the first pattern."""
        nodes = self.frame.nodes
        for load in load_case.get("nodal_loads") or []:
            node = nodes[str(load["node"])]
            self.forces[0, node] += [load.get(key, 0.0) for key in FORCES]
        for load in load_case.get("element_loads") or []:
            self._add_element_load(load)
        for entry in load_case.get("prescribed") or []:
            dof = DOFS.index(entry["dof"])
            self.prescribed[0, nodes[str(entry["node"])], dof] = entry["value"]
        for entry in load_case.get("prescribed_inclined") or []:
            for index, support in enumerate(inclined_supports):
                if str(support["node"]) == str(entry["node"]):
                    self.inclined[0, index] = entry["value"]

    def _add_element_load(self, load: Json) -> None:
        member = self.frame.members[str(load["element"])]
        length = self.frame.length(member)
        match load["kind"]:
            case "uniform":
                local = [load.get(key, 0.0) for key in ("wx", "wy", "wz")]
                if "w_global" in load:
                    local = local + self.frame.axes(member) @ point(load["w_global"])
                for axis, w in enumerate(local):
                    self._spread(member, axis, 0.0, length, w, w)
            case "trapezoid":
                axis = _axis(load["axis"])
                self._spread(member, axis, load["x1"], load["x2"], load["w1"], load["w2"])
            case "point":
                for axis, key in enumerate(("Px", "Py", "Pz", "Mx", "My", "Mz")):
                    size = load.get(key, 0.0)
                    self._spread(member, axis, load["x"], load["x"], size, size)
            case "thermal":
                kelvin = [load.get(key, 0.0) for key in ("dT", "grad_y", "grad_z")]
                self.strain[0, member] += load["alpha"] * np.array(kelvin)
            case "initial_elongation":
                self.strain[0, member, 0] += _elongation(load) / length
            case kind:
                raise KeyError(f"element load kind {kind!r}")

    def _spread(
        self, member: int, axis: int, start: float, end: float, first: float, last: float
    ) -> None:
        if first != 0.0 or last != 0.0:
            self.member_loads.append((member, axis, start, end, first, last))

    def sizes(self) -> dict[str, float]:
        """The largest forces and motions that the first pattern could cause if nothing evened
        out."""
        structure = self.frame.arrays
        lengths = np.array([self.frame.length(member) for member in self.frame.members.values()])
        stiffness = structure["E"] * structure["A"] / lengths
        spread = [
            max(abs(first), abs(last)) * ((end - start) or 1.0)
            for _, _, start, end, first, last in self.member_loads
        ]
        moved = max(np.abs(self.prescribed).max(), np.abs(self.inclined).max(initial=0.0))
        thermal = [
            self.strain[0, :, 0] * stiffness * lengths,
            self.strain[0, :, 1] * structure["E"] * structure["Iz"] / lengths,
            self.strain[0, :, 2] * structure["E"] * structure["Iy"] / lengths,
        ]
        force = max(
            float(np.abs(self.forces).max()),
            float(np.abs(thermal).max()),
            float(np.max(spread, initial=0.0)),
            float(moved * stiffness.max()),
        )
        size = float(np.linalg.norm(np.ptp(structure["coordinates"], axis=0)))
        motion = max(float(moved), force / float(stiffness.min()))
        return {
            "force": force,
            "moment": force * size,
            "displacement": motion,
            "rotation": motion / size,
        }

    def arrays(self) -> LoadArrays:
        columns = np.array(self.member_loads, dtype=np.float64).reshape(-1, 6).T.copy()
        return {
            "forces": self.forces,
            "strain": self.strain,
            "prescribed": self.prescribed,
            "prescribed_inclined": self.inclined,
            "member_pattern": np.zeros(columns.shape[1], dtype=np.int64),
            "member_index": columns[0].astype(np.int64),
            "member_axis": columns[1].astype(np.int64),
            "member_from": columns[2],
            "member_to": columns[3],
            "member_start": columns[4],
            "member_end": columns[5],
        }


def _elongation(load: Json) -> float:
    """The one number of the load: the format does not name it."""
    given = {key: value for key, value in load.items() if key not in ("element", "kind", "note")}
    if len(given) != 1:
        raise KeyError(f"initial_elongation must have one value, not {sorted(given)}")
    return float(next(iter(given.values())))


def _axis(name: str | int) -> int:
    """Of "y", "wy", 1 and the like."""
    return name if isinstance(name, int) else "xyz".index(name[-1])


def point(values: Iterable[float]) -> Floats:
    """Three components of two or three."""
    given = [float(value) for value in values]
    return np.array([*given, 0.0, 0.0, 0.0][:3])


def _fixed(case: Json, nodes: Mapping[str, int], plane: bool) -> NDArray[np.bool_]:
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    if plane:
        fixed[:, OUT_OF_PLANE] = True
    for support in case["supports"]:
        fixed[nodes[str(support["node"])], [DOFS.index(dof) for dof in support["dofs"]]] = True
    # A prescribed displacement is a support, whether listed among the supports or not.
    for load_case in case.get("load_cases") or []:
        for entry in load_case.get("prescribed") or []:
            fixed[nodes[str(entry["node"])], DOFS.index(entry["dof"])] = True
    return fixed


def _section(elements: Sequence[Json], key: str, plane: bool) -> Floats:
    def value(element: Json) -> float:
        if key in element:
            return float(element[key])
        if element["type"] == "truss" and key not in ("E", "A"):
            return 0.0
        if key in ("Asy", "Asz"):
            return math.inf
        sheared = "Asy" in element or "Asz" in element
        if plane and key in ("Iy", "J", "G") and not (key == "G" and sheared):
            return 1.0  # only stiffens what a plane model holds
        raise KeyError(f"element {element['id']} lacks {key}")

    return np.array([value(element) for element in elements])


def _spring_ends(spring: Json, nodes: Mapping[str, int]) -> list[int]:
    if "nodes" in spring:
        return [nodes[str(node)] for node in spring["nodes"]]
    return [nodes[str(spring["node"])], -1]


def _ties(ties: Sequence[Json], nodes: Mapping[str, int]) -> NDArray[np.int64]:
    """Two nodes and a dof of each, int[ties, 3]."""
    pairs = [
        (nodes[str(tie["nodes"][0])], nodes[str(other)], DOFS.index(dof))
        for tie in ties
        for other in tie["nodes"][1:]
        for dof in (tie["dofs"] if "dofs" in tie else [tie["dof"]])
    ]
    return np.array(pairs, dtype=np.int64).reshape(-1, 3)


def output_arrays(frame: FrameCase, entries: Sequence[Json]) -> OutputArrays:
    rows = [_output(frame, entry) for entry in entries]
    return {
        "kind": np.array([row[0] for row in rows], dtype=np.int64),
        "index": np.array([row[1] for row in rows], dtype=np.int64),
        "other": np.array([row[2] for row in rows], dtype=np.int64),
        "vector": np.array([row[3] for row in rows], dtype=np.float64).reshape(-1, 3),
        "total": np.zeros(len(rows), dtype=bool),
    }


def _output(frame: FrameCase, entry: Json) -> tuple[int, int, int, Sequence[float]]:
    match entry["kind"]:
        case "displacement" | "reaction" as kind:
            turning, axis = divmod(DOFS.index(entry["dof"]), 3)
            node, along = frame.nodes[str(entry["node"])], np.eye(3)[axis].tolist()
            return BY_AXIS[kind][turning], node, -1, along
        case "axial":
            # Where a load along the member makes it vary, the format means the second end.
            return (
                OutputKind.SECTION_FORCE,
                frame.members[str(entry["element"])],
                0,
                [1.0, 0.0, 0.0],
            )
        case "end_force":
            member = frame.members[str(entry["element"])]
            return OutputKind.END_FORCE, member, int(entry["index"]), [0.0] * 3
        case kind:
            raise KeyError(f"expected kind {kind!r}")
