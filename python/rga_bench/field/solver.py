"""Linear frames and trusses in space by the displacement method, dense, in plain NumPy.

Written for this generator alone: it imports nothing of the simulator, nor of the other
generator's physics. Every member has a stiffness of 12 x 12 in its own axes between the ends of
two rigid lengths (gussets); a pinned member has an axial stiffness only.

Degrees of freedom: ``6 * node + (ux, uy, uz, rx, ry, rz)``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
#: of the largest stiffness: a rotation with less is held, since nothing turns with it
_IDLE = 1e-12


@dataclass
class Bars:
    """Members, all arrays over them.

    ``ends`` [m, 2] nodes; ``axes`` [m, 3, 3] unit vectors x, y, z of each; ``ea`` [N], ``ei_y``,
    ``ei_z``, ``gj`` [N m2]; ``alpha`` [1/K]; ``pinned``: no moments at the ends; ``zone`` [m]:
    length at each end that does not bend; all [m].
    """

    ends: NDArray[np.int64]
    axes: Array
    ea: Array
    ei_y: Array
    ei_z: Array
    gj: Array
    alpha: Array
    pinned: NDArray[np.bool_]
    zone: Array


def axes_of(span: Array, across: Array | None) -> Array:
    """Unit vectors [3, 3] of a member along ``span``; y as given, else level."""
    x = span / np.linalg.norm(span)
    if across is None:
        up = np.array([0.0, 0.0, 1.0]) if abs(x[2]) < 0.999 else np.array([-1.0, 0.0, 0.0])
        across = np.cross(up, x)
    y = across - (across @ x) * x
    y = y / np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)])


def stiffness(xyz: Array, bars: Bars) -> tuple[Array, Array]:
    """Stiffness [d, d], and of every member the ends' displacements in its axes [m, 12, 12]."""
    turned = np.zeros((len(bars.ends), 12, 12))
    size = 6 * len(xyz)
    total = np.zeros((size, size))
    for k, (i, j) in enumerate(bars.ends):
        for part in range(4):
            turned[k, 3 * part : 3 * part + 3, 3 * part : 3 * part + 3] = bars.axes[k]
        length = float(np.linalg.norm(xyz[j] - xyz[i]))
        turned[k] = _beyond_zones(bars.zone[k]) @ turned[k]
        own = turned[k].T @ _member(length, bars, k) @ turned[k]
        where = np.r_[6 * i : 6 * i + 6, 6 * j : 6 * j + 6]
        total[np.ix_(where, where)] += own
    return total, turned


def _beyond_zones(zone: float) -> Array:
    """From the displacements of the nodes to those of the ends of rigid lengths, [12, 12]."""
    out = np.eye(12)
    out[1, 5], out[2, 4] = zone, -zone
    out[7, 11], out[8, 10] = -zone, zone
    return out


def _member(length: float, bars: Bars, k: int) -> Array:
    """Stiffness of a member in its axes, [12, 12].

    Gussets stiffen it in bending and torsion; along it they are no longer than what they lap.
    """
    out = np.zeros((12, 12))
    _couple(out, (0, 6), bars.ea[k] / length)
    if bars.pinned[k]:
        return out
    length = length - 2.0 * bars.zone[k]
    _couple(out, (3, 9), bars.gj[k] / length)
    # About z the deflection is y and the slope is rz; about y it is z, and the slope -ry.
    for ei, (v1, t1, v2, t2), sign in (
        (bars.ei_z[k], (1, 5, 7, 11), 1.0),
        (bars.ei_y[k], (2, 4, 8, 10), -1.0),
    ):
        beam = (
            ei
            / length**3
            * np.array(
                [
                    [12.0, 6.0 * length, -12.0, 6.0 * length],
                    [6.0 * length, 4.0 * length**2, -6.0 * length, 2.0 * length**2],
                    [-12.0, -6.0 * length, 12.0, -6.0 * length],
                    [6.0 * length, 2.0 * length**2, -6.0 * length, 4.0 * length**2],
                ]
            )
        )
        turn = np.array([1.0, sign, 1.0, sign])
        out[np.ix_((v1, t1, v2, t2), (v1, t1, v2, t2))] += turn[:, None] * beam * turn
    return out


def _couple(matrix: Array, pair: tuple[int, int], value: float) -> None:
    a, b = pair
    matrix[a, a] += value
    matrix[b, b] += value
    matrix[a, b] -= value
    matrix[b, a] -= value


class Solved:
    """Answers to ``p`` load patterns.

    ``force`` [d, p] [N, N m]; ``warm`` [m, p] kelvin of every member; ``moved`` [d, p] [m, rad]
    of held degrees of freedom; ``springs``: to the ground, by degree of freedom.
    """

    def __init__(
        self,
        xyz: Array,
        bars: Bars,
        held: set[int],
        springs: dict[int, float],
        force: Array,
        warm: Array,
        moved: Array,
    ) -> None:
        matrix, self._turned = stiffness(xyz, bars)
        for dof, value in springs.items():
            matrix[dof, dof] += value
        self._bars, self._warm = bars, warm
        self._length = np.linalg.norm(xyz[bars.ends[:, 1]] - xyz[bars.ends[:, 0]], axis=1)
        self._clear = self._length - 2.0 * bars.zone
        right = force.copy()
        push = (bars.ea * bars.alpha)[:, None] * warm
        for k, (i, j) in enumerate(bars.ends):
            along = bars.axes[k, 0][:, None] * push[k]
            right[6 * i : 6 * i + 3] -= along
            right[6 * j : 6 * j + 3] += along
        scale = float(np.diag(matrix).max())
        turns = np.arange(len(matrix)) % 6 >= 3
        still = {int(d) for d in np.flatnonzero(turns & (np.diag(matrix) < _IDLE * scale))}
        fixed = np.array(sorted(held | still), dtype=np.int64)
        free = np.setdiff1d(np.arange(len(matrix)), fixed)
        #: displacements [d, p]
        self.u = np.zeros_like(right)
        self.u[fixed] = moved[fixed]
        load = right[free] - matrix[np.ix_(free, fixed)] @ self.u[fixed]
        inner = matrix[np.ix_(free, free)]
        self.u[free] = np.linalg.solve(inner, load)
        worst = np.abs(inner @ self.u[free] - load).max(initial=0.0)
        if not worst <= 1e-6 * max(np.abs(load).max(initial=0.0), 1e-9):
            raise ValueError("the structure is a mechanism: the solution leaves a residual")

    def strain(self, member: int, at: float, y: float, z: float) -> Array:
        """Mechanical strain [p] of a fibre at a share of the length between the zones."""
        bars = self._bars
        i, j = bars.ends[member]
        ends = self._turned[member] @ np.concatenate(
            [self.u[6 * i : 6 * i + 6], self.u[6 * j : 6 * j + 6]]
        )
        clear = self._clear[member]
        free = bars.alpha[member] * self._warm[member] * self._length[member]
        axial = (ends[6] - ends[0] - free) / self._length[member]
        if bars.pinned[member]:
            return np.asarray(axial)
        v1, v2 = (12.0 * at - 6.0) / clear**2, (6.0 - 12.0 * at) / clear**2
        t1, t2 = (6.0 * at - 4.0) / clear, (6.0 * at - 2.0) / clear
        about_z = v1 * ends[1] + t1 * ends[5] + v2 * ends[7] + t2 * ends[11]
        about_y = v1 * ends[2] - t1 * ends[4] + v2 * ends[8] - t2 * ends[10]
        return np.asarray(axial - y * about_z - z * about_y)
