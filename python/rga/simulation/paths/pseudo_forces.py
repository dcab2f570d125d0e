"""Pseudo-forces on terms of a structure: how they are put on it, and what they and outputs read.

Nodal forces stand for them, and elongations follow from displacements of the nodes.
"""

import numpy as np

from rga.arrays import FloatArray
from rga.simulation.paths.rank_one_terms import Arrays, Terms

DISPLACEMENT, ROTATION, FORCE, REACTION_FORCE, REACTION_MOMENT, END_FORCE = 0, 1, 3, 4, 5, 6


def at_rest(loads: Arrays, terms: Terms) -> FloatArray:
    """Elongations that initial strains bring without any force, float[patterns, terms]."""
    elongations = np.zeros((len(loads["strain"]), len(terms)))
    of_members = terms.member >= 0
    strain = loads["strain"][:, terms.member[of_members]]
    elongations[:, of_members] = (strain * terms.rest[of_members]).sum(axis=2)
    return elongations


def with_unit_forces(loads: Arrays, terms: Terms) -> Arrays:
    """The loads, then a pattern for each term: what a unit of pseudo-force does."""
    extended = dict(loads)
    for name in ("forces", "strain", "prescribed", "prescribed_inclined"):
        none = np.zeros((len(terms), *loads[name].shape[1:]))
        extended[name] = np.concatenate([loads[name], none])
    rows = len(loads["forces"]) + np.arange(len(terms))
    for end, first in enumerate((0, 6)):
        extended["forces"][rows, terms.nodes[:, end]] += terms.motion[:, first : first + 6]
    return extended


def with_motions(outputs: Arrays, terms: Terms) -> Arrays:
    """The outputs, then what adds up to elongations: how the ends part, how each of them turns."""
    start, end = terms.nodes.T
    nothing = np.full(len(terms), -1)
    vectors = [terms.motion[:, first : first + 3] for first in (6, 3, 9)]
    added = {
        "kind": np.repeat([DISPLACEMENT, ROTATION, ROTATION], len(terms)),
        "index": np.maximum(np.concatenate([end, start, end]), 0),
        "other": np.concatenate([start, nothing, nothing]),
        "vector": np.concatenate(vectors),
        "total": np.zeros(3 * len(terms), dtype=bool),
    }
    return {
        name: np.concatenate([outputs[name], column.astype(outputs[name].dtype)])
        for name, column in added.items()
    }


def parting(motions: FloatArray) -> FloatArray:
    """Elongations, float[patterns, terms], from the outputs that `with_motions` adds."""
    return np.asarray(sum(np.split(motions, 3, axis=1)))


def own_readings(outputs: Arrays, terms: Terms) -> FloatArray:
    """What outputs on a term read of its pseudo-force itself, float[terms, outputs].

    That of a member is a part of its end forces; that of a spring to the ground is a part of the
    reaction there.
    """
    kind, index, vector = outputs["kind"], outputs["index"], outputs["vector"]
    on = terms.member[:, None] == index
    own = np.where(on & (kind == FORCE), terms.local[:, :1], 0.0)
    ends = np.where(kind == END_FORCE, outputs["other"], 0)
    own -= np.where(on & (kind == END_FORCE), terms.local[:, ends], 0.0)
    under = (terms.nodes[:, :1] < 0) & (terms.nodes[:, 1:] == index)
    for of_kind, first in ((REACTION_FORCE, 6), (REACTION_MOMENT, 9)):
        part = terms.motion[:, first : first + 3] @ vector.T
        own += np.where(under & (kind == of_kind), part, 0.0)
    return own
