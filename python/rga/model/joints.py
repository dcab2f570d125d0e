"""Where frame members are joined to others, and where they merely run on."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.model.schema import Model

#: sine of the angle between two members below which one runs on as the other
STRAIGHT = 1e-3
#: how much more upright the steepest member of a joint has to be, as a sine
STEEPER = 1e-6


def run_on(coordinates: FloatArray, ends: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Ends at which a member goes on in a straight line as another one: no joint.

    Args:
        coordinates: float[nodes, 3] [m].
        ends: nodes of frame members, int[members, 2].

    Returns:
        bool[members, 2].
    """
    along = coordinates[ends[:, 1]] - coordinates[ends[:, 0]]
    along = along / np.linalg.norm(along, axis=1)[:, None]
    # Away from the node, at either end.
    nodes, away = ends.T.ravel(), np.concatenate([along, -along])
    opposite = np.linalg.norm(away[:, None] + away, axis=2) < STRAIGHT
    straight = (opposite & (nodes[:, None] == nodes)).any(axis=1)
    return np.asarray(straight.reshape(2, -1).T)


def joints(model: Model) -> dict[str, list[str]]:
    """Ends of frame members at which a joint may yield: "i", "j" or both, by member.

    Of the members that meet at a node where none runs through, the steepest is what the others are
    joined to: a column. The base of a column is its support's affair.
    """
    names = [name for name, member in model.members.items() if member.kind == "frame"]
    numbers = {node: number for number, node in enumerate(model.nodes)}
    points = np.array(list(model.nodes.values()), dtype=float).reshape(-1, 3)
    pairs = [[numbers[node] for node in model.members[name].nodes] for name in names]
    ends = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    straight = run_on(points, ends)
    upright = np.abs(points[ends[:, 1], 2] - points[ends[:, 0], 2])
    upright /= np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    found: dict[str, list[str]] = {}
    for node in np.unique(ends):
        member, end = np.nonzero(ends == node)
        joined = ~straight[member, end]
        if joined.all():
            joined[np.argmax(upright[member] > upright[member].max() - STEEPER)] = False
        for one, side in zip(member[joined], end[joined], strict=True):
            if _stiff(model, names[one], "ij"[side]):
                found.setdefault(names[one], []).append("ij"[side])
    return {name: sorted(found[name]) for name in names if name in found}


def _stiff(model: Model, name: str, end: str) -> bool:
    """Whether an end passes on bending as if it were welded."""
    member = model.members[name]
    released = member.releases.i if end == "i" else member.releases.j
    springs = member.end_springs.i if end == "i" else member.end_springs.j
    return not {"ry", "rz"} & {*released, *springs}
