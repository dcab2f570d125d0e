"""A plain NumPy solver of 3D frames and trusses: linear, static, dense.

Every member is described by six deformations (elongation, twist, and the rotation of
each end against the chord about both bending axes), so that its stiffness is
``B.T @ D @ B`` with ``D`` small. End springs add their flexibility to that of the beam.

Degrees of freedom: ``6 * node + (ux, uy, uz, rx, ry, rz)``, then scalar extras that only
springs reach.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
_BEAM_FLEXIBILITY = np.array([[1.0 / 3.0, -1.0 / 6.0], [-1.0 / 6.0, 1.0 / 3.0]])


class FrameSpring(NamedTuple):
    """Linear spring between two degrees of freedom, or to the ground where ``b`` is None."""

    a: int
    b: int | None
    stiffness: float  # [N/m] or [N m/rad]


class Stiffness(NamedTuple):
    """Cross-section stiffness of all members.

    ``ea`` [N], ``ei_y``, ``ei_z``, ``gj`` [N m2], each of shape [m]; ``end_spring``
    [N m/rad], shape [m]: 0 is a pinned (truss) member, inf a rigidly joined one.
    """

    ea: Array
    ei_y: Array
    ei_z: Array
    gj: Array
    end_spring: Array


class Solution(NamedTuple):
    """Answers to ``p`` load patterns.

    ``u`` [d, p] displacements [m, rad]; ``elongation`` [m, p] [m]; ``reaction`` [d, p]
    forces [N, N m] of the ground on the held degrees of freedom, zero elsewhere.
    """

    u: Array
    elongation: Array
    reaction: Array


@dataclass(frozen=True)
class Geometry:
    """Where members are: ``xyz`` [n, 3] [m], ``ends`` [m, 2] node indices.

    ``length`` [m] is of shape [m], ``modes`` [m, 6, 12] maps end displacements to the six
    deformations.
    """

    xyz: Array
    ends: NDArray[np.int64]
    length: Array
    modes: Array

    @classmethod
    def of(cls, xyz: Array, ends: NDArray[np.int64]) -> Geometry:
        span = xyz[ends[:, 1]] - xyz[ends[:, 0]]
        length = np.linalg.norm(span, axis=1)
        ex = span / length[:, None]
        # Local z lies in the vertical plane, but a vertical member has none: there y is global y.
        up = np.where(np.abs(ex[:, 2:]) > 0.999, [[-1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])
        ey = np.cross(up, ex)
        ey /= np.linalg.norm(ey, axis=1)[:, None]
        ez = np.cross(ex, ey)
        modes = np.zeros((len(ends), 6, 12))
        modes[:, 0, 0:3], modes[:, 0, 6:9] = -ex, ex
        modes[:, 1, 3:6], modes[:, 1, 9:12] = -ex, ex
        for first, axis, across in ((2, ez, ey), (4, ey, -ez)):
            slope = across / length[:, None]
            for row, rotation in ((first, 3), (first + 1, 9)):
                modes[:, row, rotation : rotation + 3] = axis
                modes[:, row, 0:3] += slope
                modes[:, row, 6:9] -= slope
        return cls(xyz, ends, length, modes)

    @property
    def dofs(self) -> NDArray[np.int64]:
        """Degrees of freedom of each member's two ends, shape [m, 12]."""
        six = np.arange(6)
        return np.hstack([6 * self.ends[:, :1] + six, 6 * self.ends[:, 1:] + six])


def deformation_stiffness(length: Array, s: Stiffness) -> Array:
    """Stiffness in the six deformations, shape [m, 6, 6]; only elongation where pinned."""
    d = np.zeros((len(length), 6, 6))
    d[:, 0, 0] = s.ea / length
    joined = s.end_spring > 0.0
    if not joined.any():
        return d
    d[joined, 1, 1] = (s.gj / length)[joined]
    joint = np.eye(2) / s.end_spring[joined, None, None]
    for first, ei in ((2, s.ei_z), (4, s.ei_y)):
        beam = (length / ei)[joined, None, None] * _BEAM_FLEXIBILITY
        d[joined, first : first + 2, first : first + 2] = np.linalg.inv(beam + joint)
    return d


@dataclass(frozen=True)
class Frame:
    """A structure ready to be loaded. ``held`` are the degrees of freedom at zero or settled."""

    geometry: Geometry
    stiffness: Array  # [d, d]
    ea: Array  # [m]
    free: NDArray[np.int64]
    held: NDArray[np.int64]

    @classmethod
    def build(
        cls,
        geometry: Geometry,
        section: Stiffness,
        held: set[int],
        springs: list[FrameSpring] | None = None,
        extra: int = 0,
    ) -> Frame:
        """Assemble; rotations that nothing stiffens are held as well."""
        size = 6 * len(geometry.xyz) + extra
        local = deformation_stiffness(geometry.length, section)
        blocks = geometry.modes.transpose(0, 2, 1) @ local @ geometry.modes
        k = np.zeros((size, size))
        dofs = geometry.dofs
        np.add.at(k, (dofs[:, :, None], dofs[:, None, :]), blocks)
        for a, b, value in springs or []:
            k[a, a] += value
            if b is not None:
                k[b, b] += value
                k[a, b] -= value
                k[b, a] -= value
        rotations = [6 * i + r for i in range(len(geometry.xyz)) for r in (3, 4, 5)]
        scale = float(np.max(np.diag(k)))
        idle = {r for r in rotations if k[r, r] < 1e-14 * scale}
        fixed = np.array(sorted(held | idle), dtype=np.int64)
        free = np.setdiff1d(np.arange(size), fixed)
        return cls(geometry, k, section.ea, free, fixed)

    def solve(self, force: Array, thermal: Array, settlement: Array | None = None) -> Solution:
        """Solve for ``p`` patterns at once.

        ``force`` [d, p] [N, N m]; ``thermal`` [m, p] free strain alpha dT [-];
        ``settlement`` [d, p] [m, rad], read at held degrees of freedom only.
        """
        total = force.copy()
        push = self.ea[:, None] * thermal
        axial = self.geometry.modes[:, 0, :]
        np.add.at(total, self.geometry.dofs, axial[:, :, None] * push[:, None, :])
        u = np.zeros_like(total)
        if settlement is not None:
            u[self.held] = settlement[self.held]
        right = total[self.free] - self.stiffness[np.ix_(self.free, self.held)] @ u[self.held]
        inner = self.stiffness[np.ix_(self.free, self.free)]
        u[self.free] = np.linalg.solve(inner, right)
        worst = np.abs(inner @ u[self.free] - right).max(initial=0.0)
        if not worst <= 1e-6 * max(np.abs(right).max(initial=0.0), 1e-9):
            raise ValueError("the structure is a mechanism: the solution leaves a residual")
        reaction = np.zeros_like(u)
        reaction[self.held] = self.stiffness[self.held] @ u - total[self.held]
        ends = u[self.geometry.dofs]
        return Solution(u, np.einsum("mk,mkp->mp", axial, ends), reaction)
