"""Nodal forces of loads along members."""

import numpy as np

from rga.arrays import FloatArray
from rga.model.structure import Structure, unit_vector


def line_forces(
    structure: Structure, group: str | list[str], direction: tuple[float, float, float]
) -> dict[int, FloatArray]:
    """Nodal forces of a unit load per length on a group: half of each member to each end."""
    unit = np.append(unit_vector(direction), np.zeros(3))
    forces: dict[int, FloatArray] = {}
    lengths = structure.lengths
    for member in structure.named(None, group):
        for node in structure.arrays["ends"][member]:
            share = unit * lengths[member] / 2
            forces[int(node)] = forces.get(int(node), np.zeros(6)) + share
    return forces
