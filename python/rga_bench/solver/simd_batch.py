"""C3 by the instructions of the processor that it may use."""

from rga import _core
from rga.arrays import FloatArray
from rga_bench.solver.space_truss import SpaceTruss


class SimdBatch:
    """Samples of a truss of which every stiffness varies.

    Args:
        truss: what is solved.
        instructions: one of `_core.instructions`.
        rows: samples of a batch.
    """

    def __init__(self, truss: SpaceTruss, instructions: str, rows: int = 2048) -> None:
        self.rows = rows
        arrays = truss.structure, truss.loads, truss.outputs
        self._solver = _core.Refactored(*arrays, instructions=instructions)

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        return self._solver.respond(factors, coefficients)
