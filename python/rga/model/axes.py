"""Local axes of members."""

from typing import TypedDict

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.model.schema import Model


class PlacedMembers(TypedDict):
    """Where members stand, as in `StructureArrays`."""

    coordinates: FloatArray
    ends: IntArray
    local_y: FloatArray


def local_axes(structure: PlacedMembers, members: IntArray) -> tuple[FloatArray, FloatArray]:
    """Lengths, float[members] [m], and axes x, y, z in global components, float[members, 3, 3]."""
    ends = structure["coordinates"][structure["ends"][members]]
    along = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(along, axis=1)
    x = along / lengths[:, None]
    level = np.cross([0.0, 0.0, 1.0], x)
    level[np.linalg.norm(level, axis=1) <= 1e-9] = [0.0, 1.0, 0.0]
    given = structure["local_y"][members]
    z = np.cross(x, np.where(np.isnan(given), level, given))
    z /= np.linalg.norm(z, axis=1)[:, None]
    return lengths, np.stack([x, np.cross(z, x), z], axis=1)


def member_axes(model: Model, member: str) -> tuple[float, FloatArray]:
    """Length [m] of one member of a model, and its axes x, y, z as rows, float[3, 3]."""
    own = model.members[member]
    structure: PlacedMembers = {
        "coordinates": np.array([model.nodes[node] for node in own.nodes], dtype=float),
        "ends": np.array([[0, 1]]),
        "local_y": np.array([own.local_y or (np.nan, np.nan, np.nan)], dtype=float),
    }
    lengths, axes = local_axes(structure, np.array([0]))
    return float(lengths[0]), np.asarray(axes[0])
