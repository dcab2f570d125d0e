"""Types of arrays, as signatures name them, and the arrays that the core takes."""

from typing import Any, TypedDict, cast

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class MemberArrays(TypedDict):
    """Nodes and members of a structure; `help(rga._core.respond)` has shapes and units."""

    coordinates: FloatArray
    ends: IntArray
    frame: BoolArray
    E: FloatArray
    G: FloatArray
    A: FloatArray
    Iy: FloatArray
    Iz: FloatArray
    J: FloatArray
    Asy: FloatArray
    Asz: FloatArray
    local_y: FloatArray
    connection: FloatArray
    rigid_end: FloatArray


class RestraintArrays(TypedDict):
    """What holds the nodes of a structure: supports, springs and ties."""

    fixed: BoolArray
    inclined_node: IntArray
    inclined_direction: FloatArray
    spring_node: IntArray
    spring_dof: IntArray
    spring_stiffness: FloatArray
    tie_node: IntArray
    tie_dof: IntArray


class StructureArrays(MemberArrays, RestraintArrays):
    """A structure."""


class MassArrays(TypedDict):
    """What a structure weighs in motion; `help(rga._core.modes)` has shapes and units."""

    line: FloatArray
    section: FloatArray
    nodal: FloatArray


class LoadArrays(TypedDict):
    """Load patterns on a structure."""

    forces: FloatArray
    strain: FloatArray
    prescribed: FloatArray
    prescribed_inclined: FloatArray
    member_pattern: IntArray
    member_index: IntArray
    member_axis: IntArray
    member_from: FloatArray
    member_to: FloatArray
    member_start: FloatArray
    member_end: FloatArray


class OutputArrays(TypedDict):
    """What is read of a structure under loads; kinds are codes of `rga._core.OutputKind`."""

    kind: IntArray
    index: IntArray
    other: IntArray
    vector: FloatArray
    total: BoolArray


def by_name(
    arrays: StructureArrays | MassArrays | LoadArrays | OutputArrays,
) -> dict[str, NDArray[Any]]:
    """The same arrays, where all are treated alike."""
    return cast("dict[str, NDArray[Any]]", arrays)
