"""Scripts that make a PyNite model, read without running them."""

import re
from collections.abc import Collection
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from rga.errors import InputError
from rga.importing.reading import read_text
from rga.importing.scripts.python import Host, Opened, PythonInterpreter
from rga.importing.scripts.python.opened import Anything, OpenedNames
from rga.importing.scripts.values import Arguments, Unknown

IMPORT = re.compile(r"^\s*(?:from|import)\s+py[nN]ite\b", re.MULTILINE | re.IGNORECASE)
FREEDOMS = ("DX", "DY", "DZ", "RX", "RY", "RZ")
ENDS = [f"{dof}{end}" for end in "ij" for dof in ("Dx", "Dy", "Dz", "Rx", "Ry", "Rz")]
#: methods that build, with their parameters; a default stands behind `=`
METHODS: dict[str, tuple[str, ...]] = {
    "add_node": ("name", "X", "Y", "Z"),
    "add_material": ("name", "E", "G", "nu", "rho", "fy="),
    "add_section": ("name", "A", "Iy", "Iz", "J"),
    "add_steel_section": ("name", "A", "Iy", "Iz", "J", "Zy", "Zz", "material_name"),
    "add_member": (
        "name", "i_node", "j_node", "material_name", "section_name", "rotation=", "tension_only=",
        "comp_only=",
    ),
    "add_spring": ("name", "i_node", "j_node", "ks", "tension_only=", "comp_only="),
    "def_support": ("node_name", *(f"support_{dof}=" for dof in FREEDOMS)),
    "def_support_spring": ("node_name", "dof", "stiffness", "direction="),
    "def_node_disp": ("node_name", "direction", "magnitude"),
    "def_releases": ("member_name", *(f"{end}=" for end in ENDS)),
    "add_load_combo": ("name", "factors", "combo_tags="),
    "add_node_load": ("node_name", "direction", "P", "case="),
    "add_member_pt_load": ("member_name", "direction", "P", "x", "case="),
    "add_member_dist_load": ("member_name", "direction", "w1", "w2", "x1=", "x2=", "case="),
    "add_member_self_weight": ("global_direction", "factor", "case="),
}  # fmt: skip
#: where methods put what they name
TABLES = {
    "add_node": "nodes", "add_material": "materials", "add_section": "sections",
    "add_steel_section": "sections", "add_member": "members", "add_spring": "springs",
    "add_load_combo": "load_combos",
}  # fmt: skip
#: letters of the names that PyNite gives to parts without one
NUMBERED = {"add_node": "N", "add_member": "M", "add_spring": "S"}
#: methods that make parts which are no members
OTHERS = frozenset((
    "add_plate", "add_quad", "add_rectangle_mesh", "add_annulus_mesh", "add_frustrum_mesh",
    "add_cylinder_mesh", "add_shear_wall", "add_mat_foundation",
))  # fmt: skip
#: methods that analyse or show a model, and change nothing of it
QUIET = frozenset((
    "analyze", "analyze_PDelta", "analyze_linear", "analyze_modal", "analyze_pushover", "D", "F",
    "FER", "K", "Kg", "P", "check_statics", "max_model_force", "orphaned_nodes", "unique_name",
))  # fmt: skip
#: results and plain values of nodes, members and springs
RESULTS = frozenset((
    *FREEDOMS, *(f"Rxn{axis}" for axis in ("FX", "FY", "FZ", "MX", "MY", "MZ")),
    "ID", "L", "T", "X", "Y", "Z", "axial", "deflection", "distance", "f", "d", "k",
    "moment", "name", "rel_deflection", "shear", "torque",
))  # fmt: skip
RESULT = re.compile(r"(max|min|plot)_\w+|\w+_(array|diagram)")
#: parts of a model by name
PARTS = frozenset((
    "nodes", "materials", "sections", "members", "springs", "quads", "plates", "meshes",
    "shear_walls", "mats", "load_combos", "load_cases", "solution",
))  # fmt: skip
#: modules of PyNite that show a model
SHOWING = ("Visualization", "Rendering", "Reporting", "VisDeformed", "PynVisualization")
#: names under which PyNite had its methods until version 1
OLD = frozenset(("AddNode", "AddMember", "DefineSupport", "DefineReleases", "AddNodeLoad"))


def says_pynite(path: Path) -> bool:
    """Whether a script imports PyNite."""
    return IMPORT.search(read_text(path)) is not None


