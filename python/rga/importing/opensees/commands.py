"""Commands of OpenSees: those that define a model, those that do not, and the rest."""

from collections.abc import Callable

from rga.importing.opensees.command_names import CHANGES, MESHES, TIES, UNUSED
from rga.importing.opensees.elements import add_element
from rga.importing.opensees.loads import add_element_load, add_force, add_moved, add_pattern
from rga.importing.opensees.script_model import FREEDOMS, Defined, Node, ScriptModel
from rga.importing.scripts.values import Arguments

#: coordinates that `fixX` takes as the same
SAME_PLACE = 1e-10


def command(model: ScriptModel, name: str, given: Arguments) -> bool:
    """Take a command that defines something; False where it is none of these."""
    take = DEFINING.get(name)
    if take is None:
        return False
    take(model, given)
    return True


def start(given: Arguments) -> ScriptModel:
    """A model as `model` begins it."""
    for name in ("ndm", "ndf"):
        if name in given.named:
            given.left += [f"-{name}", given.named.pop(name)]
    dimensions = int((given.option("-ndm", 1, "number of dimensions") or [0])[0])
    default = {2: 3, 3: 6}.get(dimensions, 0)
    number = int((given.option("-ndf", 1, "number of freedoms") or [default])[0])
    if (dimensions, number) not in FREEDOMS:
        raise given.error(
            f"a model of {dimensions} dimensions and {number} degrees of freedom at a node is "
            "none of trusses or frames"
        )
    return ScriptModel(dimensions, FREEDOMS[dimensions, number], given.where)


def _node(model: ScriptModel, given: Arguments) -> None:
    tag = given.tag("tag")
    if tag in model.nodes:
        raise given.error(f"node {tag} is there already")
    freedoms = model.freedoms
    if (number := given.option("-ndf", 1, "number of freedoms")) is not None:
        freedoms = FREEDOMS.get((model.dimensions, int(number[0])), ())
    mass = given.option("-mass", len(freedoms), "mass")
    if "mass" in given.named:
        values = given.named.pop("mass")
        values = values if isinstance(values, list | tuple) else [values]
        mass = [given.as_number(value, "mass") for value in values]
    place = tuple(given.number(f"coordinate {axis}") for axis in "xyz"[: model.dimensions])
    if not freedoms:
        model.refuse(given, f"node {tag} has degrees of freedom that no truss or frame has")
        freedoms = model.freedoms
    model.nodes[tag] = Node(place, freedoms, given.where)
    if mass and any(mass):
        model.masses[tag] = (tuple(mass), given.where)


def _fix(model: ScriptModel, given: Arguments) -> None:
    tag = given.tag("node")
    node = model.node(tag, given)
    fixed = [given.number(f"mark of {dof}") for dof in node.freedoms if given.left]
    if len(fixed) < len(node.freedoms):
        raise given.error(f"{len(fixed)} marks for {len(node.freedoms)} degrees of freedom")
    held = tuple(dof for dof, mark in zip(node.freedoms, fixed, strict=True) if mark)
    model.fixes.append((tag, held, given.where))


def _fix_all(axis: int) -> Callable[[ScriptModel, Arguments], None]:
    """`fixX`, `fixY`, `fixZ`: holds every node at a coordinate."""

    def fix(model: ScriptModel, given: Arguments) -> None:
        place = given.number("coordinate")
        near = (given.option("-tol", 1, "tolerance") or [SAME_PLACE])[0]
        marks = given.numbers("marks", 1)
        for tag, node in model.nodes.items():
            if abs(node.place[axis] - place) <= near:
                held = tuple(d for d, mark in zip(node.freedoms, marks, strict=False) if mark)
                model.fixes.append((tag, held, given.where))

    return fix


def _mass(model: ScriptModel, given: Arguments) -> None:
    tag = given.tag("node")
    node = model.node(tag, given)
    masses = tuple(given.number(f"mass along {dof}") for dof in node.freedoms if given.left)
    model.masses[tag] = (masses, given.where)


def _equal_dof(model: ScriptModel, given: Arguments) -> None:
    first, second = given.tag("retained node"), given.tag("constrained node")
    freedoms = tuple(int(number) for number in given.numbers("degrees of freedom", 1))
    for tag in (first, second):
        node = model.node(tag, given)
        if not all(0 < number <= len(node.freedoms) for number in freedoms):
            raise given.error(f"node {tag} has not all of the degrees of freedom {freedoms}")
    model.ties.append((first, second, freedoms, given.where))


