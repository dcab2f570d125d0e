"""Makes a draft of what a script defines: members, supports and loads in SI."""

from typing import Any, Literal

import numpy as np

from rga.importing.draft import ModelDraft
from rga.importing.opensees.script_model import Defined, Element, ScriptModel
from rga.importing.shear import poisson
from rga.importing.units import Units

#: series under which a load has its full size at the end of a static analysis
STATIC_SERIES = ("Linear", "Constant")
#: kinds of elastic sections
ELASTIC = ("Elastic", "ElasticSection")
REMEDY = "write it as rga has it, or take it out where it does not matter"


def build(script: ScriptModel, units: Units, draft: ModelDraft) -> None:
    """Put what a script defines into a draft.

    Raises:
        InputError: a part names another that is not there.
    """
    for where, what in script.refusals:
        draft.notes.refuse(where, what, REMEDY, "partial")
    for where, what in script.dropped:
        draft.notes.say("dropped", where, what)
    for tag, node in script.nodes.items():
        place = [units.length * value for value in node.place]
        draft.add_node(tag, [*place, 0.0][:3], node.where)
    _Members(script, units, draft).add()
    _add_supports(script, draft)
    _add_masses(script, units, draft)
    _add_loads(script, units, draft)


class _Members:
    """Elements as members and springs."""

    def __init__(self, script: ScriptModel, units: Units, draft: ModelDraft) -> None:
        self.script, self.units, self.draft = script, units, draft

    def add(self) -> None:
        """Add all of them."""
        for tag, element in self.script.elements.items():
            values = self._values(tag, element)
            if values is None:
                continue
            if element.kind == "springs":
                for dof, stiffness in values.items():
                    per = self.units.force / self.units.length
                    scale = self.units.moment if dof[0] == "r" else per
                    ends = element.nodes
                    self.draft.add_spring(*ends, dof, stiffness * scale, element.where)
                continue
            self._add_member(tag, element, values)

    def _values(self, tag: str, element: Element) -> dict[str, float] | None:
        """All properties of an element by name; None where one is not linear."""
        values = dict(element.values)
        if element.section is not None:
            section = self.script.sections.get(element.section)
            if not self._elastic(section, "section", element.section, tag, element, ELASTIC):
                return None
            assert section is not None
            values |= section.values
        for material, name in element.materials:
            defined = self.script.materials.get(material)
            if not self._elastic(defined, "material", material, tag, element, ("Elastic",)):
                return None
            assert defined is not None
            values[name] = defined.values["E"]
        return values

    def _elastic(
        self,
        defined: Defined | None,
        what: str,
        name: str,
        tag: str,
        element: Element,
        kinds: tuple[str, ...],
    ) -> bool:
        if defined is None:
            self.draft.notes.refuse(
                element.where, f"element {tag} has {what} {name}, which is not defined", "define it"
            )
            return False
        if defined.kind in kinds:
            return True
        self.draft.notes.refuse(
            defined.where,
            f"{what} {name} is {defined.kind}, which is not linear elastic, and "
            f"element {tag} ({element.where}) uses it",
            "give a linear material or section, or take the element out",
            "partial",
        )
        return False

    def _add_member(self, tag: str, element: Element, values: dict[str, float]) -> None:
        if element.command.lower().startswith("corot"):
            self._second_order(element.where, f"element {tag} is {element.command}")
        needed = ["A", "E"]
        if element.kind == "frame":
            needed += ["Iz"] if self.script.dimensions == 2 else ["Iy", "Iz", "G", "J"]
        if missing := [name for name in needed if values.get(name, 0.0) <= 0]:
            self.draft.notes.refuse(
                element.where,
                f"element {tag} has no {', '.join(missing)} above 0",
                "correct it",
                "partial",
            )
            return
        local_y = None
        if element.kind == "frame":
            local_y = self._local_y(tag, element)
            if local_y is None:
                return
        # Twist and shear are by G of the script: where no Poisson's ratio gives it, by areas.
        nu, ratio = poisson(values["E"], values.get("G"))
        shear = values.get("G", 0.0) and values["A"]
        for axis in "yz":
            if values.get(f"shape {axis}"):
                values[f"As{axis}"] = shear * values[f"shape {axis}"]
        names = ["A"] if element.kind == "truss" else ["A", "Iy", "Iz", "J", "Asy", "Asz"]
        section = {
            name: values[name]
            * self.units.section(name)
            * (ratio if name in ("J", "Asy", "Asz") else 1.0)
            for name in names
            if values.get(name)
        }
        label = ", ".join(f"{name} {values[name]:g}" for name in names if values.get(name))
        stiffness = {"E": values["E"] * self.units.stress, **({"nu": nu} if nu != 0.3 else {})}
        kind: Literal["truss", "frame"] = "truss" if element.kind == "truss" else "frame"
        self.draft.add_member(
            tag,
            element.nodes,
            self.draft.section(f"{label} ({self.units.text})", **section),
            self.draft.material(f"E {values['E']:g} ({self.units.text})", **stiffness),
            element.where,
            kind=kind,
            local_y=local_y,
            releases=element.released,
        )

    def _local_y(self, tag: str, element: Element) -> Any:
        """Local y of a frame member in the script's axes; None where it cannot be."""
        name = element.transformation or ""
        found = self.script.transformations.get(name)
        if found is None:
            self.draft.notes.refuse(
                element.where, f"element {tag} has transformation {name}, which is not defined",
                "define it",
            )  # fmt: skip
            return None
        if found.kind != "Linear":
            self._second_order(found.where, f"geomTransf {found.kind} {name}, of element {tag} and")
        first, second = (self.script.nodes[node].place for node in element.nodes)
        along = np.zeros(3)
        along[: len(first)] = np.subtract(second, first)
        if self.script.dimensions == 2:
            return np.cross([0.0, 0.0, 1.0], along).tolist()
        given = np.array([found.values[axis] for axis in "xyz"])
        across = np.cross(given, along)
        if np.linalg.norm(across) <= 1e-9 * np.linalg.norm(given) * np.linalg.norm(along):
            self.draft.notes.refuse(
                found.where, f"the vector of transformation {name} lies along element {tag}",
                "give another", "partial",
            )  # fmt: skip
            return None
        return (across / np.linalg.norm(across)).tolist()

    def _second_order(self, where: str, what: str) -> None:
        # One note for all elements of a transformation.
        said = what.partition(", of element")[0]
        self.draft.notes.refuse(
            where,
            f"{said}: of second order, which a linear model leaves out",
            "make it Linear",
            "linear",
        )


