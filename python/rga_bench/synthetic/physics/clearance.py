"""Members that slip in their joints and bearings that meet a stop: row by row, force by force."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.physics.frame import Array

_SWEEPS = 2000
_ALIKE = 1e-12
_NO_FORCE = 1e-3  # [N]


def slips(force: Array, unit: Array, slip: Array) -> Array:
    """How far each member has slipped [m], shape [n, k].

    A member rests where its force is nil, or at an end of its clearance. ``force`` [n, k] [N]
    without slip, ``unit`` [k, k] forces on the members per metre of slip of each, ``slip`` [k] [m].
    """
    s = np.zeros_like(force)
    for _ in range(_SWEEPS):
        before = s.copy()
        for i in range(len(slip)):
            now = force[:, i] + s @ unit[i]
            if -unit[i, i] * slip[i] > _NO_FORCE:
                s[:, i] = np.clip(s[:, i] - now / unit[i, i], -slip[i], slip[i])
            else:
                s[:, i] = np.where(np.abs(now) > _NO_FORCE, np.sign(now) * slip[i], 0.0)
        if np.abs(s - before).max() <= _ALIKE * slip.max():
            break
    return s


def stops(loose: Array, flexibility: Array, gap: float, stiffness: float) -> Array:
    """Forces of stops on the structure [N], shape [n, k].

    ``loose`` [n, k] [m] way of each bearing without its stop, ``flexibility`` [k, k] [m/N].
    """
    push = np.zeros_like(loose)
    for _ in range(_SWEEPS):
        before = push.copy()
        for i in range(loose.shape[1]):
            others = loose[:, i] + push @ flexibility[i] - push[:, i] * flexibility[i, i]
            beyond = others - np.clip(others, -gap, gap)
            push[:, i] = -beyond / (flexibility[i, i] + 1.0 / stiffness)
        if np.abs(push - before).max() <= _ALIKE * max(float(np.abs(push).max()), 1.0):
            break
    return push
