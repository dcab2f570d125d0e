"""A box truss bridge of 84 nodes as arrays: what solvers are compared on.

Geometry, members, areas, bearings and temperature fields are those of `truss3d_bridge84_base` and
`truss3d_bridge84_contexts` of the verification set; loads, sensors, what varies and
samples are drawn over the ranges that they have there.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga_bench.solver.space_truss import SpaceTruss, displacements, load_patterns, pinned

PANELS, PANEL, HEIGHT, WIDTH = 21, 3.0, 5.0, 6.0
STEEL, EXPANSION = 2.0e11, 1.2e-5
#: of chords and end posts, webs, cross girders, bracings [m2]
CHORD, WEB, GIRDER, BRACING = 0.012, 0.006, 0.008, 0.002
BEARING = 5e6
PATTERNS, SENSORS, MEMBERS_VARIED = 10, 16, 8
#: nodes that a load pattern acts on
LOADED = 20
#: of samples: coefficients of loads and of temperature fields [K], factors of members and springs
OF_LOADS, OF_FIELDS, OF_MEMBERS, OF_SPRINGS = (0.0, 2.0), (-30.0, 30.0), (0.7, 1.4), (0.2, 1.8)


@dataclass(frozen=True)
class BoxBridge(SpaceTruss):
    """A bridge, and what varies in it.

    Attributes:
        members, springs: numbers of those whose stiffness varies.
    """

    members: NDArray[np.int64]
    springs: NDArray[np.int64]


def box_bridge(seed: int = 0, sensors: int = SENSORS, spans: int = 1) -> BoxBridge:
    """Two trusses of 21 panels a span, braced to a box, fixed at one end and on springs elsewhere.

    Ten patterns of nodal loads, then two temperature fields: uniform, and from none below to one
    above. Spans are one behind the other, as a continuous bridge on piers.

    Args:
        seed: of loads, sensors and of what varies.
        sensors: displacements that are read.
        spans: of 63 m; ten make 2 500 DOFs.
    """
    draw = np.random.default_rng(seed)
    below, above, nodes = _nodes(PANELS * spans)
    ends, area = _members(below, above)
    fixed = np.zeros(nodes.shape, dtype=bool)
    piers = below[::PANELS]
    fixed[piers, 2] = True
    fixed[piers[:, 0], 1] = True
    fixed[piers[0], 0] = True
    springs = piers[1:].ravel()
    free = np.flatnonzero(~fixed)
    forces = np.zeros((PATTERNS, *nodes.shape))
    for pattern in forces:
        loaded = draw.choice(np.flatnonzero(~fixed[:, 2]), LOADED, replace=False)
        pattern[loaded, 1] = draw.uniform(-1e3, 1e3, LOADED)
        pattern[loaded, 2] = draw.uniform(-2e4, -1e3, LOADED)
    fields = np.stack([np.ones(len(ends)), nodes[ends, 2].mean(axis=1) / HEIGHT])
    read = np.sort(draw.choice(free, sensors, replace=False))
    varied = np.sort(draw.choice(len(ends), MEMBERS_VARIED, replace=False))
    return BoxBridge(
        pinned(nodes, ends, area, STEEL, fixed, springs, np.full(len(springs), BEARING)),
        load_patterns(forces, EXPANSION * fields),
        displacements(read // 3, read % 3),
        varied,
        np.arange(len(springs)),
    )


def samples(bridge: BoxBridge, rows: int, seed: int = 0) -> tuple[FloatArray, FloatArray]:
    """Samples in which everything varies: factors float[rows, m + s], coefficients float[rows, p].

    As `_core.Refactored.respond` takes them.
    """
    draw = np.random.default_rng(seed)
    members, springs = len(bridge.structure["ends"]), len(bridge.structure["spring_stiffness"])
    factors = [
        draw.uniform(*OF_MEMBERS, (rows, members)),
        draw.uniform(*OF_SPRINGS, (rows, springs)),
    ]
    fields = len(bridge.loads["forces"]) - PATTERNS
    loads = [draw.uniform(*OF_LOADS, (rows, PATTERNS)), draw.uniform(*OF_FIELDS, (rows, fields))]
    return np.hstack(factors), np.hstack(loads)


def _nodes(panels: int) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """Numbers of the lower [stations, sides] and of the upper nodes; coordinates [m]."""
    lower = [(x, z, y) for x in range(panels + 1) for z in (0, 1) for y in (0, 1)]
    there = [(x, z, y) for x, z, y in lower if z == 0 or 0 < x < panels]
    number = {place: index for index, place in enumerate(there)}
    below = np.array([[number[x, 0, y] for y in (0, 1)] for x in range(panels + 1)])
    above = np.array([[number[x, 1, y] for y in (0, 1)] for x in range(1, panels)])
    return below, above, np.array([[PANEL * x, WIDTH * y, HEIGHT * z] for x, z, y in there])


def _members(
    below: NDArray[np.int64], above: NDArray[np.int64]
) -> tuple[NDArray[np.int64], FloatArray]:
    """Ends int[m, 2] of the members, and their areas [m2]."""
    groups = []
    for side in (0, 1):
        low, high = below[:, side], above[:, side]
        groups += [
            (CHORD, _lines(low[:-1], low[1:])),
            (CHORD, _lines(high[:-1], high[1:])),
            (CHORD, _lines(low[[0, -1]], high[[0, -1]])),
            (WEB, _lines(low[1:-1], high)),
            (WEB, _crosses(low[1:-1], high)),
        ]
    groups += [(GIRDER, _lines(*layer.T)) for layer in (below, above)]
    groups += [(BRACING, _crosses(*layer.T)) for layer in (below, above)]
    sway = np.concatenate([below[1:-1], above[:, ::-1]], axis=1)
    groups.append((BRACING, sway[:, [0, 2, 1, 3]].reshape(-1, 2)))
    ends = np.concatenate([lines for _, lines in groups])
    return ends, np.concatenate([np.full(len(lines), area) for area, lines in groups])


def _lines(one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.stack([one, other], axis=1)


def _crosses(one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.int64]:
    """Both diagonals of the panels between two rows of nodes, panel by panel."""
    pairs = np.stack([one[:-1], other[1:], other[:-1], one[1:]], axis=1)
    return pairs.reshape(-1, 2)
