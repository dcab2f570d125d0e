"""Stiffness of members and springs as a sum of terms of rank one.

A term of stiffness k and elongation v = b . u carries the force k (v - v0) along b. A truss member
or a spring is one term. A frame member is up to six, its natural modes of deformation: it grows
longer, twists, and in each of its two planes bends evenly and to both sides (Argyris et al., On
the geometrical stiffness of a beam in space, Comput. Methods Appl. Mech. Eng. 20, 1979). A release
leaves a plane one mode fewer.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray, IntArray
from rga.model.axes import local_axes

Arrays = dict[str, NDArray[Any]]
STRAIN = 2
#: modes that share dofs of a member: longer, twisted, bent in the x-y plane, bent in the x-z plane
BLOCKS = ([0], [1], [2, 3], [4, 5])
#: what is left of a release that others imply
NEGLIGIBLE = 1e-9


@dataclass(frozen=True)
class Terms:
    """Terms of the members and springs of a list: members first, then springs, then gauges.

    The modes of a frame member are scaled so that each has the stiffness E. A gauge on a frame
    member is a term too: under a load between the ends it reads a strain of 1 / E that does not
    hang on how the ends move.

    Attributes:
        element: place of each in the list, int[terms].
        member: number of the member, int[terms]; -1 for a spring and for a gauge.
        gauge: the output that a gauge gives, int[terms]; -1 for all others.
        stiffness: float[terms]; EA / L of a truss member [N/m], E of modes and gauges [Pa], of a
            spring its own [N/m or N m/rad].
        nodes: int[terms, 2]; -1 for the ground.
        motion: b, elongation by the displacements of both nodes, float[terms, 12].
        local: b in the axes of the member, float[terms, 12].
        rest: v0 by the initial strain of the member and its gradients, float[terms, 3].
    """

    element: IntArray
    member: IntArray
    gauge: IntArray
    stiffness: FloatArray
    nodes: IntArray
    motion: FloatArray
    local: FloatArray
    rest: FloatArray

    def __getitem__(self, chosen: NDArray[np.bool_]) -> "Terms":
        return Terms(*(array[chosen] for array in vars(self).values()))

    def __len__(self) -> int:
        return len(self.element)


def stiffness_terms(
    structure: Arrays,
    outputs: Arrays,
    members: IntArray,
    springs: IntArray,
    axial: bool = False,
) -> tuple[Terms, Terms]:
    """Terms that can stretch, and modes of frame members that supports hold still.

    Args:
        structure, outputs: as `_core.respond` takes them.
        members, springs: numbers of those whose terms are wanted; no end of a member yields.
        axial: of frame members too only that they grow longer.
    """
    bends = structure["frame"][members] & (not axial)
    parts = [_of_members(structure, members, bends), _of_springs(structure, springs, len(members))]
    frames = np.flatnonzero(bends)
    parts.append(_of_gauges(structure, outputs, members, frames))
    every = Terms(*map(np.concatenate, zip(*(vars(part).values() for part in parts), strict=True)))
    free = ~structure["fixed"][every.nodes].reshape(-1, 12)
    held = np.isin(every.element, frames) & (every.gauge < 0) & ~(every.motion * free).any(axis=1)
    return every[~held], every[held]


def _of_members(structure: Arrays, members: IntArray, frame: NDArray[np.bool_]) -> Terms:
    lengths, axes = local_axes(structure, members)
    rigid = structure["rigid_end"][members].sum(axis=1)
    elastic = lengths - np.where(structure["frame"][members], rigid, 0.0)
    local = np.zeros((len(members), 6, 12))
    rest = np.zeros((len(members), 6, 3))
    local[:, 0, [0, 6]] = [-1.0, 1.0]
    rest[:, 0, 0] = elastic
    there = np.zeros((len(members), 6), dtype=bool)
    there[:, 0] = ~frame
    own, free = structure["E"][members], structure["connection"][members] == 0
    own = np.where(frame, own, own * structure["A"][members] / elastic)
    for number in np.flatnonzero(frame):
        modes, of_strain = _modes(structure, int(members[number]), lengths[number], free[number])
        there[number, : len(modes)] = True
        local[number, : len(modes)], rest[number, : len(modes)] = modes, of_strain
    element, mode = np.nonzero(there)
    local, axes = local[element, mode], axes[element]
    return Terms(
        element=element,
        member=members[element],
        gauge=np.full(len(element), -1),
        stiffness=own[element],
        nodes=structure["ends"][members[element]],
        motion=(local.reshape(-1, 4, 3) @ axes).reshape(-1, 12),
        local=local,
        rest=rest[element, mode],
    )


def _modes(
    structure: Arrays, member: int, length: float, released: NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Of a frame member: elongations by its local end dofs, and by initial strains."""

    def of(name: str) -> float:
        return float(structure[name][member])

    rigid = structure["rigid_end"][member]
    length = length - rigid.sum()
    modes, rest, shape = np.zeros((6, 12)), np.zeros((6, 3)), np.zeros(6)
    modes[0, [0, 6]] = modes[1, [3, 9]] = [-1.0, 1.0]
    shape[:2] = of("A"), of("G") / of("E") * of("J")
    rest[0, 0] = length
    # In the x-z plane the slope dw/dx is -ry.
    for plane, (second, area, sign) in enumerate((("Iz", "Asy", 1.0), ("Iy", "Asz", -1.0))):
        even, odd = BLOCKS[2 + plane]
        slopes = [5 - plane, 11 - plane]
        modes[even, slopes] = [-sign, sign]
        modes[odd, slopes] = sign
        modes[odd, [1 + plane, 7 + plane]] = 2 / length, -2 / length
        rest[even, 1 + plane] = -length
        shear = 12 * of("E") * of(second) / (of("G") * of(area) * length**2) if of(second) else 0.0
        shape[even], shape[odd] = of(second), 3 * of(second) / (1 + shear)
    scale = np.sqrt(shape / length)[:, None]
    modes, rest = modes * scale, rest * scale
    kept = []
    for block in BLOCKS:
        block = [mode for mode in block if shape[mode] > 0]
        # No force may act along a released dof: left is what is across its row.
        rows = modes[block][:, released].T
        sizes = np.linalg.norm(rows, axis=1)
        rows = rows[sizes > 0] / sizes[sizes > 0, None]
        _, values, across = np.linalg.svd(rows)
        basis = across[(values > NEGLIGIBLE).sum() :]
        kept.append((basis @ modes[block], basis @ rest[block]))
    modes, rest = (np.concatenate(part) for part in zip(*kept, strict=True))
    for face, node, reach in ((1, 5, rigid[0]), (7, 11, -rigid[1])):
        modes[:, node] += reach * modes[:, face]
        modes[:, node - 1] -= reach * modes[:, face + 1]
    return modes, rest


