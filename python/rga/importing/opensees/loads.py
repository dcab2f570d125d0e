"""`pattern` and the loads in it."""

from rga.importing.opensees.script_model import (
    ElementLoad,
    Moved,
    NodalForces,
    PatternCommand,
    ScriptModel,
)
from rga.importing.scripts.values import Arguments, Unknown

#: patterns of static loads; all others are motions of the ground in time
PLAIN = "Plain"


def add_pattern(model: ScriptModel, given: Arguments) -> None:
    """Take a `pattern` command; loads given with it by name are its own."""
    kind, tag = given.word("type"), given.tag("tag")
    if kind != PLAIN:
        model.patterns[tag] = PatternCommand(kind, "", 0.0, given.where)
        given.left.clear()
        given.named.clear()
        return
    series = given.take("time series") if given.left else "Linear"
    factor = 1.0
    if isinstance(series, str) and len(words := series.split()) > 1:
        inside = Arguments(given.command, words[1:], given.where)
        factor = (inside.option("-factor", 1, "factor") or [1.0])[0]
        series = words[0]
    for option in ("-fact", "-factor"):
        factor *= (given.option(option, 1, "factor") or [1.0])[0]
    model.patterns[tag] = PatternCommand(kind, str(series), factor, given.where)
    loads = given.named.pop("load", {})
    if isinstance(loads, Unknown) or not isinstance(loads, dict) or given.named:
        raise given.error("loads given by name are a table of nodes and their components")
    for node, components in loads.items():
        values = [node, *(components if isinstance(components, list | tuple) else [components])]
        add_force(model, Arguments("load", values, given.where))


def _pattern(model: ScriptModel, given: Arguments) -> str:
    tags = given.option("-pattern", 1, "pattern")
    if tags is not None:
        return str(int(tags[0]))
    if not model.patterns:
        raise given.error("it stands in no load pattern")
    return list(model.patterns)[-1]


def add_force(model: ScriptModel, given: Arguments) -> None:
    """Take a `load` command."""
    pattern = _pattern(model, given)
    for option in ("-const",):
        given.flag(option)
    tag = given.tag("node")
    node = model.node(tag, given)
    components = tuple(given.number(f"component {k + 1}") for k in range(len(node.freedoms)))
    if model.patterns[pattern].kind == PLAIN:
        model.forces.append(NodalForces(pattern, tag, components, given.where))


def add_moved(model: ScriptModel, given: Arguments) -> None:
    """Take an `sp` command: a displacement that a support is given."""
    pattern = _pattern(model, given)
    given.flag("-const")
    tag = given.tag("node")
    node = model.node(tag, given)
    freedom = int(given.number("degree of freedom"))
    if not 0 < freedom <= len(node.freedoms):
        raise given.error(f"node {tag} has no degree of freedom {freedom}")
    model.moved.append(Moved(pattern, tag, freedom, given.number("displacement"), given.where))


def add_element_load(model: ScriptModel, given: Arguments) -> None:
    """Take an `eleLoad` command: uniform or point loads of elastic beam-columns."""
    pattern = _pattern(model, given)
    elements = [str(int(tag)) for tag in given.option("-ele", None, "elements") or ()]
    if (ends := given.option("-range", 2, "elements")) is not None:
        between = range(int(ends[0]), int(ends[1]) + 1)
        elements += [tag for tag in model.elements if int(tag) in between]
    for tag in elements:
        if tag not in model.elements:
            raise given.error(f"there is no element {tag} before it")
    given.flag("-type")
    kind = given.word("type of load").removeprefix("-")
    numbers = given.numbers("size")
    count = len(numbers)
    where, names = given.where, tuple(elements)
    plane = model.dimensions == 2
    least = 1 if plane else 2
    if not elements:
        raise given.error("it names no element")
    if kind == "beamUniform" and least <= count <= least + 1:
        across, along = numbers[:least], numbers[least] if count > least else 0.0
        y, z = (across[0], 0.0) if plane else (across[0], across[1])
        model.element_loads.append(ElementLoad(pattern, names, where, (along, y, z)))
    elif kind == "beamPoint" and least + 1 <= count <= least + 2:
        along = numbers[least + 1] if count > least + 1 else 0.0
        y, z = (numbers[0], 0.0) if plane else (numbers[0], numbers[1])
        model.element_loads.append(
            ElementLoad(pattern, names, where, (along, y, z), at=numbers[least])
        )
    else:
        model.refuse(
            given, f"eleLoad {kind} of {count} numbers is no uniform or point load of a member"
        )
