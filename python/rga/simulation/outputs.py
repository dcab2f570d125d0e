"""What the core is asked to read of a structure, beside what its sensors show."""

from collections.abc import Sequence
from typing import cast

import numpy as np

from rga._core import OutputKind
from rga.arrays import FloatArray, OutputArrays, by_name


def node_outputs(nodes: Sequence[int], first: OutputKind, then: OutputKind) -> OutputArrays:
    """Two vectors of each node, by its number: x, y, z of the first kind, then of the other."""
    count = 6 * len(nodes)
    return {
        "kind": np.tile(np.repeat([int(first), int(then)], 3), len(nodes)).astype(np.int64),
        "index": np.repeat(np.array(nodes, dtype=np.int64), 6),
        "other": np.full(count, -1),
        "vector": np.tile(np.eye(3), (count // 3, 1)),
        "total": np.zeros(count, dtype=bool),
    }


def section_outputs(members: Sequence[int], places: FloatArray) -> OutputArrays:
    """Six forces at each place along each member, by its number."""
    count = 6 * len(members) * len(places)
    vector = np.zeros((count, 3))
    vector[:, 0] = np.tile(np.repeat(places, 6), len(members))
    return {
        "kind": np.full(count, int(OutputKind.SECTION_FORCE)),
        "index": np.repeat(np.array(members, dtype=np.int64), 6 * len(places)),
        "other": np.tile(np.arange(6), len(members) * len(places)),
        "vector": vector,
        "total": np.zeros(count, dtype=bool),
    }


def joined(*parts: OutputArrays) -> OutputArrays:
    """Outputs one after another."""
    return cast(
        OutputArrays, {key: np.concatenate([by_name(p)[key] for p in parts]) for key in parts[0]}
    )
