"""Response of a structure to loads: the way into the core."""

import re

import numpy as np

from rga import _core
from rga.arrays import FloatArray, LoadArrays, OutputArrays
from rga.errors import InputError, UnstableStructureError
from rga.model.schema import DOFS
from rga.model.structure import OF_MEMBERS, Load, Structure
from rga.simulation.paths.restraints import remedy


def respond(structure: Structure, loads: list[Load], outputs: OutputArrays) -> FloatArray:
    """Outputs under each load pattern with coefficient one, float[loads, outputs] in SI units.

    Raises:
        UnstableStructureError: names the node and the direction that can move.
        InputError: a property that the core refuses.
    """
    return respond_to(structure, patterns(structure, loads), outputs)


def respond_to(structure: Structure, loads: LoadArrays, outputs: OutputArrays) -> FloatArray:
    """The same of loads in the form that the core takes, with the same errors."""
    try:
        return _core.respond(structure.arrays, loads, outputs)
    except (_core.UnstableStructure, _core.InvalidInput) as error:
        raise refused(structure, error) from None


def refused(
    structure: Structure, error: _core.UnstableStructure | _core.InvalidInput
) -> InputError:
    """What the core refuses, in the names of the model; how to mend it, where the core says so."""
    if isinstance(error, _core.InvalidInput):
        what, _, how = _named(structure, str(error)).partition("; ")
        return InputError(what, _of_member(structure, str(error)), how or "mend that value")
    place = f"node {node_name(structure, error.node)!r} in {DOFS[error.dof]}"
    return UnstableStructureError(
        f"the structure can move: {place} meets no resistance",
        "members and supports",
        remedy(structure.arrays),
    )


def _named(structure: Structure, told: str) -> str:
    """What the core tells of nodes and members by their numbers, by their names."""

    def name(found: re.Match[str]) -> str:
        names = list(structure.nodes if found[1] == "node" else structure.members)
        number = int(found[2])
        return f"{found[1]} {names[number]!r}" if number < len(names) else found[0]

    return re.sub(r"\b(node|member) (\d+)\b", name, told)


def _of_member(structure: Structure, told: str) -> str:
    """The member that the core tells of by its number, as in "Iy[1] is 0"."""
    found, names = re.match(r"(\w+)\[(\d+)\]", told), list(structure.members)
    if found is None or found[1] not in OF_MEMBERS or int(found[2]) >= len(names):
        return "the structure as it reaches the solver"
    return f"member {names[int(found[2])]!r}"


def node_name(structure: Structure, node: int) -> str:
    """Name of a node of the model, or words for one that an effect has added."""
    names = list(structure.nodes)
    return names[node] if node < len(names) else f"of the floor beside {names[0]}"


def patterns(structure: Structure, loads: list[Load]) -> LoadArrays:
    """Load patterns in the form that the core takes."""
    count, nodes, members = len(loads), len(structure.arrays["coordinates"]), len(structure.host)
    forces = np.zeros((count, nodes, 6))
    strain = np.zeros((count, members, 3))
    prescribed = np.zeros((count, nodes, 6))
    inclined = np.zeros((count, len(structure.arrays["inclined_node"])))
    spread: list[tuple[int, int, int, float, float, float, float]] = []
    for number, load in enumerate(loads):
        for node, force in load.forces.items():
            forces[number, node] += force
        if load.strain is not None:
            strain[number, :, 0] = load.strain
        for (node, dof), displacement in load.prescribed.items():
            prescribed[number, node, dof] = displacement
        spread += [(number, *one) for one in load.spread]
    table = np.array(spread, dtype=float).reshape(-1, 7)
    pattern, member, axis = table[:, :3].T.astype(np.int64)
    start, end, first, last = table[:, 3:].T.copy()
    return {
        "forces": forces,
        "strain": strain,
        "prescribed": prescribed,
        "prescribed_inclined": inclined,
        "member_pattern": pattern,
        "member_index": member,
        "member_axis": axis,
        "member_from": start,
        "member_to": end,
        "member_start": first,
        "member_end": last,
    }
