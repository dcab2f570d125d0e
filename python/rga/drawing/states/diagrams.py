"""Diagrams of section forces along members."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene

Quantity = Literal["N", "V", "M"]
UNITS: dict[Quantity, str] = {"N": "N", "V": "N", "M": "N m"}
SIGNS: dict[Quantity, tuple[str, str]] = {"N": ("tension", "compression")}
WORDS: dict[Quantity, str] = {
    "N": "axial force N, tension positive",
    "V": "shear force V",
    "M": "bending moment M",
}


@dataclass(frozen=True)
class Diagram:
    """Values of a section force along members.

    Attributes:
        quantity: which.
        positions: of the stations, as shares of each member's length, float[members, stations].
        values: there [N or N m], float[members, stations].
        sides: towards which positive values are drawn, float[members, 3].
        contexts: at which, in words.
    """

    quantity: Quantity
    positions: FloatArray
    values: FloatArray
    sides: FloatArray
    contexts: str

    @property
    def largest(self) -> float:
        """The largest value, regardless of its sign; 0 where all are none."""
        return float(np.abs(self.values).max(initial=0.0))


def diagrams(
    scene: Scene, quantity: Quantity, positions: FloatArray, values: FloatArray, contexts: str = ""
) -> Diagram:
    """A diagram of values along members, drawn across them in the plane of the structure.

    Positive values stand on the side of the local axis that lies in the plane of a plane structure,
    and on that of local z in space.

    Args:
        scene: the structure.
        quantity: which section force.
        positions, values: float[members, stations]; values in [N] or [N m].
        contexts: at which, in words.
    """
    sides = scene.axes[:, 2].copy()
    if scene.normal is not None:
        across = np.abs(scene.axes[:, 2] @ scene.normal) > np.abs(scene.axes[:, 1] @ scene.normal)
        sides[across] = scene.axes[across, 1]
    return Diagram(quantity, positions, values, sides, contexts)
