"""Modes and motion of a model by textbook matrices and dense solvers: nothing of the product."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.linalg import eigh

from rga.arrays import FloatArray, IntArray
from rga.model import Model

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")


def dense_modes(model: Model) -> FloatArray:
    """All natural frequencies [Hz] of bars and Euler-Bernoulli beams without releases."""
    return dense_mode_shapes(model, None)[0]


def dense_mode_shapes(model: Model, count: int | None) -> tuple[FloatArray, FloatArray]:
    """The lowest of these, or all, with their shapes: float[modes], float[modes, dofs]."""
    stiffness, mass, free = _matrices(model)
    # 1 / w^2 and not w^2: what has no mass is at zero, not beyond all bounds.
    largest, vectors = eigh(mass[np.ix_(free, free)], stiffness[np.ix_(free, free)])
    heavy = np.flatnonzero(largest > 1e-9 * largest.max())[::-1][:count]
    shapes = np.zeros((len(heavy), len(stiffness)))
    shapes[:, free] = vectors[:, heavy].T
    return np.asarray(1 / np.sqrt(largest[heavy]) / (2 * np.pi)), shapes


def dense_motion(model: Model, forces: Mapping[str, Sequence[float]]) -> FloatArray:
    """Motion of all nodes [m, rad] under forces on some [N], float[nodes, 6]."""
    stiffness, _, free = _matrices(model)
    pushed = np.zeros(len(stiffness))
    for node, force in forces.items():
        pushed[6 * list(model.nodes).index(node) + np.arange(3)] = force
    motion = np.zeros(len(stiffness))
    motion[free] = np.linalg.solve(stiffness[np.ix_(free, free)], pushed[free])
    return motion.reshape(-1, 6)


def _matrices(model: Model) -> tuple[FloatArray, FloatArray, IntArray]:
    """Stiffness and mass of all degrees of freedom, and which of these are free."""
    numbers = {name: 6 * at for at, name in enumerate(model.nodes)}
    size = 6 * len(numbers)
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    for member in model.members.values():
        k, m = _member(model, member)
        dofs = np.concatenate([numbers[node] + np.arange(6) for node in member.nodes])
        stiffness[np.ix_(dofs, dofs)] += k
        mass[np.ix_(dofs, dofs)] += m
    for spring in model.springs:
        at = numbers[spring.node] + DOFS.index(spring.dof)
        stiffness[at, at] += spring.stiffness
    for one in model.masses.values():
        if one.node is not None:
            at = numbers[one.node]
            mass[range(at, at + 6), range(at, at + 6)] += [one.mass] * 3 + list(one.inertia)
    held = [
        numbers[support.node] + DOFS.index(dof)
        for support in model.supports.values()
        for dof in support.fixed
    ]
    out_of_plane = {"xy": (2, 3, 4), "xz": (1, 3, 5), "yz": (0, 4, 5), None: ()}[model.plane]
    held += [at + dof for at in numbers.values() for dof in out_of_plane]
    free = np.setdiff1d(np.flatnonzero(stiffness.diagonal() > 0), held)
    return stiffness, mass, free


def _member(model: Model, member: object) -> tuple[FloatArray, FloatArray]:
    """Stiffness and consistent mass (Przemieniecki, Theory of Matrix Structural Analysis, 1968)."""
    first, last = (np.array(model.nodes[node]) for node in member.nodes)  # type: ignore[attr-defined]
    section = model.sections[member.section]  # type: ignore[attr-defined]
    material = model.materials[member.material]  # type: ignore[attr-defined]
    length = float(np.linalg.norm(last - first))
    x = (last - first) / length
    up = np.array([0.0, 0.0, 1.0])
    y = np.cross(up, x) if abs(x @ up) < 1 - 1e-9 else np.array([0.0, 1.0, 0.0])
    y /= np.linalg.norm(y)
    axes = np.kron(np.eye(4), np.array([x, y, np.cross(x, y)]))
    line = material.density * section.A + sum(
        one.per_length or 0.0
        for one in model.masses.values()
        if one.group in member.groups  # type: ignore[attr-defined]
    )
    k, m = np.zeros((12, 12)), np.zeros((12, 12))
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    along = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6
    k[np.ix_([0, 6], [0, 6])] = material.E * section.A / length * bar
    m[np.ix_([0, 6], [0, 6])] = line * length * along
    if member.kind == "truss":  # type: ignore[attr-defined]
        for axis in (1, 2):
            m[np.ix_([axis, axis + 6], [axis, axis + 6])] = line * length * along
        return axes.T @ k @ axes, axes.T @ m @ axes
    shear = material.E / (2 * (1 + material.nu))
    k[np.ix_([3, 9], [3, 9])] = shear * section.J / length * bar
    m[np.ix_([3, 9], [3, 9])] = material.density * (section.Iy + section.Iz) * length * along
    l1, l2 = length, length**2
    bend = np.array(
        [
            [12, 6 * l1, -12, 6 * l1],
            [6 * l1, 4 * l2, -6 * l1, 2 * l2],
            [-12, -6 * l1, 12, -6 * l1],
            [6 * l1, 2 * l2, -6 * l1, 4 * l2],
        ]
    )
    swing = np.array(
        [
            [156, 22 * l1, 54, -13 * l1],
            [22 * l1, 4 * l2, 13 * l1, -3 * l2],
            [54, 13 * l1, 156, -22 * l1],
            [-13 * l1, -3 * l2, -22 * l1, 4 * l2],
        ]
    )
    for inertia, dofs, signs in (
        (section.Iz, [1, 5, 7, 11], [1, 1, 1, 1]),
        (section.Iy, [2, 4, 8, 10], [1, -1, 1, -1]),
    ):
        sign = np.outer(signs, signs)
        k[np.ix_(dofs, dofs)] = material.E * inertia / length**3 * bend * sign
        m[np.ix_(dofs, dofs)] = line * length / 420 * swing * sign
    return axes.T @ k @ axes, axes.T @ m @ axes
