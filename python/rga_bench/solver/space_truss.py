"""Trusses with pinned joints as arrays: what the generated structures of the benchmarks share."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray, LoadArrays, OutputArrays, StructureArrays


@dataclass(frozen=True)
class SpaceTruss:
    """A structure with load patterns and sensors.

    Attributes:
        structure, loads, outputs: as `_core.respond` takes them; nodal load patterns first, then
            temperature fields.
    """

    structure: StructureArrays
    loads: LoadArrays
    outputs: OutputArrays


def pinned(
    nodes: FloatArray,
    ends: NDArray[np.int64],
    area: FloatArray,
    modulus: float,
    fixed: NDArray[np.bool_],
    springs: NDArray[np.int64],
    spring_stiffness: FloatArray,
) -> StructureArrays:
    """A structure of truss members, with springs to the ground along x.

    Args:
        nodes: coordinates [m], float[n, 3].
        ends: nodes of the members, int[m, 2].
        area: of the members [m2], float[m].
        modulus: of elasticity [Pa].
        fixed: displacements that are held, bool[n, 3].
        springs: nodes that have one, int[s].
        spring_stiffness: float[s] [N/m].
    """
    count = len(ends)
    return {
        "coordinates": nodes,
        "ends": ends,
        "frame": np.zeros(count, dtype=bool),
        "E": np.full(count, modulus),
        "G": np.full(count, modulus / 2.6),
        "A": area,
        "Iy": np.full(count, 1e-6),
        "Iz": np.full(count, 1e-6),
        "J": np.full(count, 1e-6),
        "Asy": np.full(count, np.inf),
        "Asz": np.full(count, np.inf),
        "local_y": np.full((count, 3), np.nan),
        "connection": np.full((count, 12), np.inf),
        "rigid_end": np.zeros((count, 2)),
        "fixed": np.pad(fixed, ((0, 0), (0, 3))),
        "inclined_node": np.zeros(0, np.int64),
        "inclined_direction": np.zeros((0, 3)),
        "spring_node": np.stack([springs, np.full(len(springs), -1)], axis=1),
        "spring_dof": np.zeros(len(springs), np.int64),
        "spring_stiffness": spring_stiffness,
        "tie_node": np.zeros((0, 2), np.int64),
        "tie_dof": np.zeros(0, np.int64),
    }


def load_patterns(forces: FloatArray, strain: FloatArray) -> LoadArrays:
    """Patterns of nodal forces, then fields of free strain.

    Args:
        forces: float[p, n, 3] [N].
        strain: of the members without stress, float[t, m] [-].
    """
    patterns = len(forces) + len(strain)
    whole = np.zeros((patterns, forces.shape[1], 6))
    whole[: len(forces), :, :3] = forces
    strains = np.zeros((patterns, strain.shape[1], 3))
    strains[len(forces) :, :, 0] = strain
    return {
        "forces": whole,
        "strain": strains,
        "prescribed": np.zeros_like(whole),
        "prescribed_inclined": np.zeros((patterns, 0)),
        "member_pattern": np.zeros(0, np.int64),
        "member_index": np.zeros(0, np.int64),
        "member_axis": np.zeros(0, np.int64),
        "member_from": np.zeros(0),
        "member_to": np.zeros(0),
        "member_start": np.zeros(0),
        "member_end": np.zeros(0),
    }


def displacements(nodes: NDArray[np.int64], directions: NDArray[np.int64]) -> OutputArrays:
    """Sensors of displacement: nodes int[o], and directions int[o], 0..2 for x y z."""
    count = len(nodes)
    return {
        "kind": np.zeros(count, np.int64),
        "index": nodes,
        "other": np.full(count, -1),
        "vector": np.eye(3)[directions],
        "total": np.zeros(count, dtype=bool),
    }