def _uniaxial(model: ScriptModel, given: Arguments) -> None:
    kind, tag = given.word("type"), given.tag("tag")
    values: dict[str, float] = {}
    if kind == "Elastic":
        given.left += [given.named[name] for name in ("E", "eta", "Eneg") if name in given.named]
        numbers = given.numbers("modulus", 1)
        values["E"] = numbers[0]
        if len(numbers) > 2 and numbers[2] != numbers[0]:
            kind = "Elastic with another modulus in compression"
    given.left.clear()
    given.named.clear()
    model.materials[tag] = Defined(kind, values, given.where)


def _section(model: ScriptModel, given: Arguments) -> None:
    kind, tag = given.word("type"), given.tag("tag")
    values: dict[str, float] = {}
    if kind in ("Elastic", "ElasticSection"):
        short = model.dimensions == 2
        order = ("E", "A", "Iz", "G", "shape y") if short else (
            "E", "A", "Iz", "Iy", "G", "J", "shape y", "shape z",
        )  # fmt: skip
        numbers = given.numbers("properties", 3 if short else 6)
        values = dict(zip(order, numbers, strict=False))
    given.left.clear()
    given.named.clear()
    model.sections[tag] = Defined(kind, values, given.where)


def _transformation(model: ScriptModel, given: Arguments) -> None:
    kind, tag = given.word("type"), given.tag("tag")
    if (offsets := given.option("-jntOffset", None, "offsets")) is not None and any(offsets):
        model.refuse(given, f"transformation {tag} sets members off their nodes (-jntOffset)")
    numbers = given.numbers("vector in the local xz plane")
    if model.dimensions == 3 and len(numbers) != 3:
        raise given.error("a vector in the local xz plane is missing")
    values = dict(zip("xyz", numbers, strict=False))
    model.transformations[tag] = Defined(kind, values, given.where)


def _integration(model: ScriptModel, given: Arguments) -> None:
    kind, tag = given.word("type"), given.tag("tag")
    numbers = given.numbers("section and points", 2)
    model.integrations[tag] = (str(int(numbers[0])), int(numbers[1]))
    if kind not in ("Lobatto", "Legendre", "NewtonCotes"):
        model.integrations[tag] = (str(int(numbers[0])), 0)


def _series(model: ScriptModel, given: Arguments) -> None:
    kind, tag = given.word("type"), given.tag("tag")
    factor = (given.option("-factor", 1, "factor") or [1.0])[0]
    given.left.clear()
    model.series[tag] = Defined(kind, {"factor": factor}, given.where)


def _refused(what: str) -> Callable[[ScriptModel, Arguments], None]:
    def refuse(model: ScriptModel, given: Arguments) -> None:
        given.left.clear()
        given.named.clear()
        model.refuse(given, f"{given.command}: {what}")

    return refuse


def _remove(model: ScriptModel, given: Arguments) -> None:
    if str(given.peek()) not in ("recorders", "recorder"):
        model.refuse(given, "remove: the model changes while it is analysed")
    given.left.clear()


def _not_needed(model: ScriptModel, given: Arguments) -> None:
    """A definition that only elements use which are refused themselves."""
    given.left.clear()
    given.named.clear()
    model.dropped.append((given.where, f"{given.command}: no member of trusses or frames uses it"))


DEFINING: dict[str, Callable[[ScriptModel, Arguments], None]] = {
    "node": _node,
    "fix": _fix,
    "fixX": _fix_all(0),
    "fixY": _fix_all(1),
    "fixZ": _fix_all(2),
    "mass": _mass,
    "equalDOF": _equal_dof,
    "uniaxialMaterial": _uniaxial,
    "section": _section,
    "geomTransf": _transformation,
    "beamIntegration": _integration,
    "element": add_element,
    "timeSeries": _series,
    "pattern": add_pattern,
    "load": add_force,
    "eleLoad": add_element_load,
    "sp": add_moved,
    "remove": _remove,
    **dict.fromkeys(UNUSED, _not_needed),
    **dict.fromkeys(TIES, _refused("ties between nodes that are not of equal degrees of freedom")),
    **dict.fromkeys(MESHES, _refused("a mesh of elements that are no members")),
    **dict.fromkeys(CHANGES, _refused("a model that changes while it is analysed")),
}
