"""Nodes and parts of a structure that are joined to nothing, and those that nothing holds."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from rga.arrays import BoolArray, IntArray
from rga.checking.finding import Finding, named, parts
from rga.checking.over_ranges import OverRanges
from rga.errors import InputError
from rga.model.structure import Structure
from rga.model.structure.arrays import HELD_BY_PLANE
from rga.simulation.paths.response import node_name

#: parts of a structure that are told one by one
MOST_PARTS = 5


@dataclass(frozen=True)
class Joined:
    """Which nodes hang together.

    Attributes:
        part: number of the part that each node belongs to, int[nodes].
        members: members, springs and ties at each node, int[nodes].
        held: nodes that a support or a spring to the ground holds, bool[nodes].
    """

    part: IntArray
    members: IntArray
    held: BoolArray

    def floating(self) -> list[IntArray]:
        """Nodes of each part of several nodes that nothing holds."""
        return [nodes for nodes in self.parts() if not self.held[nodes].any()]

    def parts(self) -> list[IntArray]:
        """Nodes of each part of several nodes, the largest first."""
        numbers, sizes = np.unique(self.part, return_counts=True)
        order = np.argsort(-sizes, kind="stable")
        return [np.flatnonzero(self.part == numbers[k]) for k in order if sizes[k] > 1]


def joined(structure: Structure, plane: str | None) -> Joined:
    """Which nodes of a structure hang together.

    Args:
        structure: with its members, springs and ties.
        plane: of a plane model, which holds all nodes; None: in space.
    """
    arrays = structure.arrays
    nodes = len(arrays["coordinates"])
    springs = arrays["spring_node"]
    grounded = springs[:, 1] < 0
    pairs = np.vstack([arrays["ends"], springs[~grounded], arrays["tie_node"]])
    ones = np.ones(len(pairs), dtype=bool)
    _, part = connected_components(coo_array((ones, (pairs[:, 0], pairs[:, 1])), (nodes, nodes)))
    fixed = arrays["fixed"].copy()
    fixed[:, list(HELD_BY_PLANE.get(plane or "", ()))] = False
    held = np.asarray(fixed.any(axis=1), dtype=bool)
    held[arrays["inclined_node"]] = True
    held[springs[grounded, 0]] = True
    members = np.bincount(np.append(pairs.ravel(), springs[grounded, 0]), minlength=nodes)
    return Joined(np.asarray(part, dtype=np.int64), members, held)


def connections(over: OverRanges) -> Iterator[Finding]:
    """Nodes that are joined to nothing, and parts of a structure that hang together by themselves.

    What nothing holds is told with the motions that it makes: `mechanisms`.
    """
    model = over.model
    if not model.nodes or not model.members:
        lack = "member" if model.nodes else "node"
        yield Finding("error", f"model {model.name!r}", f"it has no {lack}", "give it some")
        return
    try:
        structure = over.structure
    except InputError:
        return
    found = joined(structure, model.plane)
    names = [node_name(structure, node) for node in range(len(found.part))]
    alone = [names[node] for node in np.flatnonzero(found.members == 0)]
    if alone:
        yield Finding(
            "error",
            parts("node", alone),
            "no member, spring or tie joins it" if len(alone) == 1 else "nothing joins them",
            "join it by a member, or take it out",
        )
    several = [nodes for nodes in found.parts() if found.held[nodes].any()]
    for nodes in several[1:MOST_PARTS]:
        yield Finding(
            "note",
            f"the part with nodes {named(names[node] for node in nodes)}",
            "no member joins it to the rest of the structure",
            "join it if the structure is one; it stands by itself if it is not",
        )
