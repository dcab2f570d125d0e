"""Natural frequencies and shapes of a reality, dense, in plain NumPy and SciPy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import linear_sum_assignment

from rga_bench.field.solver import Array, Bars, stiffness
from rga_bench.field.world import FieldWorld
from rga_bench.swinging.masses import Masses

#: of the largest stiffness: a rotation with less is held, since nothing turns with it
_IDLE = 1e-12
#: share of the kinetic energy at the nodes of a mode that a campaign finds, at first and once it
#: has changed: where it is less, members swing between nodes that stand still
_AT_FIRST, _LATER = 0.6, 0.2
#: modes beyond those that were there, among which these are looked for after a change
_MORE = 60


@dataclass
class SwingingWorld:
    """A reality with its masses; ``clock``: factor on frequencies as they are read."""

    world: FieldWorld
    masses: Masses
    clock: float = 1.0

    def copy(self) -> SwingingWorld:
        """An independent copy."""
        masses = Masses(self.masses.line.copy(), self.masses.nodal.copy())
        return SwingingWorld(self.world.copy(), masses, self.clock)


@dataclass(frozen=True)
class Vibrations:
    """Modes: frequencies as they are read [k] [Hz], and shapes [k, nodes, 3]."""

    frequencies: Array
    shapes: Array

    def like(self, others: Vibrations) -> Vibrations:
        """For every mode of others the one of these that is most like it, each taken once.

        By the assurance criterion of the shapes, less how far the frequencies lie apart.
        """
        ours = self.shapes.reshape(len(self.shapes), -1)
        theirs = others.shapes.reshape(len(others.shapes), -1)
        alike = (theirs @ ours.T) ** 2
        alike /= np.outer((theirs**2).sum(axis=1), (ours**2).sum(axis=1))
        far = np.abs(np.log(np.divide.outer(others.frequencies, self.frequencies)))
        _, order = linear_sum_assignment(far - alike)
        return Vibrations(self.frequencies[order], self.shapes[order])


def changed(swinging: SwingingWorld, before: Vibrations) -> Vibrations:
    """What modes have become in a reality that has changed; they may have traded places."""
    return vibrations(swinging, len(before.frequencies) + _MORE, _LATER).like(before)


def vibrations(swinging: SwingingWorld, count: int, least: float = _AT_FIRST) -> Vibrations:
    """The lowest modes that have at least a share of their kinetic energy at the nodes."""
    world, masses = swinging.world, swinging.masses
    matrix, turned = stiffness(world.xyz, world.bars)
    for dof, value in world.springs.items():
        matrix[dof, dof] += value
    mass = _mass(world.xyz, world.bars, turned, masses)
    turns = np.arange(len(matrix)) % 6 >= 3
    still = turns & (np.diag(matrix) < _IDLE * np.diag(matrix).max())
    free = np.setdiff1d(np.flatnonzero(~still), sorted(world.held))
    # 1 / w^2 and not w^2: what has no mass is at zero, not beyond all bounds.
    inverse, vectors = eigh(mass[np.ix_(free, free)], matrix[np.ix_(free, free)])
    shapes = np.zeros((len(free), len(matrix)))
    shapes[:, free] = vectors.T[::-1]
    inverse = inverse[::-1]
    at_nodes = _lumped(world, masses)
    moves = shapes.reshape(len(shapes), -1, 6)[:, :, :3]
    # The modes have unit stiffness: twice their kinetic energy is the square of 1 / w.
    share = np.einsum("kna,n->k", moves**2, at_nodes) / np.maximum(inverse, 1e-300)
    seen = np.flatnonzero((share > least) & (inverse > 1e-9 * inverse[0]))[:count]
    return Vibrations(
        swinging.clock / (2.0 * np.pi * np.sqrt(inverse[seen])),
        moves[seen] / np.abs(moves[seen]).max(axis=(1, 2), keepdims=True),
    )


def _lumped(world: FieldWorld, masses: Masses) -> Array:
    """Mass at every node, half of its members with it [kg]."""
    ends = world.bars.ends
    length = np.linalg.norm(world.xyz[ends[:, 1]] - world.xyz[ends[:, 0]], axis=1)
    total = masses.nodal.copy()
    for side in (0, 1):
        np.add.at(total, ends[:, side], 0.5 * masses.line * length)
    return total


def _mass(xyz: Array, bars: Bars, turned: Array, masses: Masses) -> Array:
    """Consistent mass [d, d] (Przemieniecki, Theory of Matrix Structural Analysis, 1968)."""
    total = np.zeros((6 * len(xyz),) * 2)
    for k, (i, j) in enumerate(bars.ends):
        length = float(np.linalg.norm(xyz[j] - xyz[i]))
        own = turned[k].T @ _member(masses.line[k] * length, length, bars, k) @ turned[k]
        where = np.r_[6 * i : 6 * i + 6, 6 * j : 6 * j + 6]
        total[np.ix_(where, where)] += own
    for node, value in enumerate(masses.nodal):
        at = 6 * node + np.arange(3)
        total[at, at] += value
    return total


def _member(weight: float, length: float, bars: Bars, k: int) -> Array:
    """Mass of a member of so many kg in its axes, [12, 12]; with gussets, of what bends."""
    out = np.zeros((12, 12))
    line = weight / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
    out[np.ix_((0, 6), (0, 6))] = line
    if bars.pinned[k]:
        for axis in (1, 2):
            out[np.ix_((axis, axis + 6), (axis, axis + 6))] = line
        return out
    turning = float((bars.ei_y[k] + bars.ei_z[k]) / bars.ea[k])
    out[np.ix_((3, 9), (3, 9))] = turning * line
    clear = length - 2.0 * bars.zone[k]
    swing = (
        weight
        / 420.0
        * np.array(
            [
                [156.0, 22.0 * clear, 54.0, -13.0 * clear],
                [22.0 * clear, 4.0 * clear**2, 13.0 * clear, -3.0 * clear**2],
                [54.0, 13.0 * clear, 156.0, -22.0 * clear],
                [-13.0 * clear, -3.0 * clear**2, -22.0 * clear, 4.0 * clear**2],
            ]
        )
    )
    for where, sign in (((1, 5, 7, 11), 1.0), ((2, 4, 8, 10), -1.0)):
        turn = np.array([1.0, sign, 1.0, sign])
        out[np.ix_(where, where)] = turn[:, None] * swing * turn
    return out
