"""`element`: trusses, elastic beam-columns, and springs of no length."""

from collections.abc import Callable

from rga.importing.numerals import float_of
from rga.importing.opensees.script_model import Element, ScriptModel
from rga.importing.scripts.values import Arguments

#: directions of a zero-length element, as degrees of freedom; in a plane the third turns
DIRECTIONS = ("ux", "uy", "uz", "rx", "ry", "rz")
#: codes of released ends
RELEASED = {0: "", 1: "i", 2: "j", 3: "ij"}


def add_element(model: ScriptModel, given: Arguments) -> None:
    """Take an `element` command; one that no member or spring can be is refused.

    Raises:
        InputError: an argument is missing, not known or of the wrong sort.
    """
    kind = given.word("type")
    tag = given.tag("tag")
    if tag in model.elements:
        raise given.error(f"element {tag} is there already")
    read = READERS.get(kind)
    if read is None:
        model.refuse(given, f"element {tag} is {kind}, which is no truss or elastic beam-column")
        given.left.clear()
        given.named.clear()
        return
    element = read(model, kind, given)
    if element is not None:
        model.elements[tag] = element


def _truss(model: ScriptModel, kind: str, given: Arguments) -> Element | None:
    nodes = _ends(model, given)
    _drop_mass(model, given, "-rho")
    if _named_only(given, {"A", "material", "section"}):
        area = given.named.get("A")
        given.left += [area] if area is not None else []
        given.left += [given.named[name] for name in ("material", "section") if name in given.named]
        given.named.clear()
    first = given.number("area, or section,")
    if given.left and is_tag(given.peek()):
        material = given.tag("material")
        return Element("truss", kind, nodes, given.where, {"A": first}, ((material, "E"),))
    return Element("truss", kind, nodes, given.where, section=str(int(first)))


def _elastic_beam(model: ScriptModel, kind: str, given: Arguments) -> Element | None:
    nodes = _ends(model, given)
    released = _releases(model, given)
    _drop_mass(model, given, "-mass")
    numbers = given.numbers("properties", 2)
    if len(numbers) == 2:
        section, transformation = (str(int(number)) for number in numbers)
        return Element(
            "frame", kind, nodes, given.where,
            section=section, transformation=transformation, released=released,
        )  # fmt: skip
    order = ("A", "E", "Iz") if model.dimensions == 2 else ("A", "E", "G", "J", "Iy", "Iz")
    return _prismatic(kind, nodes, given, numbers, order, released)


def _timoshenko(model: ScriptModel, kind: str, given: Arguments) -> Element | None:
    nodes = _ends(model, given)
    _drop_mass(model, given, "-mass")
    order: tuple[str, ...] = ("E", "G", "A", "Iz", "Asy")
    if model.dimensions == 3:
        order = ("E", "G", "A", "J", "Iy", "Iz", "Asy", "Asz")
    return _prismatic(kind, nodes, given, given.numbers("properties"), order, {})


def _prismatic(
    kind: str,
    nodes: tuple[str, str],
    given: Arguments,
    numbers: list[float],
    order: tuple[str, ...],
    released: dict[str, list[str]],
) -> Element:
    if len(numbers) != len(order) + 1:
        raise given.error(
            f"{len(numbers)} numbers after its nodes, where {', '.join(order)} and its "
            "transformation are expected"
        )
    return Element(
        "frame", kind, nodes, given.where,
        dict(zip(order, numbers, strict=False)),
        transformation=str(int(numbers[-1])), released=released,
    )  # fmt: skip


def _integrated_beam(model: ScriptModel, kind: str, given: Arguments) -> Element | None:
    """A beam-column integrated along its length, exact where its section is elastic."""
    nodes = _ends(model, given)
    _drop_mass(model, given, "-mass")
    for option in ("-iter",):
        given.option(option, None, option)
    numbers = [str(int(number)) for number in given.numbers("section and transformation", 2)]
    if len(numbers) == 2:
        transformation, integration = numbers
        if integration not in model.integrations:
            raise given.error(f"there is no beamIntegration {integration} before it")
        section, points = model.integrations[integration]
    else:
        points, section, transformation = int(numbers[0]), numbers[1], numbers[2]
    if points < 3:
        model.refuse(given, f"{kind} with {points} points of integration bends otherwise")
    return Element(
        "frame", kind, nodes, given.where, section=section, transformation=transformation
    )


def _zero_length(model: ScriptModel, kind: str, given: Arguments) -> Element | None:
    nodes = _ends(model, given)
    if given.option("-orient", None, "axes") is not None:
        model.refuse(given, f"{kind} with axes of its own (-orient) is no spring along x, y or z")
        return None
    materials = given.option("-mat", None, "materials")
    directions = given.option("-dir", None, "directions")
    if not materials or directions is None or len(materials) != len(directions):
        raise given.error("as many materials (-mat) as directions (-dir) are expected")
    pairs = []
    for material, number in zip(materials, directions, strict=True):
        if number not in range(1, 7):
            raise given.error(f"direction {number:g} is not one of 1 to 6")
        dof = DIRECTIONS[int(number) - 1]
        turns = model.dimensions == 2 and dof == "uz"
        pairs.append((str(int(material)), "rz" if turns else dof))
    return Element("springs", kind, nodes, given.where, materials=tuple(pairs))


def _ends(model: ScriptModel, given: Arguments) -> tuple[str, str]:
    ends = given.tag("first node"), given.tag("second node")
    for tag in ends:
        model.node(tag, given)
    return ends


def _releases(model: ScriptModel, given: Arguments) -> dict[str, list[str]]:
    """Released ends: about z, and in space about y."""
    options = {"-release": "rz", "-releasez": "rz", "-releasey": "ry"}
    ends: dict[str, list[str]] = {"i": [], "j": []}
    for option, dof in options.items():
        code = given.option(option, 1, "code of released ends")
        if code is None:
            continue
        if code[0] not in RELEASED:
            raise given.error(f"{option} {code[0]:g} is not one of 0 to 3")
        for end in RELEASED[int(code[0])]:
            ends[end].append(dof)
    return ends


def _drop_mass(model: ScriptModel, given: Arguments, option: str) -> None:
    """Take out a member's mass and how it is shared: statics has no use for it."""
    for name in ("-cMass", "-lMass", "-doRayleigh"):
        given.flag(name)
    mass = given.option(option, 1, "mass")
    if mass and mass[0]:
        model.dropped.append((given.where, "the mass of elements: statics has no use for it"))


def _named_only(given: Arguments, known: set[str]) -> bool:
    if unknown := sorted(given.named.keys() - known):
        raise given.error(f"{unknown[0]!r} is an argument that is not known")
    return bool(given.named)


def is_tag(value: object) -> bool:
    """Whether a value is a whole number."""
    try:
        return float_of(str(value)).is_integer()
    except ValueError:
        return False


READERS: dict[str, Callable[[ScriptModel, str, Arguments], Element | None]] = {
    **dict.fromkeys(("truss", "Truss", "trussSection", "TrussSection"), _truss),
    **dict.fromkeys(("corotTruss", "CorotTruss", "corotTrussSection"), _truss),
    **dict.fromkeys(("elasticBeamColumn", "ElasticBeamColumn", "elasticBeam"), _elastic_beam),
    "ElasticTimoshenkoBeam": _timoshenko,
    "elasticTimoshenkoBeam": _timoshenko,
    **dict.fromkeys(
        ("forceBeamColumn", "dispBeamColumn", "nonlinearBeamColumn", "forceBeamColumnCBDI"),
        _integrated_beam,
    ),
    "zeroLength": _zero_length,
}
