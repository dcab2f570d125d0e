"""Finite elements for truss and frame bridges."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["InvalidInput", "NotConverged", "UnstableStructure", "respond", "slide"]

class InvalidInput(ValueError):
    """An array is missing, malformed or out of range; the message names it."""

class UnstableStructure(ArithmeticError):
    """Part of the structure can move freely."""

    node: int
    """What moves most."""
    dof: int
    """Its direction: 0..5 for ux uy uz rx ry rz."""
    direction: list[float]
    """The motion of that node, six numbers of norm 1."""

class NotConverged(ArithmeticError):
    """Friction forces did not settle."""

    row: int
    """The row of the time series."""

def respond(
    structure: dict[str, NDArray[Any]],
    loads: dict[str, NDArray[Any]],
    outputs: dict[str, NDArray[Any]],
) -> NDArray[np.float64]:
    """Linear static response [patterns, outputs]; `help(respond)` lists the arrays."""

def slide(
    free_displacement: NDArray[np.float64],
    flexibility: NDArray[np.float64],
    normal_free: NDArray[np.float64],
    normal_influence: NDArray[np.float64],
    mu: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Coulomb friction forces [rows, bearings] of bearings through time."""
