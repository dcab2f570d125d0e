"""Whether what holds a structure can keep it in its place."""

import numpy as np

from rga.arrays import FloatArray, StructureArrays

#: singular value of a restraint, beside the largest, below which it holds nothing more
HOLDS = 1e-9


def remedy(structure: StructureArrays) -> str:
    """What to do where a structure can move, in words."""
    plane = bool(len(structure["fixed"])) and bool(structure["fixed"][:, :3].all(axis=0).any())
    if can_leave(structure):
        told = "a support seems missing: add it, or a spring or member to what is held"
        return told if plane else f"{told}, or state the plane of a plane structure"
    told = "add a member, a support or a stiffness there"
    return told if plane else f"{told}, or hold the plane"


def can_leave(structure: StructureArrays) -> bool:
    """Whether the whole structure can move as one rigid body, whatever its members are."""
    return int(np.linalg.matrix_rank(_held(structure), rtol=HOLDS)) < 6


def _held(structure: StructureArrays) -> FloatArray:
    """What supports and springs hold of the six motions of a rigid body, float[restraints, 6]."""
    places = structure["coordinates"] - structure["coordinates"].mean(axis=0)
    size = float(np.abs(places).max(initial=0.0)) or 1.0
    # motions[node, dof, way]: three translations, and three turns about the middle.
    motions = np.zeros((len(places), 6, 6))
    motions[:, :3, :3] = np.eye(3)
    motions[:, 3:, 3:] = np.eye(3)
    for way in range(3):
        motions[:, :3, 3 + way] = np.cross(np.eye(3)[way], places / size)
    # A bar takes no moment: a turn is held at frame members only.
    bends = np.zeros(len(places), dtype=bool)
    bends[structure["ends"][structure["frame"]]] = True
    fixed = structure["fixed"].copy()
    fixed[~bends, 3:] = False
    rows = [motions[fixed]]
    springs = zip(structure["spring_node"], structure["spring_dof"], strict=True)
    for (node, to), dof in springs:
        if to < 0 and (dof < 3 or bends[node]):
            rows.append(motions[node, dof][None])
    for node, along in zip(
        structure["inclined_node"], structure["inclined_direction"], strict=True
    ):
        rows.append(np.asarray(along @ motions[node, :3] / np.linalg.norm(along))[None])
    return np.concatenate(rows)
