"""The plain way: the structure built and solved anew for each sample."""

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray
from rga_bench.solver.box_bridge import BoxBridge
from rga_bench.solver.space_truss import SpaceTruss


class FromScratch:
    """A truss built and solved anew, by rga: what the faster paths are checked against."""

    rows = 8

    def __init__(self, truss: SpaceTruss) -> None:
        self._truss = truss

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        samples = zip(factors, coefficients, strict=True)
        return np.array([self._solve(*sample) for sample in samples])

    def _solve(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        structure, loads = self._truss.structure, self._truss.loads
        count = len(structure["ends"])
        stiffness = structure["spring_stiffness"] * factors[count:]
        area = structure["A"] * factors[:count]

        def combined(patterns: FloatArray) -> FloatArray:
            return np.asarray(np.tensordot(coefficients, patterns, 1)[None])

        structure = {**structure, "A": area, "spring_stiffness": stiffness}
        loads = {
            **loads,
            "forces": combined(loads["forces"]),
            "strain": combined(loads["strain"]),
            "prescribed": combined(loads["prescribed"]),
            "prescribed_inclined": combined(loads["prescribed_inclined"]),
        }
        return np.asarray(_core.respond(structure, loads, self._truss.outputs)[0])


def whole_factors(bridge: BoxBridge, factors: FloatArray) -> FloatArray:
    """Factors of all members and springs, float[n, m + s], from those of the few that vary."""
    members = len(bridge.structure["ends"])
    varied: NDArray[np.int64] = np.concatenate([bridge.members, members + bridge.springs])
    whole = np.ones((len(factors), members + len(bridge.structure["spring_stiffness"])))
    whole[:, varied] = factors
    return whole