def _of_springs(structure: Arrays, springs: IntArray, first: int) -> Terms:
    motion = np.zeros((len(springs), 12))
    nodes = structure["spring_node"][springs][:, ::-1]
    rows, dof = np.arange(len(springs)), structure["spring_dof"][springs]
    motion[rows, 6 + dof] = 1.0
    motion[rows, dof] = np.where(nodes[:, 0] < 0, 0.0, -1.0)
    return Terms(
        element=first + rows,
        member=np.full(len(springs), -1),
        gauge=np.full(len(springs), -1),
        stiffness=structure["spring_stiffness"][springs],
        nodes=nodes,
        motion=motion,
        local=np.zeros_like(motion),
        rest=np.zeros((len(springs), 3)),
    )


def _of_gauges(structure: Arrays, outputs: Arrays, members: IntArray, frames: IntArray) -> Terms:
    reads = (outputs["kind"] == STRAIN) & (outputs["index"] == members[frames, None])
    element, gauge = np.nonzero(reads)
    nothing = np.zeros((len(gauge), 12))
    return Terms(
        element=frames[element],
        member=np.full(len(gauge), -1),
        gauge=gauge,
        stiffness=structure["E"][members[frames[element]]],
        nodes=np.full((len(gauge), 2), -1),
        motion=nothing,
        local=nothing,
        rest=nothing[:, :3],
    )
