"""A roof that large models are measured on: a double-layer grid, square on offset square."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga_bench.solver.space_truss import SpaceTruss, displacements, load_patterns, pinned

#: all members have this length [m]: half-octahedra
PANEL = 3.0
STEEL, DENSITY, GRAVITY = 2.1e11, 7850.0, 9.81
#: of the members [m2]: they differ, as tubes that are chosen one by one do
AREAS = (1e-3, 4e-3)


def double_layer_grid(panels: int, seed: int = 0) -> SpaceTruss:
    """A square roof that rests on its edge and carries its own weight; 6 n (n + 1) + 3 DOFs.

    The upper layer has n + 1 nodes a side, the lower one n in the middle of its squares. One
    pattern of loads, the weight of each member at its ends; the displacements of all nodes are
    read. Panels of 64 make 25 thousand DOFs, of 204 a quarter of a million.

    Args:
        panels: n, squares of the upper layer along a side.
        seed: of the areas.
    """
    upper = np.arange((panels + 1) ** 2).reshape(panels + 1, panels + 1)
    lower = upper.size + np.arange(panels**2).reshape(panels, panels)
    nodes = np.concatenate([_layer(panels + 1, 0.0, PANEL / np.sqrt(2)), _layer(panels, 0.5, 0.0)])
    corners = [upper[:-1, :-1], upper[1:, :-1], upper[:-1, 1:], upper[1:, 1:]]
    lines = [(layer[:-1], layer[1:]) for layer in (upper, lower, upper.T, lower.T)]
    lines += [(corner, lower) for corner in corners]
    ends = np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in lines])
    area = np.random.default_rng(seed).uniform(*AREAS, len(ends))
    none = np.zeros(0, np.int64)
    forces = np.zeros((1, len(nodes), 3))
    half = 0.5 * GRAVITY * DENSITY * area * PANEL
    forces[0, :, 2] = -np.bincount(ends.ravel(), np.repeat(half, 2), len(nodes))
    read = np.arange(3 * len(nodes))
    return SpaceTruss(
        pinned(nodes, ends, area, STEEL, _held(upper, len(nodes)), none, np.zeros(0)),
        load_patterns(forces, np.zeros((0, len(ends)))),
        displacements(read // 3, read % 3),
    )


def _layer(side: int, offset: float, height: float) -> FloatArray:
    """Nodes of a square layer, float[side^2, 3]."""
    x, y = np.meshgrid(*[PANEL * (offset + np.arange(side))] * 2, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(side**2, height)], axis=1)


def _held(upper: NDArray[np.int64], nodes: int) -> NDArray[np.bool_]:
    """The edge of the upper layer upwards; the middle of each side along it."""
    held = np.zeros((nodes, 3), dtype=bool)
    for side in (upper[0], upper[-1], upper[:, 0], upper[:, -1]):
        held[side, 2] = True
    middle = len(upper) // 2
    held[[upper[0, middle], upper[-1, middle]], 1] = True
    held[[upper[middle, 0], upper[middle, -1]], 0] = True
    return held
