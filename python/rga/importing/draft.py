"""A model in the making, in SI units."""

from collections.abc import Collection, Mapping, Sequence, Sized
from math import dist
from typing import Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.importing.notes import Acceptance, ImportRefused, Notes
from rga.importing.stability import free_motions
from rga.model import Model, read_model
from rga.model.axes import member_axes
from rga.model.references import SHORTEST
from rga.model.schema import DOFS

#: axes of a source whose y points up, in axes whose z does: a quarter turn about x
TURNED = {"ux": "ux", "uy": "uz", "uz": "uy", "rx": "rx", "ry": "rz", "rz": "ry"}
#: share of a member's length by which a node may lie off its line, or a load beyond an end
NEAR = 1e-9
#: coordinate that no structure has [m]
FARTHEST = 1e9
Shape = tuple[str, tuple[float, ...]]


class ModelDraft:
    """Parts of a model as a reader finds them; it turns their axes and knows no unit but SI.

    Args:
        name: of the model.
        accept: what the user accepts.
        up: the axis of the source that points up; z in rga. Where it is y, (x, y, z) becomes
            (x, -z, y), and so do forces, moments and axes of members.
        plane: of a plane model, in rga's axes; None: one in space.
    """

    def __init__(
        self,
        name: str,
        accept: Collection[Acceptance] = (),
        up: Literal["y", "z"] = "z",
        plane: str | None = None,
    ) -> None:
        self.notes = Notes(accept)
        self.up, self.plane, self.name = up, plane, name
        self.nodes: dict[str, list[float]] = {}
        self.materials: dict[str, dict[str, float]] = {}
        self.sections: dict[str, dict[str, float]] = {}
        self.members: dict[str, dict[str, Any]] = {}
        self.supports: dict[str, dict[str, Any]] = {}
        self.springs: list[dict[str, Any]] = []
        self.ties: list[dict[str, Any]] = []
        self.masses: dict[str, dict[str, Any]] = {}
        self._forces: dict[str, dict[str, list[float]]] = {}
        self._on_members: dict[str, dict[Shape, list[str]]] = {}
        self._settlements: list[dict[str, Any]] = []
        self._factors: dict[str, float] = {}
        self.frames = self.cut_frames = 0

    def vector(self, components: Sequence[float]) -> list[float]:
        """A vector of the source in the model's axes."""
        x, y, z = (float(value) for value in components)
        # A zero has no sign: 0.0 - z.
        return [x, 0.0 - z, y] if self.up == "y" else [x, y, z]

    def unturned(self, components: Sequence[float]) -> list[float]:
        """A vector of the model in the source's axes."""
        x, y, z = components
        return [x, z, 0.0 - y] if self.up == "y" else [x, y, z]

    def dof(self, name: str) -> str:
        """A degree of freedom of the source's axes in the model's."""
        return TURNED[name] if self.up == "y" else name

    def add_node(self, name: str, place: Sequence[float], where: str) -> None:
        """Add a node [m].

        Raises:
            InputError: there is one of this name, or it is farther away than any structure is.
        """
        if name in self.nodes:
            raise InputError(f"node {name!r} is there already", where, "give it another name")
        if not all(abs(value) <= FARTHEST for value in place):
            what = f"node {name!r} is at {', '.join(f'{value:.3g}' for value in place)} m"
            raise InputError(what, where, "correct it, or the unit of length")
        self.nodes[name] = self.vector(place)

    def has_length(self, first: str, last: str) -> bool:
        """Whether two nodes are far enough apart for a member of a model."""
        return dist(self.nodes[first], self.nodes[last]) >= SHORTEST

    def material(self, label: str, **properties: float) -> str:
        """The name of a material with these properties, added where there was none."""
        return _named(self.materials, label, properties)

    def section(self, label: str, **properties: float) -> str:
        """The name of a section with these properties, added where there was none."""
        return _named(self.sections, label, properties)

    def add_member(
        self,
        name: str,
        nodes: tuple[str, str],
        section: str,
        material: str,
        where: str,
        *,
        kind: Literal["truss", "frame"] = "frame",
        local_y: Sequence[float] | None = None,
        releases: Mapping[str, list[str]] | None = None,
        end_springs: Mapping[str, dict[str, float]] | None = None,
        groups: Sequence[str] = (),
    ) -> bool:
        """Add a member, and say whether it could be.

        Raises:
            InputError: there is one of this name, or no node of a name.
        """
        if name in self.members:
            raise InputError(f"member {name!r} is there already", where, "give it another name")
        for node in nodes:
            self._known(node, f"member {name!r}", where)
        if not self.has_length(*nodes):
            self.notes.refuse(
                where, f"member {name!r} has no length", "take it out, or part its nodes", "partial"
            )
            return False
        member: dict[str, Any] = {"nodes": list(nodes), "section": section, "material": material}
        member["kind"] = kind
        if local_y is not None:
            member["local_y"] = self.vector(local_y)
        if releases and any(releases.values()):
            member["releases"] = dict(releases)
        if end_springs and any(end_springs.values()):
            member["end_springs"] = dict(end_springs)
        if groups:
            member["groups"] = list(groups)
        self.members[name] = member
        return True

    def support(self, node: str, dofs: Collection[str], where: str) -> None:
        """Hold degrees of freedom of a node, in the source's axes; none: nothing."""
        self._known(node, "a support", where)
        fixed = {self.dof(dof) for dof in dofs}
        if fixed:
            own = self.supports.setdefault(node, {"node": node, "fixed": []})
            own["fixed"] = [dof for dof in DOFS if dof in {*own["fixed"], *fixed}]

    def add_spring(self, node: str, to: str | None, dof: str, stiffness: float, where: str) -> None:
        """Add a spring to another node, or to the ground [N/m or N m/rad]."""
        for end in filter(None, (node, to)):
            self._known(end, "a spring", where)
        spring: dict[str, Any] = {"node": node, "dof": self.dof(dof), "stiffness": stiffness}
        self.springs.append({**spring, "to": to} if to else spring)

    def add_tie(self, nodes: tuple[str, str], dofs: Sequence[str], where: str) -> None:
        """Let two nodes share degrees of freedom."""
        for node in nodes:
            self._known(node, "a tie", where)
        self.ties.append({"nodes": list(nodes), "dofs": [self.dof(dof) for dof in dofs]})

    def add_mass(self, node: str, mass: float, inertia: Sequence[float], where: str) -> None:
        """Add a mass [kg] and its inertia about the source's axes [kg m2]."""
        self._known(node, "a mass", where)
        if mass or any(inertia):
            turned = [abs(value) for value in self.vector(inertia)]
            self.masses[node] = {"node": node, "mass": mass, "inertia": turned}

    def add_force(self, case: str, node: str, components: Sequence[float], where: str) -> None:
        """Add a force [N] and a moment [N m] at a node, in the source's axes."""
        self._known(node, "a load", where)
        added = [*self.vector(components[:3]), *self.vector(components[3:])]
        own = self._forces.setdefault(case, {}).setdefault(node, [0.0] * 6)
        own[:] = [a + b for a, b in zip(own, added, strict=True)]

    def load_member(self, case: str, member: str, where: str, **shape: Any) -> None:
        """Add a load along a member in its local axes: `uniform`, `trapezoid` or `point`.

        Args:
            shape: keys of a `member_load` effect [N/m, N, m].
        """
        if member not in self.members:
            raise InputError(f"a load is on no member: {member!r}", where, "name a member")
        (kind, values), *rest = shape.items()
        if kind == "trapezoid":
            key = f"trapezoid {rest[0][1]}"
        elif kind == "point":
            key, values = "point", (*values, rest[0][1])
        else:
            key = kind
        places = values[:2] if kind == "trapezoid" else [rest[0][1]] if kind == "point" else []
        if not self._within(member, list(places), where):
            return
        loads = self._on_members.setdefault(case, {})
        loads.setdefault((key, tuple(map(float, values))), []).append(member)

    def _within(self, member: str, places: Sequence[float], where: str) -> bool:
        """Whether places on a member lie on it, one behind the other; refused where not."""
        first, last = (np.array(self.nodes[node]) for node in self.members[member]["nodes"])
        return self.within(member, places, float(np.linalg.norm(last - first)), where)

    def within(self, member: str, places: Sequence[float], length: float, where: str) -> bool:
        """Whether places [m] lie on a member of a length [m], one behind the other; refused if not.

        What rounding leaves, a billionth of the length, is no fault.
        """
        near = NEAR * length
        if all(-near <= place <= length + near for place in places):
            if len(places) < 2 or places[1] - places[0] > near:
                return True
            said = f"a load from {places[0]:g} m to {places[1]:g} m, which runs backwards or"
            said += f" has no length, on member {member}"
        else:
            at = " to ".join(f"{place:g} m" for place in places)
            said = f"a load at {at} on member {member}, which is {length:g} m long"
        self.notes.refuse(where, said, "correct its place", "partial")
        return False

    def settle(self, case: str, node: str, dof: str, by: float, where: str) -> None:
        """Move a held degree of freedom of a node [m or rad]."""
        self.support(node, [dof], where)
        # The turned y is -z: a motion along it changes its sign.
        sign = -1.0 if self.up == "y" and dof in ("uz", "rz") else 1.0
        self._settlements.append(
            {"case": case, "support": node, "dof": self.dof(dof), "displacement": sign * by}
        )

    def factor(self, case: str, factor: float) -> None:
        """The factor on the loads of a case; left out, 1."""
        self._factors[case] = factor

    def _known(self, node: str, of: str, where: str) -> None:
        if node not in self.nodes:
            raise InputError(f"{of} names node {node!r}, which is not there", where, "define it")

    def effects(self) -> dict[str, dict[str, Any]]:
        """The loads as effects of a model file: one of forces a case, one a shape along members."""
        found: dict[str, dict[str, Any]] = {}
        for case in dict.fromkeys((*self._forces, *self._on_members)):
            factor = {"factor": self._factors[case]} if case in self._factors else {}
            if forces := self._forces.get(case):
                short = {n: f if any(f[3:]) else f[:3] for n, f in forces.items()}
                found[case] = {"kind": "nodal_load", "forces": short, **factor}
            for number, ((key, values), members) in enumerate(
                self._on_members.get(case, {}).items(), start=1
            ):
                name = f"{case}, on members {number}" if case in found else case
                shape: dict[str, Any]
                if key == "uniform":
                    shape = {"uniform": list(values)}
                elif key == "point":
                    shape = {"point": list(values[:3]), "x": values[3]}
                else:
                    shape = {"axis": key[-1], "trapezoid": list(values)}
                found[name] = {"kind": "member_load", "member": members, **shape, **factor}
        for number, moved in enumerate(self._settlements, start=1):
            case = moved["case"]
            effect = {key: value for key, value in moved.items() if key != "case"}
            effect["displacement"] *= self._factors.get(case, 1.0)
            found[f"{case}, settlement {number}"] = {"kind": "support_settlement", **effect}
        return found

    def load_sums(self, model: Model) -> dict[str, tuple[float, float, float]]:
        """The sum of the forces of each case in the model's axes [N], factors and all."""
        sums: dict[str, tuple[float, float, float]] = {}
        for case in dict.fromkeys((*self._forces, *self._on_members)):
            total = np.zeros(3)
            for force in self._forces.get(case, {}).values():
                total += force[:3]
            for (key, values), members in self._on_members.get(case, {}).items():
                for member in members:
                    length, axes = member_axes(model, member)
                    total += along(key, values, length) @ axes
            x, y, z = (float(value) for value in self._factors.get(case, 1.0) * total)
            sums[case] = (x, y, z)
        return sums

    def make_plane(self, plane: str) -> None:
        """Make it a model of a plane, which holds what leaves it.

        Raises:
            InputError: a node lies elsewhere.
        """
        across = "xyz".index(next(axis for axis in "xyz" if axis not in plane))
        for name, place in self.nodes.items():
            if abs(place[across]) > 1e-9:
                raise InputError(
                    f"node {name!r} lies outside of the plane {plane}", "--plane", "leave it out"
                )
        self.plane = plane

    def counts(self) -> dict[str, int]:
        """How many parts there are, by kind; `frames` of the file where some of them were cut."""
        parts: dict[str, Sized] = {
            "nodes": self.nodes, "members": self.members, "supports": self.supports,
            "springs": self.springs, "ties": self.ties, "masses": self.masses,
            "materials": self.materials, "sections": self.sections,
            "load cases": {*self._forces, *self._on_members},
        }  # fmt: skip
        counts = {kind: len(found) for kind, found in parts.items()}
        if self.cut_frames:
            counts |= {"frames": self.frames, "frames cut": self.cut_frames}
        return counts

    def content(self) -> dict[str, Any]:
        """The model file."""
        return {
            "rga_model": 1,
            "name": self.name,
            "plane": self.plane,
            "materials": self.materials,
            "sections": self.sections,
            "nodes": self.nodes,
            "members": self.members,
            "supports": self.supports,
            "springs": self.springs,
            "ties": self.ties,
            "masses": self.masses,
            "effects": self.effects(),
        }

    def model(self, where: str) -> Model:
        """The validated model.

        Raises:
            ImportRefused: something keeps it from being right.
            InputError: it breaks the schema.
        """
        if not self.members and not self.notes.grave:
            raise InputError("there is no member in it", where, "give a structure of members")
        if self.notes.grave:
            raise ImportRefused(where, self.notes.listed(), self.counts())
        content = self.content()
        model = read_model(content, where)
        for nodes, motion in free_motions(content):
            self.notes.say(
                "noticed", nodes, f"no support holds them as a whole: what they join {motion}"
            )
        return model


def along(shape: str, values: tuple[float, ...], length: float) -> FloatArray:
    """The sum of a load along a member in its local axes, float[3] [N]."""
    if shape == "uniform":
        return np.array(values) * length
    if shape == "point":
        return np.array(values[:3])
    x1, x2, w1, w2 = values
    return np.asarray(np.eye(3)["xyz".index(shape[-1])] * (w1 + w2) / 2 * (x2 - x1))


def _named(table: dict[str, dict[str, float]], label: str, properties: dict[str, float]) -> str:
    """A name for properties in a table: the label, with a number where others have it."""
    name, number = label, 1
    while table.get(name, properties) != properties:
        number += 1
        name = f"{label} ({number})"
    table[name] = properties
    return name
