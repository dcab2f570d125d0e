"""Other ways to the lowest natural frequencies: dense, ARPACK by SciPy, and ARPACK on CHOLMOD."""

import numpy as np
import scipy
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh

from rga.arrays import FloatArray
from rga_bench.installed import NotInstalledError
from rga_bench.modes.swinging import Swinging

#: of eigenvalues, relative: as far as ARPACK is asked to go, and as ours are proved
EXACT = 1e-9


class Dense:
    """LAPACK on whole matrices."""

    def __init__(self, swinging: Swinging, count: int) -> None:
        self._swinging, self._count = swinging, count
        self._mass = swinging.mass.toarray()

    def frequencies(self, factors: FloatArray) -> FloatArray:
        """The lowest [Hz] of a sample."""
        stiffness = self._swinging.stiffness(factors).toarray()
        lowest = (0, self._count - 1)
        squares = scipy.linalg.eigh(
            stiffness, self._mass, eigvals_only=True, subset_by_index=lowest
        )
        return hertz(squares)


class ShiftInvert:
    """ARPACK about zero, as `scipy.sparse.linalg.eigsh` does by itself."""

    def __init__(self, swinging: Swinging, count: int) -> None:
        self._swinging, self._count = swinging, count
        self._start = np.ones(swinging.system.size)

    def frequencies(self, factors: FloatArray) -> FloatArray:
        """The lowest [Hz] of a sample."""
        squares = eigsh(
            self._swinging.stiffness(factors),
            self._count,
            self._swinging.mass,
            sigma=0.0,
            v0=self._start,
            tol=EXACT,
            return_eigenvectors=False,
        )
        return hertz(squares)


class ArpackOnCholmod:
    """ARPACK about zero on CHOLMOD's factor, whose analysis is done once.

    Args:
        swinging: the truss.
        count: of modes.
        settings: mode and ordering of CHOLMOD.

    Raises:
        NotInstalledError: scikit-sparse is not there.
    """

    def __init__(self, swinging: Swinging, count: int, settings: tuple[str, str]) -> None:
        try:
            from sksparse.cholmod import analyze
        except ImportError:
            raise NotInstalledError("scikit-sparse") from None
        self._swinging, self._count = swinging, count
        self._start = np.ones(swinging.system.size)
        self._lower = sparse.csc_matrix(swinging.system.lower)
        mode, ordering = settings
        self._factor = analyze(self._lower, mode=mode, ordering_method=ordering)

    def frequencies(self, factors: FloatArray) -> FloatArray:
        """The lowest [Hz] of a sample."""
        swinging, size = self._swinging, self._swinging.system.size
        self._lower.data = swinging.system.values(factors[None])[0]
        self._factor.cholesky_inplace(self._lower)
        squares = eigsh(
            swinging.mass,  # is never multiplied with where the inverse is given
            self._count,
            swinging.mass,
            sigma=0.0,
            OPinv=LinearOperator((size, size), self._factor, dtype=float),
            v0=self._start,
            tol=EXACT,
            return_eigenvectors=False,
        )
        return hertz(squares)


def hertz(squares: FloatArray) -> FloatArray:
    """Frequencies [Hz] of squares of circular ones, the lowest first."""
    return np.asarray(np.sqrt(np.sort(squares)) / (2 * np.pi))
