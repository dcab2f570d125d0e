"""A structure of which many stiffnesses vary: one symbolic analysis, one factorisation a sample."""

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray, LoadArrays, OutputArrays, StructureArrays


class Factorisation:
    """A structure whose members and springs vary, each as a whole.

    Args:
        structure, loads, outputs: as `_core.respond` takes them; all patterns are kept.
        members, springs: numbers of those that vary, int[members] and int[springs]; no end of a
            frame member among them yields.
        stiffness: theirs in the structure as it is, float[elements], above zero.

    Raises:
        _core.InvalidInput: as `_core.respond`.
    """

    terms = 0

    def __init__(
        self,
        structure: StructureArrays,
        loads: LoadArrays,
        outputs: OutputArrays,
        members: IntArray,
        springs: IntArray,
        stiffness: FloatArray,
    ) -> None:
        self._core = _core.Refactored(structure, loads, outputs)
        self._varied = np.append(members, len(structure["ends"]) + springs).astype(np.int64)
        self._count = len(structure["ends"]) + len(structure["spring_stiffness"])
        self._patterns = len(loads["forces"])
        self._stiffness = stiffness

    def respond(self, coefficients: FloatArray, stiffness: FloatArray) -> FloatArray:
        """Outputs of samples, float[rows, outputs] in SI units.

        Args:
            coefficients: of the load patterns, float[rows, patterns].
            stiffness: of the elements that vary, members first, float[rows, elements].

        Raises:
            _core.UnstableStructure: a structure can move; names row, node and direction.
        """
        return self._core.respond(self._factors(stiffness), coefficients)

    def differentiate(
        self,
        coefficients: FloatArray,
        stiffness: FloatArray,
        coefficient_rates: FloatArray,
        stiffness_rates: FloatArray,
    ) -> FloatArray:
        """Derivatives of the outputs along directions, float[rows, outputs, directions].

        Args:
            coefficients, stiffness: as for `respond`.
            coefficient_rates: derivatives of the coefficients, float[rows, patterns, directions].
            stiffness_rates: derivatives of the stiffnesses, float[rows, elements, directions].
        """
        return self._core.differentiate(
            self._factors(stiffness),
            coefficients,
            self._varied,
            stiffness_rates / self._stiffness[:, None],
            coefficient_rates,
        )

    def pull_back(
        self, coefficients: FloatArray, stiffness: FloatArray, gradients: FloatArray
    ) -> FloatArray:
        """Derivatives of the sum of the outputs times gradients: the adjoint of `respond`.

        Args:
            coefficients, stiffness: as for `respond`.
            gradients: float[rows, outputs].

        Returns:
            float[rows, patterns + elements], by the coefficients and then by the stiffnesses.
        """
        found = self._core.pull_back(self._factors(stiffness), coefficients, gradients)
        by_stiffness = found[:, self._patterns + self._varied] / self._stiffness
        return np.concatenate([found[:, : self._patterns], by_stiffness], axis=1)

    def _factors(self, stiffness: FloatArray) -> FloatArray:
        factors = np.ones((len(stiffness), self._count))
        factors[:, self._varied] = stiffness / self._stiffness
        return factors
