"""Whether supports hold a structure as a whole; what moves within it is for a solver to find."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.model.schema import DOFS

#: share of the largest singular value below which a motion is free
FREE = 1e-9
#: motions of a rigid body that a plane leaves: along its two axes, and about its normal
IN_PLANE = {"xz": (0, 2, 4), "xy": (0, 1, 5), "yz": (1, 2, 3)}


def free_motions(content: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Nodes of each part of a structure that supports do not hold, and how it can move.

    Args:
        content: a model file.

    Yields:
        Which nodes, in words, and how they move as a rigid body.
    """
    nodes = list(content["nodes"])
    number = {name: k for k, name in enumerate(nodes)}
    parts = _parts(content, number)
    held = _held(content)
    points = np.array(list(content["nodes"].values()), dtype=float).reshape(-1, 3)
    allowed = IN_PLANE.get(content.get("plane") or "", tuple(range(6)))
    for part in np.unique(parts):
        own = np.flatnonzero(parts == part)
        about = points[own].mean(axis=0)
        size = max(float(np.ptp(points[own], axis=0).max()), 1e-9)
        rows = [
            direction @ _motions((points[k] - about) / size)
            for k in own
            for direction in held.get(nodes[k], ())
        ]
        restraint = np.array(rows).reshape(-1, 6)[:, allowed]
        values = np.linalg.svd(restraint, full_matrices=True)
        rank = int((FREE * max(values.S.max(initial=0.0), 1e-300) < values.S).sum())
        if rank < len(allowed):
            motion = np.zeros(6)
            motion[list(allowed)] = values.Vh[-1]
            names = ", ".join(nodes[k] for k in own[:4]) + (" ..." if len(own) > 4 else "")
            yield f"nodes {names}" if len(own) > 1 else f"node {names}", _words(motion)


def _parts(content: Mapping[str, Any], number: dict[str, int]) -> FloatArray:
    """The part of each node: nodes that members, springs or ties join are of one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = [member["nodes"] for member in content["members"].values()]
    pairs += [(one["node"], one["to"]) for one in content.get("springs", ()) if one.get("to")]
    pairs += [tie["nodes"] for tie in content.get("ties", ())]
    ends = np.array([[number[a], number[b]] for a, b in pairs], dtype=int).reshape(-1, 2)
    size = len(number)
    joined = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(size, size))
    return np.asarray(connected_components(joined, directed=False)[1])


def _held(content: Mapping[str, Any]) -> dict[str, list[FloatArray]]:
    """Directions of the six motions of a node that supports and springs to the ground hold."""
    held: dict[str, list[FloatArray]] = {}
    unit = np.eye(6)
    for support in content["supports"].values():
        rows = [unit[DOFS.index(dof)] for dof in support.get("fixed", ())]
        if support.get("along"):
            rows.append(np.array([*support["along"], 0.0, 0.0, 0.0]))
        held.setdefault(support["node"], []).extend(rows)
    for spring in content.get("springs", ()):
        if not spring.get("to"):
            held.setdefault(spring["node"], []).append(unit[DOFS.index(spring["dof"])])
    return held


def _motions(place: FloatArray) -> FloatArray:
    """Motions of a point by six motions of a rigid body, float[6, 6]."""
    x, y, z = place
    motions = np.eye(6)
    motions[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return motions


def _words(motion: FloatArray) -> str:
    """A motion of a rigid body in words."""
    turn = motion[3:]
    if np.linalg.norm(turn) < 1e-6:
        return f"can move along {_axis(motion[:3])}"
    return f"can turn about an axis along {_axis(turn)}"


def _axis(vector: FloatArray) -> str:
    axis = vector / np.linalg.norm(vector)
    k = int(np.argmax(np.abs(axis)))
    if abs(axis[k]) > 1 - 1e-9:
        return "xyz"[k]
    return "(" + ", ".join(f"{value:.3g}" for value in axis * np.sign(axis[k])) + ")"
