"""C3 by the instructions of the processor that it may use."""

from typing import Any

from rga import _core
from rga.benchmark.space_truss import SpaceTruss
from rga.model.parameter import FloatArray


def instruction_sets() -> list[str]:
    """What the processor has of those that C3 is written for, best first."""
    known: Any = getattr(_core, "instructions", None)
    return ["as built"] if known is None else list(known())


class Lanes:
    """Samples of a truss of which every stiffness varies.

    Args:
        truss: what is solved.
        instructions: one of `instruction_sets`.
        rows: samples of a batch.
    """

    def __init__(self, truss: SpaceTruss, instructions: str, rows: int = 2048) -> None:
        self.rows = rows
        arrays = truss.structure, truss.loads, truss.outputs
        chosen: dict[str, Any] = {"instructions": instructions}
        self._solver = _core.Refactored(*arrays, **(chosen if instructions != "as built" else {}))

    def respond(
        self, factors: FloatArray, coefficients: FloatArray, threads: int = 1
    ) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        return self._solver.respond(factors, coefficients, threads)
