"""A space truss as a sparse linear system, in SciPy alone: what sparse solvers are given."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from rga.arrays import FloatArray
from rga_bench.solver.space_truss import SpaceTruss

#: samples whose matrices are filled at once: their values stay in the cache
BATCH = 32


class LinearSystem:
    """K u = f of many samples, K = B diag(k) B^T with the stiffnesses k of members and springs.

    What can be done for all samples of a batch at once is: the values of their matrices are one
    constant sparse matrix times their factors.

    Attributes:
        size: displacements that are free.
        lower: the lower triangle of K at factors of 1, float[size, size]; entries that are zero
            whatever the factors are not in it.
    """

    def __init__(self, truss: SpaceTruss) -> None:
        """Takes members and springs to the ground; nodal forces and free strains; displacements."""
        structure, loads, outputs = truss.structure, truss.loads, truss.outputs
        ends, nodes = structure["ends"], structure["coordinates"]
        free = ~structure["fixed"][:, :3]
        number = np.where(free, np.cumsum(free).reshape(free.shape) - 1, -1)
        self.size = int(free.sum())

        between = nodes[ends[:, 1]] - nodes[ends[:, 0]]
        length = np.linalg.norm(between, axis=1, keepdims=True)
        axial = structure["E"] * structure["A"]
        on_ground = number[structure["spring_node"][:, 0], structure["spring_dof"]]
        stiffness = np.concatenate([axial / length[:, 0], structure["spring_stiffness"]])
        # Up to six unknowns that stretch a term, and by how much.
        unknowns = np.full((len(stiffness), 6), -1)
        unknowns[: len(ends)] = number[ends].reshape(-1, 6)
        unknowns[len(ends) :, 0] = on_ground
        stretch = np.zeros(unknowns.shape)
        stretch[: len(ends)] = np.hstack([-between, between]) / length
        stretch[len(ends) :, 0] = 1.0
        stretch[unknowns < 0] = 0.0
        self._fill(unknowns, stretch, stiffness)

        terms, place = np.nonzero(stretch)
        of_terms = (stretch[terms, place], (unknowns[terms, place], terms))
        self._pull = sparse.csr_array(of_terms, (self.size, len(stiffness)))
        self._forces = loads["forces"][:, free.nonzero()[0], free.nonzero()[1]]
        self._restrained = np.zeros((len(self._forces), len(stiffness)))
        self._restrained[:, : len(ends)] = axial * loads["strain"][:, :, 0]
        seen = np.where(number[outputs["index"]] >= 0, outputs["vector"], 0.0)
        output, direction = np.nonzero(seen)
        read = (seen[output, direction], (output, number[outputs["index"][output], direction]))
        self._read = sparse.csr_array(read, (len(seen), self.size))

    def values(self, factors: FloatArray) -> FloatArray:
        """Values of `lower` for samples, float[n, entries]; factors float[n, terms]."""
        return np.ascontiguousarray((self._values @ np.ascontiguousarray(factors.T)).T)

    def forces(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """f of samples, float[n, size]; coefficients of the patterns float[n, p]."""
        restrained = (coefficients @ self._restrained) * factors
        return np.asarray(coefficients @ self._forces + (self._pull @ restrained.T).T)

    def read(self, displacements: FloatArray) -> FloatArray:
        """Outputs of samples, float[n, o]; displacements float[n, size]."""
        return np.ascontiguousarray((self._read @ displacements.T).T)

    def residual(self, values: FloatArray, displacements: FloatArray, forces: FloatArray) -> float:
        """|K u - f| / |f| of one sample."""
        lower = sparse.csc_array((values, self.lower.indices, self.lower.indptr))
        resisted = lower @ displacements + lower.T @ displacements
        resisted -= lower.diagonal() * displacements
        return float(np.linalg.norm(resisted - forces) / np.linalg.norm(forces))

    def _fill(
        self, unknowns: NDArray[np.int64], stretch: FloatArray, stiffness: FloatArray
    ) -> None:
        """The pattern of K, and the matrix that makes its values from factors."""
        i, j = np.tril_indices(unknowns.shape[1])
        parts = stiffness[:, None] * stretch[:, i] * stretch[:, j]
        term, pair = np.nonzero(parts)
        one, other = unknowns[term, i[pair]], unknowns[term, j[pair]]
        slots, entry = np.unique(
            np.minimum(one, other) * self.size + np.maximum(one, other), return_inverse=True
        )
        of_terms = (parts[term, pair], (entry, term))
        self._values = sparse.csr_array(of_terms, (len(slots), len(stiffness)))
        column, row = np.divmod(slots, self.size)
        start = np.searchsorted(column, np.arange(self.size + 1))
        given = (self._values.sum(axis=1), row.astype(np.int32), start.astype(np.int32))
        self.lower = sparse.csc_array(given, (self.size, self.size))