def _add_supports(script: ScriptModel, draft: ModelDraft) -> None:
    for tag, held, where in script.fixes:
        draft.support(tag, held, where)
        if not held:
            draft.notes.say("noticed", where, f"this fix holds nothing of node {tag}: no support")
    for first, second, freedoms, where in script.ties:
        names = script.nodes[first].freedoms
        draft.add_tie((first, second), [names[k - 1] for k in freedoms], where)


def _add_masses(script: ScriptModel, units: Units, draft: ModelDraft) -> None:
    for tag, (masses, where) in script.masses.items():
        by_dof = dict(zip(script.nodes[tag].freedoms, masses, strict=False))
        along = [mass for dof, mass in by_dof.items() if dof[0] == "u"]
        inertia = [
            by_dof.get(dof, 0.0) * units.mass * units.length**2 for dof in ("rx", "ry", "rz")
        ]
        if len(set(along)) > 1:
            draft.notes.say(
                "assumed", where, "masses differ by direction: the largest acts in all of them"
            )
        draft.add_mass(tag, max(along, default=0.0) * units.mass, inertia, where)


def _add_loads(script: ScriptModel, units: Units, draft: ModelDraft) -> None:
    factors: dict[str, float] = {}
    for tag, pattern in script.patterns.items():
        series = script.series.get(pattern.series)
        kind = series.kind if series else pattern.series
        if pattern.kind != "Plain":
            draft.notes.say(
                "dropped",
                pattern.where,
                f"pattern {pattern.kind}: a motion in time, no static load",
            )
        elif kind not in STATIC_SERIES:
            draft.notes.say(
                "dropped", pattern.where,
                f"the loads of pattern {tag}, whose series {kind} varies in time",
            )  # fmt: skip
        else:
            factors[tag] = pattern.factor * (series.values["factor"] if series else 1.0)
    names = {tag: f"pattern {tag}" for tag in factors}
    for force in script.forces:
        if force.pattern in factors:
            freedoms = script.nodes[force.node].freedoms
            six = dict(zip(freedoms, force.components, strict=True))
            components = [
                factors[force.pattern]
                * six.get(dof, 0.0)
                * (units.moment if dof[0] == "r" else units.force)
                for dof in ("ux", "uy", "uz", "rx", "ry", "rz")
            ]
            draft.add_force(names[force.pattern], force.node, components, force.where)
    for load in script.element_loads:
        if load.pattern not in factors:
            continue
        for tag in load.elements:
            _load_element(
                script, units, draft, load, tag, names[load.pattern], factors[load.pattern]
            )
    for moved in script.moved:
        if moved.pattern in factors:
            dof = script.nodes[moved.node].freedoms[moved.freedom - 1]
            scale = factors[moved.pattern] * (1.0 if dof[0] == "r" else units.length)
            draft.settle(names[moved.pattern], moved.node, dof, moved.by * scale, moved.where)


def _load_element(
    script: ScriptModel,
    units: Units,
    draft: ModelDraft,
    load: Any,
    tag: str,
    case: str,
    factor: float,
) -> None:
    element = script.elements[tag]
    if tag not in draft.members:
        return  # it is refused already
    if element.kind != "frame":
        draft.notes.refuse(
            load.where, f"a load along element {tag}, which is no beam", "load its nodes", "partial"
        )
        return
    if load.at is None:
        uniform = tuple(factor * units.line_load * value for value in load.components)
        draft.load_member(case, tag, load.where, uniform=uniform)
        return
    first, second = (np.array(script.nodes[node].place) for node in element.nodes)
    place = load.at * units.length * float(np.linalg.norm(second - first))
    point = tuple(factor * units.force * value for value in load.components)
    draft.load_member(case, tag, load.where, point=point, x=place)
