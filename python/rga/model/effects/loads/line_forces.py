"""Nodal forces of loads along members."""

import numpy as np

from rga.arrays import FloatArray
from rga.model.structure import Structure, unit_vector


def line_forces(
    structure: Structure, group: str | list[str], direction: tuple[float, float, float]
) -> dict[int, FloatArray]:
    """Nodal forces of a unit load per length on a group: half of each member to each end."""
    members = structure.named(None, group)
    ends = structure.arrays["ends"][members]
    half = np.zeros(len(structure.arrays["coordinates"]))
    np.add.at(half, ends, structure.lengths[members, None] / 2)
    unit = np.append(unit_vector(direction), np.zeros(3))
    return {node: half[node] * unit for node in np.unique(ends).tolist()}
