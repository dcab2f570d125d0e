"""A box truss bridge of 84 nodes as arrays: what solvers are compared on."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]
PANELS, PANEL, HEIGHT, WIDTH = 20, 2.3, 2.6, 3.0
STEEL, EXPANSION = 2.1e11, 1.2e-5
PATTERNS, FIELDS, SENSORS, MEMBERS_VARIED = 10, 2, 16, 8
BEARING = 5e6


@dataclass(frozen=True)
class Bridge:
    """A structure with load patterns, sensors, and what varies in it.

    Attributes:
        structure, loads, outputs: as `_core.respond` takes them; nodal load patterns first, then
            temperature fields.
        members, springs: numbers of those whose stiffness varies.
    """

    structure: Arrays
    loads: Arrays
    outputs: Arrays
    members: NDArray[np.int64]
    springs: NDArray[np.int64]


def box_bridge(seed: int = 0, sensors: int = SENSORS) -> Bridge:
    """Two trusses of 20 panels, braced to a box, on four bearings, two of them with springs.

    Args:
        seed: of areas, loads, temperatures, sensors and of what varies.
        sensors: displacements that are read.
    """
    draw = np.random.default_rng(seed)
    along = np.arange(PANELS + 1) * PANEL
    nodes = np.array([[x, y, z] for y in (0.0, WIDTH) for z in (0.0, HEIGHT) for x in along])
    ends = np.array(_members(), dtype=np.int64)
    count = len(ends)
    structure: Arrays = {
        "coordinates": nodes,
        "ends": ends,
        "frame": np.zeros(count, dtype=bool),
        "E": np.full(count, STEEL),
        "G": np.full(count, STEEL / 2.6),
        "A": draw.uniform(2e-3, 8e-3, count),
        **{name: np.full(count, 1e-6) for name in ("Iy", "Iz", "J")},
        **{name: np.full(count, np.inf) for name in ("Asy", "Asz")},
        "local_y": np.full((count, 3), np.nan),
        "connection": np.full((count, 12), np.inf),
        "rigid_end": np.zeros((count, 2)),
        "fixed": _supports(len(nodes)),
        "inclined_node": np.zeros(0, np.int64),
        "inclined_direction": np.zeros((0, 3)),
        "spring_node": np.array([[PANELS, -1], [3 * PANELS + 2, -1]]),
        "spring_dof": np.zeros(2, np.int64),
        "spring_stiffness": np.full(2, BEARING),
        "tie_node": np.zeros((0, 2), np.int64),
        "tie_dof": np.zeros(0, np.int64),
    }
    forces = np.zeros((PATTERNS + FIELDS, len(nodes), 6))
    for pattern in forces[:PATTERNS]:
        loaded = draw.choice(len(nodes), 20, replace=False)
        pattern[loaded, 1] = draw.uniform(-1e3, 1e3, 20)
        pattern[loaded, 2] = draw.uniform(-2e4, -1e3, 20)
    strain = np.zeros((PATTERNS + FIELDS, count, 3))
    strain[PATTERNS:, :, 0] = EXPANSION * draw.uniform(0.5, 1.5, (FIELDS, count))
    none = np.zeros(0)
    loads: Arrays = {
        "forces": forces,
        "strain": strain,
        "prescribed": np.zeros_like(forces),
        "prescribed_inclined": np.zeros((len(forces), 0)),
        **{f"member_{name}": np.zeros(0, np.int64) for name in ("pattern", "index", "axis")},
        **{f"member_{name}": none for name in ("from", "to", "start", "end")},
    }
    outputs: Arrays = {
        "kind": np.zeros(sensors, np.int64),
        "index": draw.choice(len(nodes), sensors, replace=sensors > len(nodes)),
        "other": np.full(sensors, -1),
        "vector": np.eye(3)[draw.integers(0, 3, sensors)],
        "total": np.zeros(sensors, dtype=bool),
    }
    varied = np.sort(draw.choice(count, MEMBERS_VARIED, replace=False))
    return Bridge(structure, loads, outputs, varied, np.arange(2))


def _members() -> list[tuple[int, int]]:
    count = PANELS + 1
    line = [[row * count + panel for panel in range(count)] for row in range(4)]
    below, above, far_below, far_above = line
    found = [(row[k], row[k + 1]) for row in line for k in range(PANELS)]
    faces = [(below, above), (far_below, far_above), (below, far_below), (above, far_above)]
    for one, other in faces:
        found += [(one[k], other[k]) for k in range(count)]
        found += [(one[k], other[k + 1]) for k in range(PANELS)]
    found += [(below[k], far_above[k]) for k in range(0, count, 2)]
    return found


def _supports(nodes: int) -> NDArray[np.bool_]:
    fixed = np.zeros((nodes, 6), dtype=bool)
    first, last = 0, PANELS
    far_first, far_last = 2 * PANELS + 2, 3 * PANELS + 2
    for node in (first, last, far_first, far_last):
        fixed[node, 2] = True
    fixed[first, :2] = True
    fixed[last, 1] = True
    return fixed
