"""Motions of a structure that deform no member: which parts of it are loose.

A motion u of all nodes is free where C u = 0. The rows of C are the deformations of the members,
the springs, the ties and what supports hold (Pellegrino and Calladine, Int. J. Solids Structures
22 (1986) 409). Their null space is found by singular values where it is small, and by the smallest
eigenvalues of C'C where it is large.
"""

from collections.abc import Iterator

import numpy as np
from scipy.linalg import qr
from scipy.sparse import csc_array, csr_array, eye_array
from scipy.sparse.linalg import ArpackError, eigsh

from rga.arrays import FloatArray, StructureArrays
from rga.model.axes import local_axes
from rga.numerics.decompositions import thin_svd

#: degrees of freedom up to which all free motions are found
FEW = 600
#: free motions that are looked for among more
MOST_MOTIONS = 12
#: deformation of a motion of size one, below which it is free; its square among many
FREE, FREE_ENERGY = 1e-9, 1e-13
#: shift of the eigenvalues, so that there is a factor
SHIFT = 1e-10
#: share of the largest component below which a node does not move
STILL = 1e-6

#: a deformation: degree of freedom (node * 6 + dof) -> coefficient
Row = dict[int, float]


def free_motions(structure: StructureArrays) -> FloatArray:
    """Independent motions that nothing resists, each as local as may be.

    Rotations that nothing stiffens are held, as the solver holds them.

    Args:
        structure: coordinates, members, supports, springs and ties.

    Returns:
        float[motions, nodes, 6], the largest component of each one; rotations times a length of
        the structure. Of a large structure the first `MOST_MOTIONS`.
    """
    nodes = len(structure["coordinates"])
    rows = [*_of_members(structure), *_of_restraints(structure)]
    length = _length(structure)
    rows = [{dof: c / length if dof % 6 > 2 else c for dof, c in row.items()} for row in rows]
    rows += _idle_turns(rows, nodes)
    held = structure["fixed"].ravel()
    free = np.flatnonzero(~held)
    if not len(free):
        return np.zeros((0, nodes, 6))
    matrix = _matrix(rows, 6 * nodes)[:, free]
    basis = _null_space(matrix)
    motions = np.zeros((basis.shape[1], 6 * nodes))
    motions[:, free] = _localised(basis).T
    return motions.reshape(-1, nodes, 6)


def _length(structure: StructureArrays) -> float:
    ends = structure["coordinates"][structure["ends"]]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return float(np.median(lengths)) if len(lengths) else 1.0


def _of_members(structure: StructureArrays) -> Iterator[Row]:
    members = np.arange(len(structure["ends"]))
    lengths, axes = local_axes(structure, members)
    for member in members:
        first, last = (6 * int(node) for node in structure["ends"][member])
        if not structure["frame"][member]:
            along = axes[member, 0]
            yield {
                **{first + k: -float(c) for k, c in enumerate(along)},
                **{last + k: float(c) for k, c in enumerate(along)},
            }
            continue
        turned = np.kron(np.eye(4), axes[member])
        for row in _deformations(structure, int(member), float(lengths[member])) @ turned:
            yield {
                (first if k < 6 else last - 6) + k: float(c) for k, c in enumerate(row) if c != 0.0
            }


def _deformations(structure: StructureArrays, member: int, length: float) -> FloatArray:
    """Deformations of a frame member that ask for a force, by its end dofs, float[n, 12].

    Its axial stretch, its twist, and the turn of both ends against the chord in each plane.
    """
    rows = [np.eye(12)[6] - np.eye(12)[0]]
    if structure["J"][member] > 0:
        rows.append((np.eye(12)[9] - np.eye(12)[3]) * length)
    for stiffness, across, turn, sign in (("Iz", 1, 5, 1.0), ("Iy", 2, 4, -1.0)):
        if structure[stiffness][member] > 0:  # type: ignore[literal-required]
            chord = np.eye(12)[across + 6] - np.eye(12)[across]
            rows += [sign * length * np.eye(12)[turn + end] - chord for end in (0, 6)]
    found = np.array(rows)
    released = structure["connection"][member] == 0.0
    if released.any():
        # What a released end does inside the member deforms it no more.
        left, size, _ = np.linalg.svd(found[:, released])
        rank = int((size > FREE * max(size.max(), 1e-300)).sum())
        found = left[:, rank:].T @ found
        found[:, released] = 0.0
    return found


def _of_restraints(structure: StructureArrays) -> Iterator[Row]:
    for (node, to), dof in zip(structure["spring_node"], structure["spring_dof"], strict=True):
        row = {6 * int(node) + int(dof): 1.0}
        yield row if to < 0 else {**row, 6 * int(to) + int(dof): -1.0}
    for (node, to), dof in zip(structure["tie_node"], structure["tie_dof"], strict=True):
        yield {6 * int(node) + int(dof): 1.0, 6 * int(to) + int(dof): -1.0}
    for node, along in zip(
        structure["inclined_node"], structure["inclined_direction"], strict=True
    ):
        unit = along / np.linalg.norm(along)
        yield {6 * int(node) + k: float(c) for k, c in enumerate(unit)}


def _idle_turns(rows: list[Row], nodes: int) -> list[Row]:
    """Rows that hold what no other row turns, node by node."""
    stiff = np.zeros((nodes, 3, 3))
    for row in rows:
        for dof, c in row.items():
            if dof % 6 > 2:
                turns = [row.get(dof - dof % 6 + 3 + k, 0.0) for k in range(3)]
                stiff[dof // 6, dof % 6 - 3] += c * np.array(turns)
    values, directions = np.linalg.eigh(stiff)
    idle = values <= FREE * np.maximum(values[:, -1:], 1e-300)
    return [
        {6 * int(node) + 3 + k: float(c) for k, c in enumerate(directions[node, :, number])}
        for node, number in np.argwhere(idle)
    ]


def _matrix(rows: list[Row], columns: int) -> csr_array:
    entries = [(number, dof, c) for number, row in enumerate(rows) for dof, c in row.items()]
    at, dof, value = zip(*entries, strict=True) if entries else ((), (), ())
    return csr_array((value, (at, dof)), shape=(len(rows), columns), dtype=float)


def _null_space(matrix: csr_array) -> FloatArray:
    """Directions that a matrix takes to nothing, float[columns, directions]."""
    columns = matrix.shape[1]
    if columns <= FEW:
        dense = np.vstack(
            [matrix.toarray(), np.zeros((max(0, columns - matrix.shape[0]), columns))]
        )
        _, size, directions = thin_svd(dense)
        return np.asarray(directions[size <= FREE * max(size.max(initial=0.0), 1e-300)].T)
    energy = csc_array(matrix.T @ matrix)
    largest = float(energy.diagonal().max(initial=0.0))
    shifted = energy / max(largest, 1e-300) + SHIFT * eye_array(columns, format="csc")
    start = np.random.default_rng(0).normal(size=columns)
    try:
        values, directions = eigsh(shifted, k=MOST_MOTIONS, sigma=0.0, v0=start)
    except (ArpackError, RuntimeError):
        return np.zeros((columns, 0))
    return np.asarray(directions[:, values - SHIFT <= FREE_ENERGY])


def _localised(basis: FloatArray) -> FloatArray:
    """The same directions, each with a degree of freedom of its own in which no other moves."""
    if not basis.shape[1]:
        return basis
    _, _, pivots = qr(basis.T, mode="economic", pivoting=True)
    local = basis @ np.linalg.inv(basis[pivots[: basis.shape[1]]])
    local = local / np.abs(local).max(axis=0)
    return np.where(np.abs(local) > STILL, local, 0.0)
