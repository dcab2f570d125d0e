"""The plain way: the structure built and solved anew for each sample."""

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray
from rga_bench.solver.box_bridge import BoxBridge
from rga_bench.solver.space_truss import Arrays, SpaceTruss


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
        structure: Arrays = dict(self._truss.structure)
        count = len(structure["ends"])
        structure["A"] = structure["A"] * factors[:count]
        structure["spring_stiffness"] = structure["spring_stiffness"] * factors[count:]
        loads = dict(self._truss.loads)
        for name in ("forces", "strain", "prescribed", "prescribed_inclined"):
            loads[name] = np.tensordot(coefficients, loads[name], 1)[None]
        return np.asarray(_core.respond(structure, loads, self._truss.outputs)[0])


def whole_factors(bridge: BoxBridge, factors: FloatArray) -> FloatArray:
    """Factors of all members and springs, float[n, m + s], from those of the few that vary."""
    members = len(bridge.structure["ends"])
    varied: NDArray[np.int64] = np.concatenate([bridge.members, members + bridge.springs])
    whole = np.ones((len(factors), members + len(bridge.structure["spring_stiffness"])))
    whole[:, varied] = factors
    return whole
