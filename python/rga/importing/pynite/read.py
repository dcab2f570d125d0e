"""Makes a draft of a PyNite model: its nodes, members, supports and loads."""

from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.importing.cut import CutMember, add_cut, nodes_between
from rga.importing.draft import ModelDraft
from rga.importing.options import Chosen
from rga.importing.pynite.axes import local_axes
from rga.importing.shear import poisson
from rga.importing.units import SI, Units

#: names of PyNite for degrees of freedom, and rga's
FREEDOMS = {"DX": "ux", "DY": "uy", "DZ": "uz", "RX": "rx", "RY": "ry", "RZ": "rz"}
RELEASED = ("ux", "uy", "uz", "rx", "ry", "rz")
NODAL = ("FX", "FY", "FZ", "MX", "MY", "MZ")
LOCAL = ("Fx", "Fy", "Fz")
#: parts of a model that are no members
OTHERS = ("quads", "plates", "meshes", "shear_walls", "mats")
#: modulus of the bars that stand for springs [Pa]
SPRING = 1e9


def is_pynite(source: Any) -> bool:
    """Whether an object is a PyNite model, by what it has."""
    return all(hasattr(source, name) for name in ("nodes", "members", "materials", "load_combos"))


def read_pynite(
    source: Any,
    name: str,
    chosen: Chosen,
) -> ModelDraft:
    """A draft of a PyNite model.

    Args:
        source: the `FEModel3D`, of PyNite 1 or later.
        name: of the model.
        chosen: its units, which are asked for, and the axis that points up, which is y in PyNite;
            the combination whose factors the load cases get.

    Raises:
        InputError: a part names another that is not there, or there is no such combination.
    """
    draft = ModelDraft(name, chosen.accept, chosen.up or "y")
    units = chosen.system
    if units is None:
        draft.notes.say(
            "question", "units", "a PyNite model never states its units",
            'give them, as --units "kip, in" or --units "kN, m"',
        )  # fmt: skip
    reader = _Reader(source, units or SI, draft)
    reader.add()
    _factors(source, draft, reader.cases, chosen.combination)
    said = (
        "(x, y, z) is (x, -z, y) of the model, whose z points up"
        if draft.up == "y"
        else ("the axes are those of PyNite")
    )
    draft.notes.say("assumed", "axes", said)
    return draft


def _factors(source: Any, draft: ModelDraft, cases: set[str], combination: str | None) -> None:
    combos = {name: combo.factors for name, combo in source.load_combos.items()}
    if combination is not None:
        if combination not in combos:
            raise InputError(
                f"there is no combination {combination!r}", "combination",
                f"name one of {', '.join(combos)}",
            )  # fmt: skip
        for case in sorted(cases):
            factor = combos[combination].get(case, 0.0)
            draft.factor(case, float(factor))
            if not factor:
                draft.notes.say("dropped", f"case {case}", f"it is not in {combination}")
        return
    if stated := [name for name, factors in combos.items() if factors and name != "Combo 1"]:
        draft.notes.say(
            "assumed", "combinations",
            f"every load case has the factor 1; {', '.join(stated)} are not applied "
            "(--combination NAME)",
        )  # fmt: skip


