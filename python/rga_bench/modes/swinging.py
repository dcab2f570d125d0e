"""Trusses that swing: their masses, and both matrices in SciPy."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from rga.arrays import FloatArray, MassArrays, StructureArrays
from rga_bench.solver.peers.linear_system import LinearSystem
from rga_bench.solver.space_truss import SpaceTruss

DENSITY = 7850.0
#: on every node [kg]: deck, cladding and services
MORE = 1500.0


@dataclass(frozen=True)
class Swinging:
    """A truss with its masses.

    Attributes:
        truss: it.
        masses: as `_core.modes` takes them.
        system: its stiffness in SciPy.
        mass: of the free displacements, consistent, float[size, size].
    """

    truss: SpaceTruss
    masses: MassArrays
    system: LinearSystem
    mass: sparse.csc_array

    @classmethod
    def of(cls, truss: SpaceTruss) -> "Swinging":
        """The masses of steel, and of what stands on every node."""
        structure = truss.structure
        count, nodes = len(structure["ends"]), len(structure["coordinates"])
        line = DENSITY * structure["A"]
        nodal = np.zeros((nodes, 6))
        nodal[:, :3] = MORE
        masses: MassArrays = {"line": line, "section": np.zeros((count, 3)), "nodal": nodal}
        return cls(truss, masses, LinearSystem(truss), _mass(structure, line))

    def stiffness(self, factors: FloatArray) -> sparse.csc_array:
        """K of a sample, whole; factors of members and springs, float[m + s]."""
        lower = self.lower(factors)
        return sparse.csc_array(lower + lower.T - sparse.diags_array(lower.diagonal()))

    def lower(self, factors: FloatArray) -> sparse.csc_array:
        """The lower triangle of K of a sample."""
        values, pattern = self.system.values(factors[None])[0], self.system.lower
        return sparse.csc_array((values, pattern.indices, pattern.indptr), shape=pattern.shape)

    def structure(self, factors: FloatArray) -> StructureArrays:
        """The structure of a sample; its members weigh what they did."""
        given, count = self.truss.structure, len(self.truss.structure["ends"])
        return {
            **given,
            "E": given["E"] * factors[:count],
            "spring_stiffness": given["spring_stiffness"] * factors[count:],
        }


def _mass(structure: StructureArrays, line: FloatArray) -> sparse.csc_array:
    """Consistent mass of bars along all three axes, and of nodes."""
    ends, nodes = structure["ends"], structure["coordinates"]
    length = np.linalg.norm(nodes[ends[:, 1]] - nodes[ends[:, 0]], axis=1)
    part = line * length / 6
    rows = np.concatenate([ends[:, 0], ends[:, 1], ends[:, 0], ends[:, 1]])
    columns = np.concatenate([ends[:, 0], ends[:, 1], ends[:, 1], ends[:, 0]])
    values = np.concatenate([2 * part, 2 * part, part, part])
    of_nodes = sparse.coo_array((values, (rows, columns)), shape=(len(nodes), len(nodes)))
    whole = sparse.kron(of_nodes.tocsc() + MORE * sparse.eye_array(len(nodes)), np.eye(3))
    free = np.flatnonzero(~structure["fixed"][:, :3].ravel())
    return sparse.csc_array(whole.tocsc()[free][:, free])
