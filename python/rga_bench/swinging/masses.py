"""What moves with a structure: its members, and what it carries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure

#: density of steel [kg/m3] (EN 1991-1-1, table A.4)
STEEL = 7850.0
#: what is carried, as a multiple of the mass of all members
CARRIED = (0.5, 2.0)
#: by which masses differ from what is stated: members weigh nearly what they should, and what is
#: carried varies by 4 % (JCSS Probabilistic Model Code, 2.1); both have a part in common
OF_MEMBERS, OF_CARRIED = 0.01, 0.03


@dataclass
class Masses:
    """Mass along every member [kg/m], and on every node [kg]."""

    line: Array
    nodal: Array


def weigh(structure: FieldStructure, rng: np.random.Generator) -> Masses:
    """State masses in the model of a structure, and give them."""
    model = structure.model
    for material in model["materials"].values():
        material["density"] = STEEL
    members = list(model["members"].values())
    line = np.array([STEEL * model["sections"][one["section"]]["A"] for one in members])
    nodes = list(model["nodes"])
    points = np.array(list(model["nodes"].values()), dtype=float)
    ends = np.array([[nodes.index(node) for node in one["nodes"]] for one in members])
    length = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    carrying = next(
        list(one["forces"]) for one in model["effects"].values() if one["kind"] == "nodal_load"
    )
    share = np.exp(rng.uniform(*np.log(CARRIED))) * float(line @ length) / len(carrying)
    model["masses"] = {
        f"on {node}": {"node": node, "mass": float(f"{share:.4g}")} for node in carrying
    }
    nodal = np.zeros(len(nodes))
    for one in model["masses"].values():
        nodal[nodes.index(one["node"])] += one["mass"]
    return Masses(line, nodal)


def as_weighed(stated: Masses, rng: np.random.Generator, spread: float) -> Masses:
    """Masses as they are: each differs from what is stated."""

    def factors(count: int, scatter: float) -> Array:
        together, own = rng.standard_normal(), rng.standard_normal(count)
        return np.asarray(np.exp(spread * scatter * np.sqrt(0.5) * (together + own)))

    return Masses(
        stated.line * factors(len(stated.line), OF_MEMBERS),
        stated.nodal * factors(len(stated.nodal), OF_CARRIED),
    )