class _Reader:
    """Parts of a PyNite model."""

    def __init__(self, source: Any, units: Units, draft: ModelDraft) -> None:
        self.source, self.units, self.draft = source, units, draft
        self.members: dict[str, CutMember] = {}
        self.cases: set[str] = set()

    def where(self, part: Any, kind: str, name: str) -> str:
        """The place of a part: its line in a script, else its name."""
        return str(getattr(part, "where", f"{kind} {name}"))

    def add(self) -> None:
        """Add all of them."""
        for name, node in self.source.nodes.items():
            place = [self.units.length * float(value) for value in (node.X, node.Y, node.Z)]
            self.draft.add_node(name, place, self.where(node, "node", name))
        for name, member in self.source.members.items():
            self._member(name, member, self.where(member, "member", name))
        for name, node in self.source.nodes.items():
            self._support(name, node, self.where(node, "node", name))
        for name, spring in getattr(self.source, "springs", {}).items():
            self._spring(name, spring, self.where(spring, "spring", name))
        for kind in OTHERS:
            for name, part in getattr(self.source, kind, {}).items():
                self.draft.notes.refuse(
                    self.where(part, kind, name), f"{kind} are no members",
                    "model them otherwise", "partial",
                )  # fmt: skip
        solved = str(getattr(self.source, "solution", "") or "")
        if "Delta" in solved or "ushover" in solved:
            self.draft.notes.refuse(
                str(getattr(self.source, "solved_where", "solution")),
                f"the model was analysed by {solved}, which is of second order",
                "analyse it to first order", "linear",
            )  # fmt: skip

    def _member(self, name: str, member: Any, where: str) -> None:
        ends = (member.i_node.name, member.j_node.name)
        one_sided = bool(getattr(member, "tension_only", False)) or bool(
            getattr(member, "comp_only", False)
        )
        if one_sided:
            self.draft.notes.refuse(
                where, "a member that bears tension or compression only", "let it bear both",
                "linear",
            )  # fmt: skip
        points = [np.array([node.X, node.Y, node.Z], dtype=float) for node in
                  (member.i_node, member.j_node)]  # fmt: skip
        if not self.draft.has_length(*ends):
            self.draft.notes.refuse(where, "a member of no length", "take it out", "partial")
            return
        source_axes = local_axes(points[0], points[1], float(member.rotation))
        axes = np.array([self.draft.vector(axis) for axis in source_axes.tolist()])
        section, material = self._properties(member)
        released = [bool(one) for one in member.Releases]
        releases = {
            end: [dof for dof, free in zip(RELEASED, released[k : k + 6], strict=True) if free]
            for end, k in (("i", 0), ("j", 6))
        }
        nodes = nodes_between(self.draft, *ends)
        cut = add_cut(self.draft, name, nodes, section, material, where, axes, releases=releases)
        if cut is not None:
            self.members[name] = cut
            self._loads(name, member, cut, where)

    def _properties(self, member: Any) -> tuple[str, str]:
        section, material, units = member.section, member.material, self.units
        nu, ratio = poisson(float(material.E), float(material.G))
        properties = {"E": float(material.E) * units.stress, "nu": nu}
        # PyNite's density is one of weight.
        density = float(material.rho) * units.force / units.length**3 / 9.80665
        if density:
            properties["density"] = density
        if getattr(material, "fy", None):
            properties["yield_strength"] = float(material.fy) * units.stress
        values = {
            key: float(getattr(section, key)) * units.section(key) * (ratio if key == "J" else 1)
            for key in ("A", "Iy", "Iz", "J")
            if float(getattr(section, key)) > 0
        }
        return (
            self.draft.section(section.name, **values),
            self.draft.material(material.name, **properties),
        )

    def _support(self, name: str, node: Any, where: str) -> None:
        held = [dof for key, dof in FREEDOMS.items() if getattr(node, f"support_{key}", False)]
        self.draft.support(name, held, where)
        for key, dof in FREEDOMS.items():
            stiffness, direction = [*(getattr(node, f"spring_{key}", None) or []), None, None][:2]
            if stiffness:
                if direction is not None:
                    self.draft.notes.refuse(
                        where, "a spring that acts one way only", "let it act both ways", "linear"
                    )
                turns = dof[0] == "r"
                scale = self.units.moment if turns else self.units.line_load
                self.draft.add_spring(name, None, dof, float(stiffness) * scale, where)
            moved = getattr(node, f"Enforced{key}", None)
            if moved:
                size = float(moved) * (1.0 if dof[0] == "r" else self.units.length)
                self.draft.settle("enforced displacements", name, dof, size, where)
        for direction, size, case in node.NodeLoads:
            forces = [0.0] * 6
            scale = self.units.moment if direction[0] == "M" else self.units.force
            forces[NODAL.index(direction)] = float(size) * scale
            self.draft.add_force(case, name, forces, where)
            self.cases.add(case)

    def _spring(self, name: str, spring: Any, where: str) -> None:
        if getattr(spring, "tension_only", False) or getattr(spring, "comp_only", False):
            self.draft.notes.refuse(
                where, "a spring that acts one way only", "let it act both ways", "linear"
            )
        ends = (spring.i_node.name, spring.j_node.name)
        first, last = (np.array(self.draft.nodes[node]) for node in ends)
        size = float(np.linalg.norm(last - first))
        area = float(spring.ks) * self.units.line_load * size / SPRING
        self.draft.add_member(
            f"spring {name}", ends, self.draft.section(f"spring {name}", A=area),
            self.draft.material("springs", E=SPRING), where, kind="truss",
        )  # fmt: skip

    def _direction(self, direction: str, cut: CutMember) -> FloatArray | None:
        """The direction of a load in local axes; None of a moment."""
        if direction in LOCAL:
            return np.asarray(np.eye(3)[LOCAL.index(direction)])
        if direction in NODAL[:3]:
            return cut.local(np.eye(3)[NODAL.index(direction)].tolist())
        return None

    def _loads(self, name: str, member: Any, cut: CutMember, own: str) -> None:
        units = self.units
        # Loads of a script stand in lines of their own.
        lines = getattr(member, "load_lines", {})
        for number, (direction, size, place, case, *_) in enumerate(member.PtLoads):
            where = lines.get(("point", number), own)
            self.cases.add(case)
            along = self._direction(direction, cut)
            if along is None:
                self.draft.notes.refuse(
                    where, f"a moment {direction} on member {name}", "put a node there", "partial"
                )
                continue
            force = along * float(size) * units.force
            cut.load_point(case, float(place) * units.length, force, where)
        for number, (direction, first, last, start, end, case, *_) in enumerate(member.DistLoads):
            where = lines.get(("line", number), own)
            self.cases.add(case)
            along = self._direction(direction, cut)
            if along is None:
                raise InputError(f"a line load along {direction!r}", where, "use FX to Fz")
            places = (float(start) * units.length, float(end) * units.length)
            scale = units.line_load
            cut.load_line(
                case, places, (along * float(first) * scale, along * float(last) * scale), where
            )
