"""CHOLMOD by scikit-sparse: one symbolic analysis, and a numeric factorisation a sample."""

from functools import partial
from itertools import product

import numpy as np
from scipy import sparse

from rga.arrays import FloatArray
from rga_bench.installed import NotInstalledError
from rga_bench.solver.peers.linear_system import BATCH, LinearSystem
from rga_bench.timing import shortest

ORDERINGS = ("natural", "amd", "metis", "nesdis", "colamd", "default", "best")
MODES = ("simplicial", "supernodal")


class Cholmod:
    """Factors K of a truss anew for each sample; the pattern is analysed once.

    Attributes:
        settings: mode and ordering.
    """

    rows = 8 * BATCH

    def __init__(self, system: LinearSystem, settings: tuple[str, str]) -> None:
        """Analyses the pattern.

        Raises:
            NotInstalledError: scikit-sparse is not there.
        """
        try:
            from sksparse.cholmod import analyze
        except ImportError:
            raise NotInstalledError("scikit-sparse") from None
        self.system = system
        self.settings = settings
        mode, ordering = settings
        self._matrix = sparse.csc_matrix(system.lower)
        self._factor = analyze(self._matrix, mode=mode, ordering_method=ordering)

    def solve(self, values: FloatArray, forces: FloatArray) -> FloatArray:
        """Displacements float[size] of one sample; values of its K as `LinearSystem.values`."""
        self._matrix.data = values
        self._factor.cholesky_inplace(self._matrix)
        return np.asarray(self._factor(forces))

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        system = self.system
        displacements = np.empty((len(factors), system.size))
        for first in range(0, len(factors), BATCH):
            batch = slice(first, first + BATCH)
            values = system.values(factors[batch])
            forces = system.forces(factors[batch], coefficients[batch])
            for row, sample in enumerate(zip(values, forces, strict=True), start=first):
                displacements[row] = self.solve(*sample)
        return system.read(displacements)

    def columns(self) -> FloatArray:
        """Entries in each column of the factor, float[size]."""
        self.solve(self.system.lower.data, np.ones(self.system.size))
        return np.asarray(np.diff(self._factor.L().indptr), dtype=float)


def fastest_cholmod(system: LinearSystem, seconds: float) -> Cholmod:
    """CHOLMOD in the mode and ordering that solves a sample fastest, by trying all.

    Args:
        system: what is solved.
        seconds: that each trial takes.

    Raises:
        NotInstalledError: scikit-sparse is not there.
    """
    values, forces = system.lower.data, np.ones(system.size)
    trials = [Cholmod(system, settings) for settings in product(MODES, ORDERINGS)]
    tasks = [partial(trial.solve, values, forces) for trial in trials]
    taken = shortest(tasks, seconds * len(tasks))
    return trials[int(np.argmin(taken))]


def least_operations(system: LinearSystem) -> tuple[float, float]:
    """Floating-point operations of a factorisation and of its two triangular solves.

    In the order that makes the fewest: squares of the entries of the columns, summed; a
    multiplication and an addition an entry, and a division a column.

    Raises:
        NotInstalledError: scikit-sparse is not there.
    """
    orders = [Cholmod(system, ("simplicial", ordering)).columns() for ordering in ORDERINGS]
    columns = min(orders, key=lambda entries: float((entries**2).sum()))
    return float((columns**2).sum()), float(2 * (2 * columns - 1).sum())
