"""Parts that can move without resistance: all of them, and how they move."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import FloatArray, OutputArrays
from rga.checking.finding import Finding, named, parts
from rga.checking.kinematics import free_motions
from rga.checking.of_model.connections import Joined, joined
from rga.checking.over_ranges import OverRanges
from rga.errors import InputError, UnstableStructureError
from rga.model.schema import DOFS
from rga.model.structure import Load, Structure
from rga.simulation.paths.response import node_name, patterns, respond_to
from rga.simulation.paths.restraints import remedy

#: motions that are told one by one
MOST_TOLD = 8


def mechanisms(over: OverRanges) -> Iterator[Finding]:
    """Every motion of the structure that nothing resists, by node, direction and members."""
    error = unstable(over)
    if error is None:
        return
    structure = over.structure
    names = [node_name(structure, node) for node in range(len(structure.arrays["coordinates"]))]
    together = joined(structure, over.model.plane)
    motions = free_motions(structure.arrays)
    told = False
    for nodes in together.floating():
        of_part = np.abs(motions[:, nodes]).max(axis=(1, 2), initial=0.0) > 0
        motions, ways = motions[~of_part], int(of_part.sum())
        told = True
        yield Finding(
            "error",
            f"the part with nodes {named(names[node] for node in nodes)}",
            "nothing holds it" + (f": it moves freely in {ways} ways" if ways > 1 else ""),
            "give it supports, or join it to what is held",
        )
    others = [one for one in motions if not _alone(one, together)]
    mend = remedy(structure.arrays)
    for motion in others[:MOST_TOLD]:
        told = True
        yield _told(over, structure, names, motion)
    if len(others) > MOST_TOLD:
        more = len(others) - MOST_TOLD
        yield Finding("error", "structure", f"{more} more motions meet no resistance", mend)
    if not told and not (together.members == 0).any():
        # Nothing is loose, but beside the stiffest parts the softest are lost in rounding.
        mend = "stiffnesses differ by too much: check units of E, A and I, then the supports"
        yield Finding("error", error.where, error.what, mend)


def unstable(over: OverRanges) -> UnstableStructureError | None:
    """Why the solver refuses the structure at the middle of the ranges; None where it stands."""
    try:
        structure = over.structure
        if structure.nonlinear or not structure.nodes or not structure.members:
            return None
        respond_to(structure, patterns(structure, [Load(np.ones(1))]), _one_output())
    except UnstableStructureError as error:
        return error
    except InputError:
        return None
    return None


def _one_output() -> OutputArrays:
    return {
        "kind": np.zeros(1, dtype=np.int64),
        "index": np.zeros(1, dtype=np.int64),
        "other": np.full(1, -1),
        "vector": np.array([[0.0, 0.0, 1.0]]),
        "total": np.zeros(1, dtype=bool),
    }


def _alone(motion: FloatArray, together: Joined) -> bool:
    """Whether nothing moves but a node that is joined to nothing."""
    moving = np.abs(motion).max(axis=1) > 0
    return bool((together.members[moving] == 0).all())


def _told(over: OverRanges, structure: Structure, names: list[str], motion: FloatArray) -> Finding:
    sizes = np.abs(motion[:, :3]).max(axis=1)
    if not sizes.any():
        sizes = np.abs(motion).max(axis=1)
    first = int(np.argmax(sizes > 0.999 * sizes.max()))
    dof = DOFS[int(np.argmax(np.abs(motion[first])))]
    others = [names[node] for node in np.argsort(-sizes, kind="stable") if sizes[node] > 0]
    others.remove(names[first])
    at_it = [name for name, one in over.model.members.items() if names[first] in one.nodes]
    with_it = f", and of {parts('node', others)} with it" if others else ""
    return Finding(
        "error",
        parts("member", at_it) if at_it else "structure",
        f"nothing resists a motion of node {names[first]!r} in {dof}{with_it}",
        remedy(structure.arrays),
    )