def read_pynite_script(
    path: Path, without: Collection[str] = ()
) -> tuple["BuiltModel", list[tuple[str, str]]]:
    """The model that a script makes, and what was taken for granted.

    Args:
        path: the script.
        without: modules that it imports and that do not change the model.

    Raises:
        InputError: it cannot be read, or makes no model.
    """
    made: list[BuiltModel] = []
    module = OpenedNames("Pynite", {"FEModel3D": _Making(made)})
    modules: dict[str, Opened] = {}
    for name in ("Pynite", "PyNite"):
        modules |= {name: module, f"{name}.FEModel3D": module}
        modules |= {f"{name}.{one}": Anything(one, "shows") for one in SHOWING}
    shaping = {*METHODS, *OTHERS, *OLD, "FEModel3D"}
    host = Host(
        shaping.__contains__, QUIET.__contains__, lambda: any(one.members for one in made),
        lambda name: name in RESULTS or RESULT.fullmatch(name) is not None, without=without,
    )  # fmt: skip
    interpreter = PythonInterpreter(path.name, modules, host)
    interpreter.run(read_text(path))
    chosen = next((one for one in made if one.members), None)
    if chosen is None:
        raise InputError("the script makes no model with members", str(path), "give one that does")
    chosen.unfollowed += interpreter.refusals
    said = list(interpreter.assumed)
    if len([one for one in made if one.members]) > 1:
        said.append(("the script makes several models: the first was read", path.name))
    return chosen, said


class _Making(Opened):
    """`FEModel3D`, as a script calls it."""

    trust = "model"

    def __init__(self, made: list["BuiltModel"]) -> None:
        self.made = made

    def attribute(self, name: str) -> Any:
        return self if name == "FEModel3D" else Anything(name)

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        self.made.append(BuiltModel())
        return self.made[-1]


class BuiltModel(Opened):
    """A model as a script builds it, with the parts of an `FEModel3D`.

    Attributes:
        unfollowed: what is not followed and may change it: words and place.
    """

    trust = "model"

    def __init__(self) -> None:
        self.unfollowed: list[tuple[str, str]] = []
        self.nodes: dict[str, Any] = {}
        self.materials: dict[str, Any] = {}
        self.sections: dict[str, Any] = {}
        self.members: dict[str, Any] = {}
        self.springs: dict[str, Any] = {}
        self.quads: dict[str, Any] = {}
        self.load_combos: dict[str, Any] = {}
        self.solution, self.solved_where = "", ""

    def attribute(self, name: str) -> Any:
        return Anything(name, "model") if name in PARTS else _Method(self, name)

    def of(self, table: str, name: Any, where: str) -> Any:
        """A part by its name.

        Raises:
            InputError: there is none.
        """
        found = getattr(self, table).get(str(name))
        if found is None:
            raise InputError(f"there is no {name!r} in {table}", where, "define it before")
        return found

    def length(self, member: Any) -> float:
        """Length of a member."""
        pairs = ((getattr(member.i_node, a), getattr(member.j_node, a)) for a in "XYZ")
        return float(sum((b - a) ** 2 for a, b in pairs) ** 0.5)


