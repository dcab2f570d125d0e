"""SuperLU by SciPy: an order that is found once, and a factorisation a sample."""

from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from rga.arrays import FloatArray
from rga_bench.solver.peers.linear_system import BATCH, LinearSystem

#: symmetric positive definite: the diagonal serves as pivots; small blocks suit bridges best
SETTINGS: dict[str, Any] = {
    "diag_pivot_thresh": 0.0,
    "options": {"SymmetricMode": True},
    "relax": 4,
    "panel_size": 1,
}


class SuperLU:
    """Factors K of a truss anew for each sample, in the order of the first."""

    rows = 2 * BATCH

    def __init__(self, system: LinearSystem) -> None:
        self.system = system
        lower = system.lower
        count = lower.nnz
        numbered = sparse.csc_array((np.arange(1.0, count + 1), lower.indices, lower.indptr))
        both = (numbered + sparse.tril(numbered, -1).T).tocsc()
        first = sparse.csc_array((lower.data[both.data.astype(int) - 1], both.indices, both.indptr))
        order = splu(first, permc_spec="MMD_AT_PLUS_A", **SETTINGS).perm_c
        # Column j of what is factored is column order[j] of K, and so are its rows.
        self._order = np.argsort(order)
        both = both[self._order][:, self._order].tocsc()
        both.sort_indices()
        self._entries = both.data.astype(int) - 1
        self._matrix = first.__class__(both, dtype=float)

    def solve(self, values: FloatArray, forces: FloatArray) -> FloatArray:
        """Displacements float[size] of one sample; values of its K as `LinearSystem.values`."""
        self._matrix.data = values[self._entries]
        factor: Any = splu(self._matrix, permc_spec="NATURAL", **SETTINGS)
        displacements = np.empty(len(forces))
        displacements[self._order] = factor.solve(forces[self._order])
        return displacements

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        values = self.system.values(factors)
        forces = self.system.forces(factors, coefficients)
        solved = [self.solve(*sample) for sample in zip(values, forces, strict=True)]
        return self.system.read(np.array(solved))
