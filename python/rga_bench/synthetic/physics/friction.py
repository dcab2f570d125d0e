"""Bearings that stick and slip: one row after another, on the bearings' own flexibility."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.physics.frame import Array, Solution
from rga_bench.synthetic.physics.world import Friction

_SWEEPS = 500


def slide(friction: Friction, solution: Solution, course: Array, free: int) -> Array:
    """Friction forces on the structure [N], shape [n, bearings].

    ``solution`` answers ``free`` load patterns, then a unit force along each bearing;
    ``course`` [n, free] are the patterns' sizes. The first row starts without friction.
    """
    dofs, normals = friction.dofs, friction.normals
    loose = course @ solution.u[dofs, :free].T
    lift = course @ solution.reaction[normals, :free].T
    flexibility = solution.u[np.ix_(dofs, range(free, free + len(dofs)))]
    reach = solution.reaction[np.ix_(normals, range(free, free + len(dofs)))]
    grip = np.zeros_like(loose)
    at = loose[0].copy()
    force = np.zeros(len(dofs))
    for row in range(1, len(loose)):
        for _ in range(_SWEEPS):
            before = force.copy()
            for b in range(len(dofs)):
                cap = friction.mu * max(friction.permanent + lift[row, b] + reach[b] @ force, 0.0)
                now = loose[row, b] + flexibility[b] @ force
                hold = force[b] + (at[b] - now) / flexibility[b, b]
                force[b] = min(max(hold, -cap), cap)
            if np.abs(force - before).max() < 1e-6:
                break
        at = loose[row] + flexibility @ force
        grip[row] = force
    return grip
