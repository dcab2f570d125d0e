"""The deformed shape of members, from what their end nodes do."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.drawing.scene.scene import Scene
from rga.model.schema import Dof

#: places along a frame member at which its curve is drawn
STATIONS = 13
#: the largest displacement, as a share of the extent of the structure, that a drawing aims at
SHARE = 0.06
TURNS: tuple[Dof, Dof, Dof] = ("rx", "ry", "rz")


@dataclass(frozen=True)
class Deformed:
    """A deformed structure.

    Attributes:
        curves: displacements along every member, float[members, stations, 3] [m].
        scale: by which a drawing enlarges them.
        largest: of the nodes' displacements [m].
        at: name of the node where it is.
    """

    curves: FloatArray
    scale: float
    largest: float
    at: str


def deformed(scene: Scene, displacements: FloatArray, scale: float | None = None) -> Deformed:
    """The shape that displacements of nodes give.

    Args:
        scene: the structure.
        displacements: of the nodes, float[nodes, 6] [m, rad].
        scale: None: a round one, by which the largest displacement is easily seen.
    """
    sizes = np.linalg.norm(displacements[:, :3], axis=1)
    node = int(np.argmax(sizes))
    largest = float(sizes[node])
    if scale is None:
        scale = round_scale(SHARE * scene.extent / largest) if largest > 0 else 1.0
    curves = member_curves(scene, displacements)
    return Deformed(curves, scale, largest, list(scene.nodes)[node])


def round_scale(value: float) -> float:
    """The largest of 1, 2, 5, 10, 20... that is no more than a value, and 1 at least.

    >>> round_scale(333.0), round_scale(0.3)
    (200.0, 1.0)
    """
    power = 10.0 ** np.floor(np.log10(max(value, 1.0)))
    return float(power * next(step for step in (5, 2, 1) if step * power <= max(value, 1.0)))


def member_curves(scene: Scene, displacements: FloatArray) -> FloatArray:
    """Displacements along every member, float[members, stations, 3] [m].

    A bar stays straight. The axis of a frame member is the cubic that meets displacements and
    rotations of its ends: exact for a slender member without loads between its nodes
    (Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 5.6). At a released or
    yielding end the rotation is that of the member, not of the node.

    Args:
        scene: the structure.
        displacements: of the nodes, float[nodes, 6] [m, rad].
    """
    ends = displacements[scene.ends]
    shares = np.linspace(0.0, 1.0, STATIONS)
    straight = ends[:, :1, :3] + shares[:, None] * (ends[:, 1:, :3] - ends[:, :1, :3])
    members = np.flatnonzero(scene.frame)
    if not len(members):
        return np.asarray(straight)
    axes, chosen = scene.axes[members], ends[members]
    lengths = np.linalg.norm(np.diff(scene.points[scene.ends[members]], axis=1)[:, 0], axis=1)
    moves = np.einsum("mij,mej->mei", axes, chosen[:, :, :3])
    turns = np.einsum("mij,mej->mei", axes, chosen[:, :, 3:])
    bowed = np.zeros((len(members), STATIONS, 3))
    # A rotation about z raises y along the member; one about y lowers z.
    for across, about, sign, stiffness in ((1, 2, 1.0, "Iz"), (2, 1, -1.0, "Iy")):
        chord = (moves[:, 1, across] - moves[:, 0, across]) / lengths
        slopes = _end_slopes(scene, members, sign * turns[:, :, about], chord, stiffness, about)
        first, last = (slopes - chord[:, None]).T * lengths
        bow = np.outer(first, shares * (1 - shares) ** 2) - np.outer(last, shares**2 * (1 - shares))
        bowed += bow[:, :, None] * axes[:, None, across]
    curves = straight.copy()
    curves[members] += bowed
    return np.asarray(curves)


def _end_slopes(
    scene: Scene, members: IntArray, nodes: FloatArray, chord: FloatArray, inertia: str, dof: int
) -> FloatArray:
    """Slopes of members at their ends, float[members, 2], where connections may yield.

    The connection's moment k (node - slope) is that of the beam, EI/L (4 own + 2 other - 6 chord).
    """
    slopes = np.array(nodes)
    every = list(scene.model.members.values())
    name: Dof = TURNS[dof]
    for row, member in enumerate(members):
        one = every[int(member)]
        stiffness = [
            0.0 if name in released else springs.get(name, np.inf)
            for released, springs in (
                (one.releases.i, one.end_springs.i),
                (one.releases.j, one.end_springs.j),
            )
        ]
        if np.isinf(stiffness).all():
            continue
        section = scene.model.sections[one.section]
        first, last = scene.points[scene.ends[int(member)]]
        bending = scene.model.materials[one.material].E * getattr(section, inertia)
        bending /= float(np.linalg.norm(last - first))
        matrix, right = np.zeros((2, 2)), np.zeros(2)
        for end, k in enumerate(stiffness):
            if np.isinf(k) or bending == 0:
                matrix[end, end], right[end] = 1.0, nodes[row, end]
                continue
            matrix[end, end] = 4 * bending + k
            matrix[end, 1 - end] = 2 * bending
            right[end] = 6 * bending * chord[row] + k * nodes[row, end]
        slopes[row] = np.linalg.solve(matrix, right)
    return slopes
