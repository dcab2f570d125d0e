"""Solvers that rga is measured beside; each does the same job as well as it can."""

from typing import Protocol

from rga.arrays import FloatArray


class Peer(Protocol):
    """Samples of a truss of which every stiffness varies."""

    @property
    def rows(self) -> int:
        """Samples of a batch that suits it."""

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