class _Method(Opened):
    """One method of a model."""

    trust = "model"

    def __init__(self, model: BuiltModel, name: str) -> None:
        self.model, self.name = model, name

    def attribute(self, name: str) -> Any:
        return Anything(f"{self.name}.{name}", "model")

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        if self.name in OLD:
            raise InputError(
                f"{self.name} is a method of PyNite before version 1", where, "write it anew"
            )
        if self.name in OTHERS:
            self.model.quads[f"{self.name} {len(self.model.quads) + 1}"] = SimpleNamespace(
                where=where
            )
            return Unknown(f"the result of {self.name}")
        if self.name in ("analyze_PDelta", "analyze_pushover"):
            self.model.solution, self.model.solved_where = self.name, where
        parameters = METHODS.get(self.name)
        if parameters is None:
            if self.name not in QUIET:
                self.model.unfollowed.append(
                    (f"{self.name!r} is no method that this reader knows", where)
                )
            return Unknown(f"the result of {self.name}")
        given = Arguments(self.name, [], where)
        names = [parameter.removesuffix("=") for parameter in parameters]
        if len(values) > len(names) or not set(named) <= {*names, "self_weight"}:
            raise given.error("its arguments are not those of PyNite")
        found = {**dict(zip(names, values, strict=False)), **named}
        for parameter in parameters:
            if parameter[-1] != "=" and parameter not in found:
                raise given.error(f"its {parameter} is missing")
        for name, value in found.items():
            given.known(value, name)
        if "name" in found:
            self._name_anew(given, found)
        getattr(self, f"_{self.name}")(given, found, where)
        return found.get("name")

    def _name_anew(self, given: Arguments, of: dict[str, Any]) -> None:
        """See that a part has a name that no other has, as PyNite does; give it one for None."""
        table = TABLES[self.name]
        taken = getattr(self.model, table)
        if of["name"] is None and self.name in NUMBERED:
            letter, number = NUMBERED[self.name], 1
            while f"{letter}{number}" in taken:
                number += 1
            of["name"] = f"{letter}{number}"
        if str(of["name"]) in taken:
            raise given.error(f"there is a {of['name']!r} in {table} already")

    def _add_node(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        place = {axis: given.as_number(of[axis], axis) for axis in "XYZ"}
        self.model.nodes[str(of["name"])] = SimpleNamespace(
            name=str(of["name"]), NodeLoads=[], where=where, **place
        )

    def _add_material(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        values = {key: given.as_number(of[key], key) for key in ("E", "G", "nu", "rho")}
        strength = of.get("fy")
        fy = None if strength is None else given.as_number(strength, "fy")
        self.model.materials[str(of["name"])] = SimpleNamespace(
            name=str(of["name"]), fy=fy, **values
        )

    def _add_section(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        values = {key: given.as_number(of[key], key) for key in ("A", "Iy", "Iz", "J")}
        self.model.sections[str(of["name"])] = SimpleNamespace(name=str(of["name"]), **values)

    _add_steel_section = _add_section

    def _add_member(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        model = self.model
        model.members[str(of["name"])] = SimpleNamespace(
            name=str(of["name"]),
            i_node=model.of("nodes", of["i_node"], where),
            j_node=model.of("nodes", of["j_node"], where),
            material=model.of("materials", of["material_name"], where),
            section=model.of("sections", of["section_name"], where),
            rotation=given.as_number(of.get("rotation", 0.0), "rotation"),
            tension_only=bool(of.get("tension_only")),
            comp_only=bool(of.get("comp_only")),
            Releases=[False] * 12,
            PtLoads=[],
            DistLoads=[],
            load_lines={},
            where=where,
        )

    def _add_spring(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        model = self.model
        model.springs[str(of["name"])] = SimpleNamespace(
            i_node=model.of("nodes", of["i_node"], where),
            j_node=model.of("nodes", of["j_node"], where),
            ks=given.as_number(of["ks"], "ks"),
            tension_only=bool(of.get("tension_only")),
            comp_only=bool(of.get("comp_only")),
            where=where,
        )

    def _def_support(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        node = self.model.of("nodes", of["node_name"], where)
        for dof in FREEDOMS:
            setattr(node, f"support_{dof}", bool(of.get(f"support_{dof}")))

    def _def_support_spring(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        node = self.model.of("nodes", of["node_name"], where)
        stiffness = given.as_number(of["stiffness"], "stiffness")
        self._among(given, of["dof"], FREEDOMS)
        setattr(node, f"spring_{of['dof']}", [stiffness, of.get("direction")])

    def _def_node_disp(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        node = self.model.of("nodes", of["node_name"], where)
        self._among(given, of["direction"], FREEDOMS)
        setattr(node, f"Enforced{of['direction']}", given.as_number(of["magnitude"], "size"))

    def _def_releases(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        member = self.model.of("members", of["member_name"], where)
        member.Releases = [bool(of.get(end)) for end in ENDS]

    def _add_load_combo(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        if not isinstance(of["factors"], dict):
            raise given.error("its factors are no table")
        factors = {
            str(case): given.as_number(value, "factor") for case, value in of["factors"].items()
        }
        self.model.load_combos[str(of["name"])] = SimpleNamespace(factors=factors)

    def _add_node_load(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        node = self.model.of("nodes", of["node_name"], where)
        self._among(given, of["direction"], ("FX", "FY", "FZ", "MX", "MY", "MZ"))
        size = given.as_number(of["P"], "size")
        node.NodeLoads.append((of["direction"], size, str(of.get("case", "Case 1"))))

    def _add_member_pt_load(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        member = self.model.of("members", of["member_name"], where)
        size, place = (given.as_number(of[key], key) for key in ("P", "x"))
        member.load_lines["point", len(member.PtLoads)] = where
        member.PtLoads.append((of["direction"], size, place, str(of.get("case", "Case 1"))))

    def _add_member_dist_load(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        member = self.model.of("members", of["member_name"], where)
        first, last = (given.as_number(of[key], key) for key in ("w1", "w2"))
        start = given.as_number(of.get("x1") or 0.0, "x1")
        end = of.get("x2")
        end = self.model.length(member) if end is None else given.as_number(end, "x2")
        case = str(of.get("case", "Case 1"))
        member.load_lines["line", len(member.DistLoads)] = where
        member.DistLoads.append((of["direction"], first, last, start, end, case))

    def _add_member_self_weight(self, given: Arguments, of: dict[str, Any], where: str) -> None:
        factor = given.as_number(of["factor"], "factor")
        self._among(given, of["global_direction"], ("FX", "FY", "FZ"))
        case = str(of.get("case", "Case 1"))
        for member in self.model.members.values():
            weight = factor * member.material.rho * member.section.A
            end = self.model.length(member)
            member.load_lines["line", len(member.DistLoads)] = where
            member.DistLoads.append((of["global_direction"], weight, weight, 0.0, end, case))

    def _among(self, given: Arguments, value: Any, known: tuple[str, ...]) -> None:
        if value not in known:
            raise given.error(f"{value!r} is not one of {', '.join(known)}")
