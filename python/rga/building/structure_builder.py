"""The structure of a model from Python, part by part."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, Self

from rga.building.directions import Direction, direction
from rga.building.loads import Force
from rga.building.materials import steel
from rga.building.parts import checked
from rga.building.quantities import Amount, amount, amounts
from rga.building.restraints import held
from rga.building.sections.rolled import rolled_section
from rga.errors import InputError
from rga.model.schema import About, Mass, Material, Member, Section, Spring, Support, Tie

#: what a rotation is held by, and a movement
STIFFNESS = {"r": "N m", "u": "N/m"}


class StructureBuilder:
    """Collects nodes, members, supports, and what they are made of: see `ModelBuilder`."""

    def __init__(
        self,
        name: str,
        plane: Literal["xy", "xz", "yz"] | None = None,
        about: About | Mapping[str, str] | None = None,
    ) -> None:
        self.name, self.plane = name, plane
        self._where = f"model {name!r}"
        if plane not in (None, "xy", "xz", "yz"):
            raise InputError(f"{plane!r} is no plane", self._where, "use 'xz', 'xy' or 'yz'")
        self._content: dict[str, Any] = {
            "rga_model": 1,
            "name": name,
            "materials": {},
            "sections": {},
            "nodes": {},
            "members": {},
            "supports": {},
            "springs": [],
            "ties": [],
            "masses": {},
            "context": {},
            "effects": {},
            "sensors": {},
        }
        if plane is not None:
            self._content["plane"] = plane
        if about is not None:
            given = about if isinstance(about, About) else dict(about)
            self._content["about"] = checked(About, given, self._where)

    def about(
        self,
        client: str = "",
        structure: str = "",
        author: str = "",
        date: str = "",
        version: str = "",
    ) -> Self:
        """Whom and what the model is for, also of a ready-made structure: the head of reports."""
        given = {
            "client": client,
            "structure": structure,
            "author": author,
            "date": date,
            "version": version,
        }
        self._content["about"] = checked(About, given, self._where)
        return self

    @property
    def nodes(self) -> dict[str, tuple[float, float, float]]:
        """Coordinates of the nodes so far [m]."""
        return {name: (x, y, z) for name, (x, y, z) in self._content["nodes"].items()}

    @property
    def groups(self) -> dict[str, list[str]]:
        """Members of each group so far."""
        found: dict[str, list[str]] = {}
        for name, member in self._content["members"].items():
            for group in member.get("groups", ()):
                found.setdefault(group, []).append(name)
        return found

    def nodes_in(self, group: str) -> list[str]:
        """Nodes that the members of a group join, in their order.

        Raises:
            InputError: there is no such group.
        """
        members = self._members_of(group, self._where)
        ends = (self._content["members"][member]["nodes"] for member in members)
        return list(dict.fromkeys(node for pair in ends for node in pair))

    def add_material(
        self,
        name: str,
        material: Material | str | None = None,
        *,
        E: Amount | None = None,
        nu: float = 0.3,
        alpha: Amount = 0.0,
        density: Amount = 0.0,
        yield_strength: Amount | None = None,
    ) -> Self:
        """A material: a grade of `steel` such as "S355", or by E [Pa], alpha [1/K] and density."""
        where = f"material {name!r}"
        if isinstance(material, str):
            material = steel(material)
        if material is None:
            if E is None:
                raise InputError("without E it is none", where, "give E, or a grade of steel")
            strength = yield_strength and amount(yield_strength, "Pa", f"yield strength of {where}")
            given: Any = {
                "E": amount(E, "Pa", f"E of {where}"),
                "nu": nu,
                "alpha": amount(alpha, "1/K", f"alpha of {where}"),
                "density": amount(density, "kg/m^3", f"density of {where}"),
                "yield_strength": strength,
            }
        else:
            given = material
        return self._add("materials", name, checked(Material, given, where))

    def add_section(
        self,
        name: str,
        section: Section | str | None = None,
        *,
        A: Amount | None = None,
        Iy: Amount = 0.0,
        Iz: Amount = 0.0,
        J: Amount = 0.0,
        Asy: Amount | None = None,
        Asz: Amount | None = None,
        fibres: Mapping[str, Sequence[Amount]] | None = None,
    ) -> Self:
        """A section of `rga.building`, a rolled one by name, or one by A [m2], I and J [m4]."""
        where = f"section {name!r}"
        if isinstance(section, str):
            section = rolled_section(section)
        if section is None:
            if A is None:
                raise InputError("without A it is none", where, "give A, or a section")
            given: Any = {
                "A": amount(A, "m^2", f"A of {where}"),
                "Iy": amount(Iy, "m^4", f"Iy of {where}"),
                "Iz": amount(Iz, "m^4", f"Iz of {where}"),
                "J": amount(J, "m^4", f"J of {where}"),
                "Asy": Asy and amount(Asy, "m^2", f"Asy of {where}"),
                "Asz": Asz and amount(Asz, "m^2", f"Asz of {where}"),
                "fibres": {
                    fibre: amounts(place, "m", f"fibre {fibre!r} of {where}", 2)
                    for fibre, place in (fibres or {}).items()
                },
            }
        else:
            given = section
        return self._add("sections", name, checked(Section, given, where))

    def add_node(self, name: str, x: Amount = 0.0, y: Amount = 0.0, z: Amount = 0.0) -> Self:
        """A node at coordinates [m]; z is up."""
        return self._add("nodes", name, amounts((x, y, z), "m", f"node {name!r}", 3))

    def add_member(
        self,
        start: str,
        end: str,
        section: str,
        material: str | None = None,
        *,
        name: str | None = None,
        kind: Literal["truss", "frame"] = "truss",
        groups: str | Iterable[str] = (),
        local_y: Direction | None = None,
        releases: Mapping[str, Sequence[str]] | None = None,
        end_springs: Mapping[str, Mapping[str, Amount]] | None = None,
    ) -> Self:
        """A member between two nodes, named after them unless it has a name of its own.

        Args:
            material: left out, the only one of the model.
            kind: "truss" (axial) or "frame" (bends).
            groups: that it belongs to, one or several.
            local_y: where its local y points; left out, level.
            releases: what an end does not pass on, such as {"i": ["ry"]}.
            end_springs: stiffness of an end's connection, such as {"j": {"ry": "20 MN m"}}.
        """
        name = name or f"{start}-{end}"
        where = f"member {name!r}"
        springs = {
            side: {dof: amount(k, STIFFNESS.get(dof[:1], "N/m"), where) for dof, k in own.items()}
            for side, own in (end_springs or {}).items()
        }
        given: dict[str, Any] = {
            "nodes": (start, end),
            "section": section,
            "material": material or "",
            "kind": kind,
            "groups": [groups] if isinstance(groups, str) else list(groups),
            "releases": dict(releases or {}),
            "end_springs": springs,
        }
        if local_y is not None:
            given["local_y"] = direction(local_y, where)
        return self._add("members", name, checked(Member, given, where))

    def support(
        self, node: str, *held_: str, name: str | None = None, along: Direction | None = None
    ) -> Self:
        """A support of a node, named after it unless it has a name of its own.

        Args:
            held_: "pinned", "fixed", "roller along x", or degrees of freedom such as "uz".
            along: direction in which an inclined roller holds.
        """
        where = f"support {name or node!r}"
        if not held_ and along is None:
            raise InputError("it holds nothing", where, "say 'pinned', 'fixed', 'roller along x'")
        given: dict[str, Any] = {"node": node, "fixed": held(held_, self.plane, where)}
        if along is not None:
            given["along"] = direction(along, where)
        return self._add("supports", name or node, checked(Support, given, where))

    def spring(self, node: str, dof: str, stiffness: Amount, to: str | None = None) -> Self:
        """A spring from a node to the ground, or to another node [N/m or N m/rad]."""
        where = f"spring on {node!r}"
        k = amount(stiffness, STIFFNESS.get(dof[:1], "N/m"), where)
        given = {"node": node, "to": to, "dof": dof, "stiffness": k}
        self._content["springs"].append(checked(Spring, given, where))
        return self

    def tie(self, first: str, second: str, *dofs: str) -> Self:
        """Two nodes that share degrees of freedom."""
        given = {"nodes": (first, second), "dofs": list(dofs)}
        self._content["ties"].append(checked(Tie, given, f"tie of {first!r} and {second!r}"))
        return self

    def mass(
        self, node: str, mass: Amount, *, name: str | None = None, inertia: Force = (0, 0, 0)
    ) -> Self:
        """A mass on a node [kg], with its inertia about the global axes [kg m2]."""
        where = f"mass {name or node!r}"
        given = {
            "node": node,
            "mass": amount(mass, "kg", where),
            "inertia": amounts(inertia, "kg m^2", where, 3),
        }
        return self._add("masses", name or node, checked(Mass, given, where))

    def mass_along(self, group: str, per_length: Amount, *, name: str | None = None) -> Self:
        """A mass along the members of a group [kg/m]: a deck, asphalt, a railing."""
        where = f"mass {name or group!r}"
        given = {"group": group, "per_length": amount(per_length, "kg/m", where)}
        return self._add("masses", name or group, checked(Mass, given, where))

    def _add(self, table: str, name: str, part: Any) -> Self:
        if not isinstance(name, str) or not name:
            raise InputError(f"{name!r} is no name", f"{table} of {self._where}", "give a text")
        if name in self._content[table]:
            raise InputError(f"{name!r} exists already", f"{table} of {self._where}", "rename it")
        self._content[table][name] = part
        return self

    def _members_of(self, place: str, where: str) -> list[str]:
        """Members that a name stands for: of a group, or the one."""
        if place in self.groups:
            return self.groups[place]
        if place in self._content["members"]:
            return [place]
        raise InputError(f"there is no member or group {place!r}", where, "add members before")
